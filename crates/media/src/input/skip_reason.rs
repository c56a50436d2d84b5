// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reasons why entries of folders or patterns are not read, as values and as text.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::natural_order::is_same_number;

/// The reason why an entry is not read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum SkipReason {
    /// It is an image of a type that is not read.
    ImageType {
        /// The name of the type.
        name: &'static str,
    },
    /// It is a link whose target does not exist.
    BrokenLink,
    /// It is a file or folder that cannot be opened.
    Unreadable {
        /// The message of the system.
        problem: String,
    },
    /// It is a device, a pipe or a folder with the name of an image or a video.
    NotAFile,
    /// It is a file without an extension, so its name does not give its kind.
    NoExtension,
    /// It is an image or a video with the extension of another kind of file.
    OtherExtension,
    /// It is a video with an extension that is not searched in folders.
    VideoExtension,
    /// It is a file of many images.
    DataSet,
    /// It is a video in a set of images.
    VideoInSet,
    /// It is a folder with images or videos below a folder of images.
    BelowClip,
    /// It is a folder with images or videos that lies deeper than a set or tree is searched.
    TooDeep,
    /// It is a link to a folder that contains the link.
    LinkLoop,
    /// It is a file that would lie between two numbered ones, and does not exist.
    NumberGap,
    /// It is an archive, which is read if it is named.
    Archive,
    /// It is a file that a pattern matches only if capital and small letters are equal.
    OtherCase,
}

/// An entry of a folder or pattern that is not read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SkippedInput {
    /// The path of the entry.
    pub path: PathBuf,
    /// The reason why it is not read.
    pub reason: SkipReason,
}

impl SkippedInput {
    pub(crate) fn new(path: &Path, reason: SkipReason) -> Self {
        Self { path: path.to_owned(), reason }
    }
}

/// Returns sentences about skipped entries: one for each reason, with the number of entries and one
/// example.
pub(crate) fn skip_sentences(place: &Path, skipped: &[SkippedInput]) -> Vec<String> {
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
    groups.iter().map(|group| skip_sentence(place, group)).collect()
}

fn skip_sentence(place: &Path, group: &[&SkippedInput]) -> String {
    let SkippedInput { path, reason } = group[0];
    let (shown, place) = (path.display(), place.display());
    match (reason, group.len()) {
        (SkipReason::VideoInSet, count) => format!(
            "a set consists of images: videos in `{place}`, {count} in all, such as `{shown}`, are ignored"
        ),
        (SkipReason::BelowClip, _) => format!(
            "images and videos in folders below `{place}`, such as `{shown}`, are ignored; --images set reads \
             images, with the names of their folders as labels"
        ),
        (SkipReason::NumberGap, gaps) => format!(
            "the numbers of `{place}` have {gaps} gap{}: `{shown}` does not exist; the frames behind a gap come too \
             early",
            if gaps == 1 { "" } else { "s, the first of them" }
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
            Self::BrokenLink => f.write_str("the target of the link does not exist; repair the link or remove it"),
            Self::Unreadable { problem } => write!(f, "it cannot be read ({problem}); check its permissions"),
            Self::NotAFile => f.write_str("it has the name of an image or a video, but is not a file; rename it"),
            Self::NoExtension => {
                f.write_str("it has no extension; rename it if it is an image or a video")
            }
            Self::OtherExtension => f.write_str(
                "it is an image or a video, but has the extension of neither; rename it",
            ),
            Self::VideoExtension => f.write_str(
                "videos with this extension are not looked for in folders; name it on its own",
            ),
            Self::DataSet => f.write_str("data sets are not looked for in folders; name it on its own"),
            Self::VideoInSet => f.write_str("a set consists of images, and this is a video"),
            Self::BelowClip => f.write_str("folders below a clip are not read"),
            Self::TooDeep => f.write_str("it lies deeper than folders are searched; name it on its own"),
            Self::LinkLoop => f.write_str("it links to a folder in which it lies itself; remove the link"),
            Self::NumberGap => f.write_str("it does not exist"),
            Self::Archive => f.write_str("archives are not looked for in folders; name it on its own"),
            Self::OtherCase => f.write_str(
                "the pattern matches it only if capital and small letters count as the same; write `[pP]` for both",
            ),
        }
    }
}

/// Returns two consecutive files of a clip whose names have the same number.
pub(crate) fn find_same_number<'a>(files: &[&'a Path]) -> Option<(&'a Path, &'a Path)> {
    let mut pairs = files.iter().zip(files.get(1..)?);
    pairs.find(|(one, other)| is_same_number(one, other)).map(|(one, other)| (*one, *other))
}
