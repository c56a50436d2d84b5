// SPDX-License-Identifier: MIT OR Apache-2.0
//! The images in a ZIP archive, in natural order ([`zip_images`]), as a list or as a feed
//! ([`open_zip`]). An archive is read as the folder that it was made of, whether that folder is
//! an entry of the archive or not.

use super::content_kind::{ContentKind, content};
use super::entry::is_hidden;
use super::skip_reason::{SkipReason, SkippedInput};
use crate::extension::{is_image_name, is_video_name, unread_image_type_by_name};
use crate::limits::MAX_FILE_GIB;
use crate::options::ImageRelation;
use crate::source::file_feeds::{ImageFile, ImageFiles};
use crate::{FootageError, InputOptions, SourceKind, natural_order};
use std::collections::HashSet;
use std::fs::File;
use std::io::{BufReader, Read, Seek as _, SeekFrom};
use std::path::{Component, Path, PathBuf};
use zip::ZipArchive;
use zip::result::ZipError;

pub(super) type OpenArchive = ZipArchive<BufReader<File>>;

/// An image in an archive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ZipImage {
    pub(super) index: usize,
    /// The path in the archive.
    pub(super) path: PathBuf,
    pub(super) label: Option<String>,
}

/// The entries by which an office document, a program or an e-book is recognized.
const DOCUMENT_ENTRIES: [&str; 3] = ["[Content_Types].xml", "META-INF/MANIFEST.MF", "mimetype"];

/// Opens an archive of images. Documents and programs that are ZIP archives are refused.
pub(super) fn open_archive(path: &Path) -> Result<OpenArchive, FootageError> {
    let file = foveate_tools::open_file(path).map_err(|error| FootageError::Unreadable {
        path: path.to_owned(),
        problem: error.to_string(),
    })?;
    let archive =
        ZipArchive::new(BufReader::new(file)).map_err(|error| zip_error(path, "", &error))?;
    let refused =
        |problem: &str| FootageError::Zip { path: path.to_owned(), problem: problem.to_owned() };
    if DOCUMENT_ENTRIES.iter().any(|name| archive.index_for_name(name).is_some()) {
        return Err(refused("it is a document or a program; unpack it, and name the images"));
    }
    if entry_count(path).is_some_and(|count| count != archive.len()) {
        return Err(refused("it has several entries of one name; make it again"));
    }
    Ok(archive)
}

/// Returns the number of entries that the end of an archive states. The library keeps one entry of
/// each name.
fn entry_count(path: &Path) -> Option<usize> {
    const RECORD: u64 = 22;
    const LONGEST_COMMENT: u64 = 0xFFFF;
    let mut file = File::open(path).ok()?;
    let length = file.metadata().ok()?.len();
    file.seek(SeekFrom::Start(length.saturating_sub(LONGEST_COMMENT + RECORD))).ok()?;
    let mut end = Vec::new();
    file.take(LONGEST_COMMENT + RECORD).read_to_end(&mut end).ok()?;
    let place = end.windows(4).rposition(|bytes| bytes == b"PK\x05\x06")?;
    let count = u16::from_le_bytes(end.get(place + 10..)?.first_chunk().copied()?);
    // An archive of more entries states the number elsewhere.
    (count < u16::MAX).then_some(count.into())
}

pub(super) fn zip_error(path: &Path, entry: &str, error: &ZipError) -> FootageError {
    let entry = if entry.is_empty() { String::new() } else { format!("its entry `{entry}`: ") };
    let problem = match error {
        ZipError::UnsupportedArchive(ZipError::PASSWORD_REQUIRED) => {
            "it is encrypted; unpack it with its password".to_owned()
        }
        ZipError::UnsupportedArchive(_) | ZipError::CompressionMethodNotSupported(_) => {
            format!("{error}; pack it with Deflate, for example with `zip -r`")
        }
        _ => format!("{error}; copy or make it again"),
    };
    let problem = (entry + &problem).replace(char::is_control, " ");
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
        let name = name.map_err(|error| zip_error(path, "", &error))?.unwrap_or_default();
        // Names are places below the archive. Some programs write a backslash between folders.
        let named = PathBuf::from(name.replace('\\', "/"));
        let own = named.components().filter(|part| matches!(part, Component::Normal(_)));
        let file: PathBuf = own.collect();
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
    let paths: Vec<&Path> = found.iter().map(|(_, path)| path.as_path()).collect();
    let places = ArchiveFolder::new(&paths, images);
    let placed = found.into_iter().map(|(index, path)| (*index, path, places.folders_above(path)));
    let placed: Vec<(usize, &PathBuf, Vec<String>)> = placed.collect();
    let nested = placed.iter().find_map(|(_, _, folders)| folders.first());
    if let (ImageRelation::Clip, Some(folder)) = (images, nested) {
        return Err(refused(format!(
            "its images lie in several folders, one of them `{folder}`, so they are not one clip; unpack it and \
             name a folder, or read a set with --images set"
        )));
    }
    let placed = placed.into_iter().filter(|(_, _, folders)| folders.len() <= 1);
    let listed = placed.map(|(index, path, folders)| ZipImage {
        index,
        path: path.clone(),
        label: folders.into_iter().next(),
    });
    let mut listed: Vec<ZipImage> = listed.collect();
    // As in a folder, images without a label come first.
    listed.sort_by_key(|image| image.label.is_some());
    Ok(listed)
}

