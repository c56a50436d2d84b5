// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of box files. Every message names the file, and the line if there is one.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// The error that is returned if boxes cannot be read, or do not fit the clips.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum BoxError {
    /// The file or folder cannot be read.
    #[error("cannot read boxes `{}`: {source}", path.display())]
    Io { path: PathBuf, source: io::Error },
    /// The file is wrong as a whole, or at a place that its problem names.
    #[error("cannot read boxes `{}`: {problem}", path.display())]
    File { path: PathBuf, problem: String },
    /// A line of the file is wrong.
    #[error("cannot read boxes `{}`, line {line}: {problem}", path.display())]
    Line { path: PathBuf, line: u64, problem: String },
    /// The file does not exist, neither as given nor near the clip.
    #[error(
        "boxes `{}` do not exist, neither as given nor in the folder of the clip `{clip}` or the one above it; \
         check the path",
        path.display()
    )]
    Missing { path: PathBuf, clip: String },
    /// The number of files is neither one nor the number of clips.
    #[error(
        "{files} files of boxes are given for {clips} clips; give one for each in their order, or one for all"
    )]
    FileCount { files: usize, clips: usize },
    /// Several clips share a file that goes by frame numbers, which count the frames of one clip.
    #[error(
        "boxes `{}` belong to frame numbers, and so to one clip, but `{one}` and `{other}` would \
         share them; give a file for each clip",
        path.display()
    )]
    Shared { path: PathBuf, one: String, other: String },
    /// A name in the file fits two images.
    #[error(
        "the boxes of `{name}` in `{}` fit two images, `{}` and `{}`; write the names with their folders",
        path.display(), one.display(), other.display()
    )]
    Ambiguous { path: PathBuf, name: String, one: PathBuf, other: PathBuf },
    /// An image has another size than the file states, so that its boxes would lie on other pixels.
    #[error(
        "`{}` states {}x{} for the image `{}`, which has {}x{}; its boxes would lie on other pixels{}",
        path.display(), stated.0, stated.1, image.display(), size.0, size.1, size_advice(*size, *stated)
    )]
    ImageSize { path: PathBuf, image: PathBuf, size: (u32, u32), stated: (u32, u32) },
    /// An image has the number 0, but the frames of MOT are numbered from 1.
    #[error(
        "the image `{}` would be frame 0, but frames in `{}` begin at 1; rename the images so that they begin at 1",
        image.display(), path.display()
    )]
    FrameZero { path: PathBuf, image: PathBuf },
    /// No frame of the clip has an entry in the file.
    #[error("no frame of the clip `{clip}` has an entry in `{}`, which {holds}; check that they belong together", path.display())]
    NoEntry { path: PathBuf, clip: String, holds: String },
}

/// Returns the end of a message about sizes that differ.
fn size_advice(size: (u32, u32), stated: (u32, u32)) -> &'static str {
    if size == (stated.1, stated.0) {
        "; if the image is a turned photo, --orientation upright reads it as it was labelled"
    } else {
        "; use the images that were labelled"
    }
}
