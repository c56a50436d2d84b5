// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a file that is no image is, by its first bytes.

use std::io::Read;
use std::path::Path;

use crate::FootageError;
use crate::sets::{cifar, idx, open_unpacked};
use crate::y4m;

/// Files that are read as one source each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FileKind {
    Idx,
    CifarBatch,
    Y4m,
    /// Whatever ffmpeg makes of it.
    Video,
}

pub(crate) fn kind(path: &Path) -> Result<FileKind, FootageError> {
    let mut start = Vec::new();
    // What does not unpack is no IDX; ffmpeg will say what it thinks of it.
    let _ = open_unpacked(path)?.take(16).read_to_end(&mut start);
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
    if idx::is_other(&start) {
        return Err(frameless("it is an IDX file, but not of 8-bit images (00 00 08 03)"));
    }
    Ok(if start.starts_with(&idx::MAGIC) {
        FileKind::Idx
    } else if start.starts_with(y4m::MAGIC) {
        FileKind::Y4m
    } else if binary && cifar::labels_in_batch(length).is_some() {
        FileKind::CifarBatch
    } else {
        FileKind::Video
    })
}
