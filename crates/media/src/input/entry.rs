// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kind of an entry of a folder. One function decides it, for entries that are read and for
//! entries that are reported as skipped.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::content_kind::{ContentKind, content};
use super::skip_reason::SkipReason;
use crate::FootageError;
use crate::extension::{
    is_image_name, is_note, is_other_video, is_video_name, unread_image_type_by_name,
};
use crate::natural_order;

/// The kind of an entry of a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum EntryKind {
    Image,
    Video,
    Folder,
    /// An entry that is not read, with a reason if the user may have meant it.
    Skipped(Option<SkipReason>),
}

pub(crate) fn entry_kind(path: &Path) -> EntryKind {
    let known = match fs::metadata(path) {
        Ok(known) => known,
        Err(error) => {
            let reason = match error.kind() {
                io::ErrorKind::NotFound => SkipReason::BrokenLink,
                _ => SkipReason::Unreadable { problem: error.to_string() },
            };
            return EntryKind::Skipped(Some(reason));
        }
    };
    if known.is_dir() {
        return EntryKind::Folder;
    }
    let (image, video) = (is_image_name(path), is_video_name(path));
    if !known.is_file() {
        return EntryKind::Skipped((image || video).then_some(SkipReason::NotAFile));
    }
    match (image, video) {
        (true, _) => EntryKind::Image,
        (_, true) => EntryKind::Video,
        _ => EntryKind::Skipped(skip_reason(path)),
    }
}

/// Returns the reason why a file without the name of an image or a video may have been meant as
/// one.
fn skip_reason(path: &Path) -> Option<SkipReason> {
    if let Some(name) = unread_image_type_by_name(path) {
        return Some(SkipReason::ImageType { name });
    }
    if is_other_video(path) {
        return Some(SkipReason::VideoExtension);
    }
    if is_note(path) {
        return None;
    }
    match content(path) {
        Ok(ContentKind::Image | ContentKind::Video) => Some(SkipReason::OtherExtension),
        Ok(ContentKind::OtherImage(name)) => Some(SkipReason::ImageType { name }),
        Ok(ContentKind::DataSet) => Some(SkipReason::DataSet),
        Ok(ContentKind::Archive) => Some(SkipReason::Archive),
        Ok(ContentKind::Text | ContentKind::Unknown) => {
            path.extension().is_none().then_some(SkipReason::NoExtension)
        }
        Err(error) => Some(SkipReason::Unreadable { problem: error.to_string() }),
    }
}

/// Returns the entries of a folder in natural order, without hidden entries and those that
/// operating systems create.
pub(crate) fn entries(folder: &Path) -> Result<Vec<PathBuf>, FootageError> {
    let unreadable = |error: io::Error| FootageError::Unreadable {
        path: folder.to_owned(),
        problem: error.to_string(),
    };
    let mut entries = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        entries.push(entry.map_err(unreadable)?.path());
    }
    Ok(in_natural_order(entries))
}

/// Sorts paths in natural order, and removes hidden ones and those that operating systems create.
pub(crate) fn in_natural_order(mut paths: Vec<PathBuf>) -> Vec<PathBuf> {
    paths.retain(|path| !is_hidden(path));
    paths.sort_by(|a, b| natural_order(a, b));
    paths
}

/// Returns true if an entry cannot be footage: it is hidden, or an operating system created it.
pub(super) fn is_hidden(path: &Path) -> bool {
    const LEFT_BEHIND: [&str; 8] = [
        "thumbs.db",
        "ehthumbs.db",
        "desktop.ini",
        "__macosx",
        "@eadir",
        "$recycle.bin",
        "system volume information",
        "lost+found",
    ];
    path.file_name().is_some_and(|name| {
        let name = name.to_string_lossy();
        name.starts_with('.') || LEFT_BEHIND.iter().any(|left| name.eq_ignore_ascii_case(left))
    })
}
