// SPDX-License-Identifier: MIT OR Apache-2.0
//! Entries of folders and patterns that are not read although they might have been meant. A clip without
//! them has other times than one with them, so nobody should learn of it by chance.

use std::fmt;
use std::path::{Path, PathBuf};

use super::entry::{EntryKind, entries, entry_kind};
use super::pattern;
use crate::extension::is_image_name;
use crate::natural::is_same_number;
use crate::plan::tree;
use crate::{FootageError, ImagesAs};

/// Why an entry is not read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum SkipReason {
    /// An image of a type that is not read.
    ImageType {
        /// The name of the type.
        name: &'static str,
    },
    /// A link whose target does not exist.
    BrokenLink,
    /// A file or folder that cannot be opened.
    Unreadable {
        /// What the system says.
        problem: String,
    },
    /// A device, a pipe or a folder with the name of an image or a video.
    NoFile,
    /// A file whose name does not say what it is.
    NoExtension,
    /// An image or a video with the name of something else.
    OtherName,
    /// A video whose extension is not looked for.
    VideoName,
    /// A file of many images.
    DataSet,
    /// A video in a set of images.
    VideoInSet,
    /// A folder with images or videos below a folder of images.
    Below,
    /// A folder with images or videos deeper than a set or tree is searched.
    TooDeep,
    /// A link to a folder in which it lies itself.
    Loop,
    /// A file that a pattern names in other capital or small letters.
    OtherCase,
}

/// An entry of a folder or pattern that is not read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SkippedInput {
    /// The entry.
    pub path: PathBuf,
    /// Why it is not read.
    pub reason: SkipReason,
}

impl SkippedInput {
    pub(crate) fn new(path: &Path, reason: SkipReason) -> Self {
        Self { path: path.to_owned(), reason }
    }
}

/// The entries of an input that are not read. An input that cannot be read at all has none.
pub(crate) fn skipped(input: &Path, images: ImagesAs) -> Vec<SkippedInput> {
    let mut found = Vec::new();
    if input.is_dir() {
        let listed = entries(input).unwrap_or_default();
        let has_images = listed.iter().any(|path| entry_kind(path) == EntryKind::Image);
        match images {
            ImagesAs::Set => in_set(&listed, 0, &mut found),
            _ if has_images => in_clip(&listed, &mut found),
            _ => found = tree(input).map(|tree| tree.skipped).unwrap_or_default(),
        }
    } else if !input.exists()
        && let Some(text) = input.to_str().filter(|text| pattern::is_pattern(text))
    {
        found = pattern::skipped(text);
    }
    found
}

/// What is skipped of the entries of a folder of images.
pub(crate) fn in_clip(listed: &[PathBuf], found: &mut Vec<SkippedInput>) {
    for path in listed {
        match entry_kind(path) {
            EntryKind::Image | EntryKind::Video => {}
            EntryKind::Folder if is_image_name(path) => {
                found.push(SkippedInput::new(path, SkipReason::NoFile));
            }
            EntryKind::Folder => found.extend(below(path, SkipReason::Below)),
            EntryKind::Skipped(reason) => {
                found.extend(reason.map(|reason| SkippedInput::new(path, reason)));
            }
        }
    }
}

/// What is skipped of the entries of a set and of its classes.
fn in_set(listed: &[PathBuf], depth: u32, found: &mut Vec<SkippedInput>) {
    for path in listed {
        match entry_kind(path) {
            EntryKind::Image => {}
            EntryKind::Video => found.push(SkippedInput::new(path, SkipReason::VideoInSet)),
            EntryKind::Folder if depth == 0 => match entries(path) {
                Ok(listed) => in_set(&listed, depth + 1, found),
                Err(error) => found.push(unreadable(path, &error)),
            },
            EntryKind::Folder => found.extend(below(path, SkipReason::TooDeep)),
            EntryKind::Skipped(reason) => {
                found.extend(reason.map(|reason| SkippedInput::new(path, reason)));
            }
        }
    }
}

