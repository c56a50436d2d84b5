// SPDX-License-Identifier: MIT OR Apache-2.0
//! The images in a ZIP archive, in natural order. Folders in which all of them lie are left out of
//! consideration, so an archive of a folder is read as the folder itself.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use zip::ZipArchive;

use super::entry::is_hidden;
use super::skip_reason::{SkipReason, SkippedInput};
use crate::extension::{is_image_name, is_video_name, unread_image_type_by_name};
use crate::options::ImageRelation;
use crate::{FootageError, natural_order};

/// An open archive.
pub(super) type OpenArchive = ZipArchive<BufReader<File>>;

/// An image in an archive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ZipImage {
    pub(super) index: usize,
    /// The path in the archive.
    pub(super) path: PathBuf,
    pub(super) label: Option<String>,
}

/// Opens an archive.
pub(super) fn open_archive(path: &Path) -> Result<OpenArchive, FootageError> {
    let file = File::open(path).map_err(|error| FootageError::Unreadable {
        path: path.to_owned(),
        problem: error.to_string(),
    })?;
    ZipArchive::new(BufReader::new(file)).map_err(|error| zip_error(path, &error.to_string()))
}

/// Returns the error for an archive. Problems of its library do not say what to do.
pub(super) fn zip_error(path: &Path, problem: &str) -> FootageError {
    let problem = format!("{}; copy or make it again", problem.replace(char::is_control, " "));
    FootageError::Zip { path: path.to_owned(), problem }
}

/// Returns the visible files of an archive with their indexes, in natural order.
fn visible_files(
    path: &Path,
    archive: &OpenArchive,
) -> Result<Vec<(usize, PathBuf)>, FootageError> {
    let mut files = Vec::new();
    for index in 0..archive.len() {
        let name = archive.name_for_index(index).transpose();
        let name = name.map_err(|error| zip_error(path, &error.to_string()))?.unwrap_or_default();
        let file = PathBuf::from(&*name);
        if !name.ends_with('/') && !file.ancestors().any(is_hidden) {
            files.push((index, file));
        }
    }
    files.sort_by(|(_, a), (_, b)| natural_order(a, b));
    Ok(files)
}

/// Returns the images of an archive that is a clip or a set.
pub(super) fn zip_images(
    path: &Path,
    archive: &OpenArchive,
    images: ImageRelation,
) -> Result<Vec<ZipImage>, FootageError> {
    let files = visible_files(path, archive)?;
    let refused = |problem: String| FootageError::Zip { path: path.to_owned(), problem };
    let video = files.iter().find(|(_, path)| is_video_name(path));
    let found: Vec<&(usize, PathBuf)> =
        files.iter().filter(|(_, path)| is_image_name(path)).collect();
    match (found.as_slice(), video, images) {
        ([], None, _) => {
            let other = files.iter().find_map(|(_, path)| unread_image_type_by_name(path));
            let types =
                other.map(|name| format!(" of a type that is read, but images of the type {name}"));
            return Err(refused(format!(
                "it holds no image{}; archives of images in PNG, JPEG, BMP and PNM are read",
                types.unwrap_or_default()
            )));
        }
        (_, Some((_, video)), ImageRelation::Clip) | ([], Some((_, video)), ImageRelation::Set) => {
            return Err(refused(format!(
                "it holds videos, such as `{}`, but an archive consists of images; unpack it, and name the videos",
                video.display()
            )));
        }
        (_, _, ImageRelation::CifarSheet) => {
            return Err(refused("a CIFAR sheet is one PNG; unpack it".to_owned()));
        }
        _ => {}
    }
    let root = common_folder(found.iter().map(|(_, path)| path.as_path()));
    let first_folder = |path: &Path| -> Option<String> {
        let mut below = path.strip_prefix(&root).ok()?.components();
        let first = below.next()?.as_os_str().to_string_lossy().into_owned();
        below.next().map(|_| first)
    };
    if images == ImageRelation::Clip {
        let nested = found.iter().find_map(|(_, path)| first_folder(path));
        if let Some(folder) = nested {
            return Err(refused(format!(
                "its images lie in several folders, one of them `{folder}`, so they are not one clip; unpack it and \
                 name a folder, or read a set with --images set"
            )));
        }
    }
    let images = found.into_iter().map(|(index, path)| ZipImage {
        index: *index,
        path: path.clone(),
        label: first_folder(path),
    });
    Ok(images.collect())
}

/// Returns the deepest folder in which all paths lie.
fn common_folder<'a>(mut paths: impl Iterator<Item = &'a Path>) -> PathBuf {
    let parent = |path: &'a Path| path.parent().unwrap_or(Path::new(""));
    let mut common = paths.next().map(parent).unwrap_or(Path::new(""));
    for path in paths {
        while !path.starts_with(common) {
            common = common.parent().unwrap_or(Path::new(""));
        }
    }
    common.to_owned()
}

/// Returns the entries of an archive that are not read although the user may have meant them.
pub(crate) fn skipped_of_zip(path: &Path) -> Vec<SkippedInput> {
    let Ok(archive) = open_archive(path) else { return Vec::new() };
    let files = visible_files(path, &archive).unwrap_or_default().into_iter();
    let skipped = files.filter_map(|(_, file)| {
        let reason = match unread_image_type_by_name(&file) {
            Some(name) => SkipReason::ImageType { name },
            None if is_video_name(&file) => SkipReason::VideoInSet,
            None => return None,
        };
        Some(SkippedInput::new(&path.join(file), reason))
    });
    skipped.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_around_all_images_are_found() {
        let common = |paths: &[&str]| common_folder(paths.iter().map(|path| Path::new(*path)));
        assert_eq!(common(&["a/b/1.png", "a/b/2.png"]), Path::new("a/b"));
        assert_eq!(common(&["a/b/1.png", "a/c/2.png"]), Path::new("a"));
        assert_eq!(common(&["a/1.png", "ab/2.png"]), Path::new(""));
        assert_eq!(common(&["1.png", "2.png"]), Path::new(""));
    }
}
