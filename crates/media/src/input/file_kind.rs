// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of a reader for a file that is not an image, by its first bytes.

use std::io::Read;
use std::path::Path;

use foveate_tools::foreign_format;

use super::content_kind::{ContentKind, content_kind_of};
use crate::FootageError;
use crate::extension::{is_video_name, unread_image_type_by_name};
use crate::picture::StreamKind;
use crate::sets::{cifar, idx, open_unpacked};
use crate::y4m;

/// The kinds of files that are one source each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FileKind {
    Idx,
    CifarBatch,
    Y4m,
    /// A ZIP archive of images.
    Zip,
    /// Images of one size that follow each other directly.
    ImageStream(StreamKind),
    /// Any file that ffmpeg can read.
    Video,
}

/// The number of bytes that are read.
const START: u64 = 512;

pub(crate) fn file_kind(path: &Path) -> Result<FileKind, FootageError> {
    let mut start = Vec::new();
    // A file that cannot be unpacked is not IDX; ffmpeg reports what is wrong with it.
    let _ = open_unpacked(path)?.take(START).read_to_end(&mut start);
    let frameless = |problem: &str| FootageError::Frameless {
        path: path.to_owned(),
        problem: problem.to_owned(),
    };
    if start.is_empty() {
        return Err(frameless("it is empty"));
    }
    let length = std::fs::metadata(path).map_or(0, |known| known.len());
    let binary = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("bin"));
    if start.starts_with(&idx::LABEL_MAGIC) {
        return Err(frameless(
            "it is an IDX file of labels; name the file of the images instead, and this one with --labels if the \
             two are not in one folder",
        ));
    }
    if idx::is_other_idx(&start) {
        return Err(frameless("it is an IDX file, but not of 8-bit images (00 00 08 03)"));
    }
    if start.starts_with(&idx::MAGIC) {
        return Ok(FileKind::Idx);
    }
    if start.starts_with(y4m::MAGIC) {
        return Ok(FileKind::Y4m);
    }
    if binary && cifar::labels_in_batch(length).is_some() {
        return Ok(FileKind::CifarBatch);
    }
    if let Some(what) = foreign_format(&start) {
        return Err(frameless(&format!(
            "it is {what}; write its frames as images or as a video first, for example with a script in Python"
        )));
    }
    let other = match content_kind_of(&start) {
        ContentKind::OtherImage(name) => Some(name),
        ContentKind::Unknown => unread_image_type_by_name(path),
        // ffmpeg would render the text as frames.
        ContentKind::Text if !is_video_name(path) => {
            return Err(FootageError::Video {
                path: path.to_owned(),
                problem: "it is text".to_owned(),
            });
        }
        ContentKind::Archive => return Ok(FileKind::Zip),
        ContentKind::Image | ContentKind::Video | ContentKind::DataSet | ContentKind::Text => None,
    };
    match other {
        Some(name) => Err(FootageError::ImageType { path: path.to_owned(), name }),
        None => Ok(FileKind::Video),
    }
}
