// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files that an input stands for. Hidden files are ignored.

use std::path::{Path, PathBuf};

use super::entry::{EntryKind, entries, entry_kind};
use super::file_kind::{self, FileKind};
use super::pattern::{is_pattern, pattern_images};
use super::sequence::SequenceName;
use super::skip_reason::SkipReason;
use crate::address::input_without_secrets;
use crate::extension::is_image_name;
use crate::options::ImageRelation;
use crate::source::file_feeds::ImageFile;
use crate::{FootageError, picture};

/// Returns the files that one input stands for, with their labels.
pub(crate) fn expand(input: &Path, images: ImageRelation) -> Result<Vec<ImageFile>, FootageError> {
    if input.is_dir() {
        return match images {
            ImageRelation::Set => labelled_images(input),
            ImageRelation::Clip | ImageRelation::CifarSheet => folder_files(input),
        };
    }
    if input.exists() {
        return Ok(vec![ImageFile::plain(input.to_owned())]);
    }
    if let Some((text, name)) = sequence_of(input) {
        return name.images(text);
    }
    match input.to_str() {
        Some(text) if is_url(text) => Err(FootageError::Url { url: input_without_secrets(input) }),
        Some(text) if is_pattern(text) => pattern_images(text),
        _ => Err(FootageError::Missing { path: input_without_secrets(input).into() }),
    }
}

/// Returns the name of numbered files, if an input that does not exist is one. A name in a folder
/// that does not exist may be a pattern.
pub(crate) fn sequence_of(input: &Path) -> Option<(&str, SequenceName)> {
    let text = input.to_str().filter(|_| !input.exists())?;
    let name = SequenceName::parse(text)?;
    (name.has_folder() || !is_pattern(text)).then_some((text, name))
}

/// Returns the files that a folder, a pattern or the name of numbered images matches.
#[must_use]
pub fn matched_images(input: &Path, images: ImageRelation) -> Vec<PathBuf> {
    let files = expand(input, images).unwrap_or_default();
    files.into_iter().map(|file| file.path).collect()
}

/// Returns true if a text begins with a scheme such as `https://`.
fn is_url(text: &str) -> bool {
    let scheme = text.split_once("://").map(|(scheme, _)| scheme);
    scheme.is_some_and(|scheme| {
        !scheme.is_empty() && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+.-".contains(c))
    })
}

/// Separates images from files that are a source of their own.
#[allow(clippy::type_complexity, reason = "two lists")]
pub(super) fn split_images(
    files: &mut Vec<ImageFile>,
) -> Result<(Vec<ImageFile>, Vec<(PathBuf, FileKind)>), FootageError> {
    let (mut images, mut others) = (Vec::new(), Vec::new());
    for file in files.drain(..) {
        if is_image_name(&file.path) || picture::is_image(&file.path) {
            images.push(file);
        } else {
            others.push((file.path.clone(), file_kind::file_kind(&file.path)?));
        }
    }
    Ok((images, others))
}

/// Returns the images of a folder, or its clips if it has no images.
fn folder_files(path: &Path) -> Result<Vec<ImageFile>, FootageError> {
    let files = entries(path)?;
    let of = |kind: EntryKind| -> Vec<ImageFile> {
        files
            .iter()
            .filter(|path| entry_kind(path) == kind)
            .cloned()
            .map(ImageFile::plain)
            .collect()
    };
    let (images, clips) = (of(EntryKind::Image), of(EntryKind::Video));
    match (images.as_slice(), clips.as_slice()) {
        ([image, ..], [clip, ..]) => {
            let pattern = path.join("*").with_extension(image.path.extension().unwrap_or_default());
            Err(FootageError::Mixed {
                place: path.display().to_string(),
                images: images.len(),
                videos: clips.len(),
                video: clip.path.clone(),
                pattern: pattern.display().to_string(),
            })
        }
        ([_, ..], []) => Ok(images),
        ([], [_, ..]) => Ok(clips),
        ([], []) => Err(no_footage_error(path, &files)),
    }
}

/// Returns the error for a folder with nothing to read. It is empty, or its images have a type that
/// is not read.
fn no_footage_error(folder: &Path, files: &[PathBuf]) -> FootageError {
    let other = files.iter().find_map(|path| match entry_kind(path) {
        EntryKind::Skipped(Some(SkipReason::ImageType { name })) => Some((path, name)),
        _ => None,
    });
    other.map_or_else(
        || FootageError::EmptyFolder { path: folder.to_owned() },
        |(path, name)| FootageError::ImageType { path: path.clone(), name },
    )
}

/// Returns the images of a folder without a label, then the images of each sub-folder with the
/// folder's name as label.
fn labelled_images(path: &Path) -> Result<Vec<ImageFile>, FootageError> {
    let entries_here = entries(path)?;
    let is = |kind: EntryKind| move |path: &&PathBuf| entry_kind(path) == kind;
    let mut files: Vec<ImageFile> =
        entries_here.iter().filter(is(EntryKind::Image)).cloned().map(ImageFile::plain).collect();
    let mut all = entries_here.clone();
    for class in entries_here.iter().filter(is(EntryKind::Folder)) {
        let label = class.file_name().map(|name| name.to_string_lossy().into_owned());
        // A folder that cannot be read is reported with the other skipped entries.
        let listed = entries(class).unwrap_or_default();
        let images = listed.iter().filter(is(EntryKind::Image)).cloned();
        files.extend(images.map(|path| ImageFile { path, label: label.clone() }));
        all.extend(listed);
    }
    match (files.is_empty(), all.iter().any(|path| entry_kind(path) == EntryKind::Video)) {
        (false, _) => Ok(files),
        (true, false) => Err(no_footage_error(path, &all)),
        (true, true) => {
            let problem = format!(
                "folder `{}` holds clips but no images, and a set needs images; \
                 use `foveate simulate` to run the clips as a batch",
                path.display()
            );
            Err(FootageError::Option { option: "--images set", problem })
        }
    }
}
