// SPDX-License-Identifier: MIT OR Apache-2.0
//! Patterns of names, such as `frames/*.png`.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use glob::{MatchOptions, Pattern};

use super::entry::{EntryKind, entry_kind, in_natural_order};
use super::skip_reason::{SkipReason, SkippedInput};
use super::skipped_entries::collect_skipped_of_clip;
use crate::FootageError;
use crate::source::file_feeds::ImageFile;

/// Returns true if a name that is not that of a file is a pattern.
pub(crate) fn is_pattern(text: &str) -> bool {
    text.contains(['*', '?', '['])
}

/// Returns the images that a pattern matches.
pub(super) fn pattern_images(text: &str) -> Result<Vec<ImageFile>, FootageError> {
    let files = pattern_matches(text, true)?;
    let of = |kind: EntryKind| -> Vec<&PathBuf> {
        files.iter().filter(|path| entry_kind(path) == kind).collect()
    };
    let (images, videos) = (of(EntryKind::Image), of(EntryKind::Video));
    match (images.as_slice(), videos.as_slice()) {
        ([], []) => Err(no_match_error(text, &files)),
        ([], [video, ..]) => Err(FootageError::Option {
            option: "the pattern",
            problem: format!(
                "`{text}` matches videos, such as `{}`, but a pattern is for images; name the videos or \
                 their folder, or leave the quotation marks out",
                video.display()
            ),
        }),
        ([image, ..], [video, ..]) => Err(FootageError::Mixed {
            place: text.to_owned(),
            images: images.len(),
            videos: videos.len(),
            video: video.to_path_buf(),
            pattern: image
                .with_file_name("*")
                .with_extension(image.extension().unwrap_or_default())
                .display()
                .to_string(),
        }),
        ([_, ..], []) => Ok(images.into_iter().cloned().map(ImageFile::plain).collect()),
    }
}

fn no_match_error(text: &str, files: &[PathBuf]) -> FootageError {
    let other = files.iter().find_map(|path| unread_kind_error(text, path));
    other.unwrap_or_else(|| FootageError::NoMatch { pattern: text.to_owned() })
}

/// Returns the error for a file that a pattern or a name of numbered files matches, if the file is
/// an image of a type that is not read, or an archive.
pub(super) fn unread_kind_error(text: &str, path: &Path) -> Option<FootageError> {
    match entry_kind(path) {
        EntryKind::Skipped(Some(SkipReason::ImageType { name })) => {
            Some(FootageError::ImageType { path: path.to_owned(), name })
        }
        EntryKind::Skipped(Some(SkipReason::Archive)) => {
            let problem = format!(
                "`{text}` matches archives, such as `{}`, but a pattern is for images; name one archive",
                path.display()
            );
            Some(FootageError::Option { option: "the pattern", problem })
        }
        _ => None,
    }
}

/// Returns the files that a pattern matches and that are not read.
pub(crate) fn skipped_by_pattern(text: &str) -> Vec<SkippedInput> {
    let Ok(files) = pattern_matches(text, true) else { return Vec::new() };
    let mut found = Vec::new();
    collect_skipped_of_clip(&files, &mut found);
    let own: HashSet<&PathBuf> = files.iter().collect();
    let others = pattern_matches(text, false).unwrap_or_default();
    let others =
        others.iter().filter(|path| !own.contains(path) && entry_kind(path) == EntryKind::Image);
    found.extend(others.map(|path: &PathBuf| SkippedInput::new(path, SkipReason::OtherCase)));
    found
}

fn pattern_matches(text: &str, case_sensitive: bool) -> Result<Vec<PathBuf>, FootageError> {
    let invalid = |error: glob::PatternError| FootageError::Pattern {
        pattern: text.to_owned(),
        problem: error.to_string(),
    };
    Pattern::new(text).map_err(invalid)?;
    let options =
        MatchOptions { case_sensitive, require_literal_leading_dot: true, ..MatchOptions::new() };
    let mut files = Vec::new();
    for found in glob::glob_with(text, options).map_err(invalid)? {
        files.push(found.map_err(|error| FootageError::Unreadable {
            path: error.path().to_owned(),
            problem: error.error().to_string(),
        })?);
    }
    Ok(in_natural_order(files))
}