/// A folder that is not searched, if it holds footage or cannot be read.
pub(crate) fn below(folder: &Path, reason: SkipReason) -> Option<SkippedInput> {
    match holds_footage(folder, 0) {
        Ok(true) => Some(SkippedInput::new(folder, reason)),
        Ok(false) => None,
        Err(error) => Some(unreadable(folder, &error)),
    }
}

pub(crate) fn unreadable(path: &Path, error: &FootageError) -> SkippedInput {
    let problem = match error {
        FootageError::Unreadable { problem, .. } => problem.clone(),
        other => other.to_string(),
    };
    SkippedInput::new(path, SkipReason::Unreadable { problem })
}

/// Whether a folder, or one below it, holds an image or a video.
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

/// Sentences about skipped entries, one for each reason, with how many there are and one of them.
pub(crate) fn sentences(place: &Path, skipped: &[SkippedInput]) -> Vec<String> {
    let mut groups: Vec<Vec<&SkippedInput>> = Vec::new();
    for one in skipped {
        let kind = std::mem::discriminant(&one.reason);
        let same =
            |group: &&mut Vec<&SkippedInput>| std::mem::discriminant(&group[0].reason) == kind;
        match groups.iter_mut().find(same) {
            Some(group) => group.push(one),
            None => groups.push(vec![one]),
        }
    }
    groups.iter().map(|group| sentence(place, group)).collect()
}

fn sentence(place: &Path, group: &[&SkippedInput]) -> String {
    let SkippedInput { path, reason } = group[0];
    let (shown, place) = (path.display(), place.display());
    match (reason, group.len()) {
        (SkipReason::VideoInSet, count) => format!(
            "a set consists of images: videos in `{place}`, {count} in all, such as `{shown}`, are ignored"
        ),
        (SkipReason::Below, _) => format!(
            "images and videos in folders below `{place}`, such as `{shown}`, are ignored; --images set reads \
             images, with the names of their folders as labels"
        ),
        (_, 1) => format!("`{shown}` is skipped: {reason}"),
        (_, more) => {
            format!("{more} entries of `{place}` are skipped, such as `{shown}`: {reason}")
        }
    }
}

impl fmt::Display for SkipReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ImageType { name } => {
                write!(f, "images of the type {name} are not read; convert it to PNG")
            }
            Self::BrokenLink => f.write_str("the target of the link does not exist; mend the link or remove it"),
            Self::Unreadable { problem } => write!(f, "it cannot be read ({problem}); check its permissions"),
            Self::NoFile => f.write_str("it has the name of an image or a video, but is not a file; rename it"),
            Self::NoExtension => {
                f.write_str("it has no extension; rename it if it is an image or a video")
            }
            Self::OtherName => f.write_str(
                "it is an image or a video, but has the extension of neither; rename it",
            ),
            Self::VideoName => f.write_str(
                "videos with this extension are not looked for in folders; name it on its own",
            ),
            Self::DataSet => f.write_str("data sets are not looked for in folders; name it on its own"),
            Self::VideoInSet => f.write_str("a set consists of images, and this is a video"),
            Self::Below => f.write_str("folders below a clip are not read"),
            Self::TooDeep => f.write_str("it lies deeper than folders are searched; name it on its own"),
            Self::Loop => f.write_str("it links to a folder in which it lies itself; remove the link"),
            Self::OtherCase => f.write_str(
                "the pattern matches it only if capital and small letters count as the same; write `[pP]` for both",
            ),
        }
    }
}

/// Files that follow each other in a clip although their names have the same number.
pub(crate) fn same_number<'a>(files: &[&'a Path]) -> Option<(&'a Path, &'a Path)> {
    let mut pairs = files.iter().zip(files.get(1..)?);
    pairs.find(|(one, other)| is_same_number(one, other)).map(|(one, other)| (*one, *other))
}