/// The folder in an archive that stands for the archive itself: the deepest one in which all images
/// lie. The folder of a set has the folders of its classes, and no images.
struct ArchiveFolder {
    path: PathBuf,
}

impl ArchiveFolder {
    fn new(paths: &[&Path], images: ImageRelation) -> Self {
        let common = common_folder(paths.iter().copied());
        let is_class =
            images == ImageRelation::Set && paths.iter().all(|path| path.parent() == Some(&common));
        let path = match common.parent() {
            Some(above) if is_class => above.to_owned(),
            _ => common,
        };
        Self { path }
    }

    /// Returns the names of the folders between this one and a file.
    fn folders_above(&self, path: &Path) -> Vec<String> {
        let below = path.strip_prefix(&self.path).ok().and_then(Path::parent);
        let folders = below.into_iter().flat_map(Path::components);
        folders.map(|folder| folder.as_os_str().to_string_lossy().into_owned()).collect()
    }
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
/// Another file has none.
pub(crate) fn skipped_of_zip(path: &Path, images: ImageRelation) -> Vec<SkippedInput> {
    let Some((archive, listed)) = listed_archive(path, images) else { return Vec::new() };
    let read: HashSet<usize> = listed.iter().map(|image| image.index).collect();
    let files = visible_files(path, &archive).unwrap_or_default().into_iter();
    let skipped = files.filter(|(index, _)| !read.contains(index)).filter_map(|(_, file)| {
        let is_archive = file.extension().is_some_and(|end| end.eq_ignore_ascii_case("zip"));
        let reason = match unread_image_type_by_name(&file) {
            Some(name) => SkipReason::ImageType { name },
            None if is_video_name(&file) => SkipReason::VideoInSet,
            None if is_image_name(&file) => SkipReason::TooDeep,
            None if file.extension().is_none() => SkipReason::NoExtension,
            None if is_archive => SkipReason::Archive,
            None => return None,
        };
        Some(SkippedInput::new(&path.join(file), reason))
    });
    skipped.collect()
}

/// Returns the names of the images of an archive; another file has none.
pub(crate) fn image_names_of_zip(path: &Path, images: ImageRelation) -> Vec<PathBuf> {
    let listed = listed_archive(path, images).map(|(_, listed)| listed);
    listed.unwrap_or_default().into_iter().map(|image| path.join(image.path)).collect()
}

/// Returns an archive with its images; `None` for another file, and for an archive that is refused.
fn listed_archive(path: &Path, images: ImageRelation) -> Option<(OpenArchive, Vec<ZipImage>)> {
    if !matches!(content(path), Ok(ContentKind::Archive)) {
        return None;
    }
    let archive = open_archive(path).ok()?;
    let listed = zip_images(path, &archive, images).ok()?;
    Some((archive, listed))
}

pub(super) fn open_zip(
    path: &Path,
    bits: u32,
    options: &InputOptions,
) -> Result<ImageFiles, FootageError> {
    let mut archive = open_archive(path)?;
    let images = zip_images(path, &archive, options.images)?;
    let kind = match options.images {
        ImageRelation::Set => SourceKind::Set,
        ImageRelation::Clip | ImageRelation::CifarSheet => SourceKind::Clip,
    };
    let file =
        |image: &ZipImage| ImageFile { path: path.join(&image.path), label: image.label.clone() };
    let files = images.iter().map(file).collect();
    let own_path = path.to_owned();
    let bytes_of = move |number: usize, name: &Path| {
        entry_bytes((&own_path, &mut archive), &images[number], name)
    };
    Ok(ImageFiles::new(files, Box::new(bytes_of), bits, options, kind))
}

/// Returns the bytes of an image. Their checksum is compared with that of the archive.
fn entry_bytes(
    (path, archive): (&Path, &mut OpenArchive),
    image: &ZipImage,
    name: &Path,
) -> Result<Vec<u8>, FootageError> {
    let limit = MAX_FILE_GIB << 30;
    let shown = image.path.display().to_string();
    let entry = archive.by_index(image.index);
    let entry = entry.map_err(|error| zip_error(path, &shown, &error))?;
    let mut bytes = Vec::new();
    let read = entry.take(limit + 1).read_to_end(&mut bytes);
    read.map_err(|error| zip_error(path, &shown, &error.into()))?;
    if bytes.len() as u64 > limit {
        return Err(FootageError::TooLarge { path: name.to_owned() });
    }
    Ok(bytes)
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
