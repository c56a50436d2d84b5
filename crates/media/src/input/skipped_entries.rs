// SPDX-License-Identifier: MIT OR Apache-2.0
//! Entries of folders and sets that are not read although the user may have meant them. Without
//! them the frames of a clip have other times, so the user is told about them.

use std::path::{Path, PathBuf};

use super::entry::{EntryKind, entries, entry_kind};
use super::skip_reason::{SkipReason, SkippedInput};
use crate::FootageError;
use crate::extension::is_image_name;

/// Collects the skipped entries of a folder of images.
pub(crate) fn collect_skipped_of_clip(listed: &[PathBuf], found: &mut Vec<SkippedInput>) {
    for path in listed {
        match entry_kind(path) {
            EntryKind::Image | EntryKind::Video => {}
            EntryKind::Folder if is_image_name(path) => {
                found.push(SkippedInput::new(path, SkipReason::NotAFile));
            }
            EntryKind::Folder => found.extend(skipped_folder(path, SkipReason::BelowClip)),
            EntryKind::Skipped(reason) => {
                found.extend(reason.map(|reason| SkippedInput::new(path, reason)));
            }
        }
    }
}

/// Collects the skipped entries of a set and of its class folders.
pub(crate) fn collect_skipped_of_set(
    listed: &[PathBuf],
    depth: u32,
    found: &mut Vec<SkippedInput>,
) {
    for path in listed {
        match entry_kind(path) {
            EntryKind::Image => {}
            EntryKind::Video => found.push(SkippedInput::new(path, SkipReason::VideoInSet)),
            EntryKind::Folder if depth == 0 => match entries(path) {
                Ok(listed) => collect_skipped_of_set(&listed, depth + 1, found),
                Err(error) => found.push(unreadable_entry(path, &error)),
            },
            EntryKind::Folder => found.extend(skipped_folder(path, SkipReason::TooDeep)),
            EntryKind::Skipped(reason) => {
                found.extend(reason.map(|reason| SkippedInput::new(path, reason)));
            }
        }
    }
}

/// Returns a folder that is not searched if it has footage or cannot be read.
pub(crate) fn skipped_folder(folder: &Path, reason: SkipReason) -> Option<SkippedInput> {
    match holds_footage(folder, 0) {
        Ok(true) => Some(SkippedInput::new(folder, reason)),
        Ok(false) => None,
        Err(error) => Some(unreadable_entry(folder, &error)),
    }
}

pub(crate) fn unreadable_entry(path: &Path, error: &FootageError) -> SkippedInput {
    let problem = match error {
        FootageError::Unreadable { problem, .. } => problem.clone(),
        other => other.to_string(),
    };
    SkippedInput::new(path, SkipReason::Unreadable { problem })
}

/// Returns true if a folder, or one below it, has an image or a video.
fn holds_footage(folder: &Path, depth: u32) -> Result<bool, FootageError> {
    const DEPTH: u32 = 4;
    let listed = entries(folder)?;
    let is_footage = |path: &PathBuf| {
        matches!(
            entry_kind(path),
            EntryKind::Image
                | EntryKind::Video
                | EntryKind::Skipped(Some(SkipReason::ImageType { .. }))
        )
    };
    let deeper = |path: &PathBuf| {
        depth < DEPTH && path.is_dir() && holds_footage(path, depth + 1).unwrap_or(false)
    };
    Ok(listed.iter().any(is_footage) || listed.iter().any(deeper))
}
