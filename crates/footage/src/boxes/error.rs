// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of box files. Every message names the file, and the line if there is one.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// The error that is returned if boxes cannot be read, or do not fit the clips.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BoxError {
    /// The file or folder cannot be read.
    #[error("cannot read boxes `{}`: {source}", path.display())]
    Io {
        /// The path of the file or folder.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// The file is wrong as a whole, or at a place that its problem names.
    #[error("cannot read boxes `{}`: {problem}", path.display())]
    File {
        /// The path of the file or folder.
        path: PathBuf,
        /// The text that says what is wrong, and what is expected.
        problem: String,
    },
    /// A line of the file is wrong.
    #[error("cannot read boxes `{}`, line {line}: {problem}", path.display())]
    Line {
        /// The path of the file.
        path: PathBuf,
        /// The number of the line, counted from 1.
        line: u64,
        /// The text that says what is wrong, and what is expected.
        problem: String,
    },
    /// The file does not exist, neither as given nor near the clip.
    #[error(
        "boxes `{}` do not exist, neither as given nor in the folder of the clip `{clip}` or the one above it; \
         check the path",
        path.display()
    )]
    Missing {
        /// The path as given.
        path: PathBuf,
        /// The name of the clip.
        clip: String,
    },
    /// The number of files is neither one nor the number of clips.
    #[error(
        "{files} files of boxes are given for {clips} clips; give one for each in their order, or one for all"
    )]
    FileCount {
        /// The number of files that are given.
        files: usize,
        /// The number of clips.
        clips: usize,
    },
    /// Several clips share a file that goes by frame numbers, which count the frames of one clip.
    #[error(
        "boxes `{}` belong to frame numbers, and so to one clip, but `{one}` and `{other}` would \
         share them; give a file for each clip",
        path.display()
    )]
    Shared {
        /// The path of the file.
        path: PathBuf,
        /// The name of one clip.
        one: String,
        /// The name of another clip.
        other: String,
    },
    /// A name in the file fits two images.
    #[error(
        "the boxes of `{name}` in `{}` fit two images, `{}` and `{}`; write the names with their folders",
        path.display(), one.display(), other.display()
    )]
    Ambiguous {
        /// The path of the file.
        path: PathBuf,
        /// The name in the file.
        name: String,
        /// One of the images.
        one: PathBuf,
        /// The other image.
        other: PathBuf,
    },
    /// An image has another size than the file states, so that its boxes would lie on other pixels.
    #[error(
        "`{}` states {}x{} for the image `{}`, which has {}x{}; its boxes would lie on other pixels{}",
        path.display(), stated.0, stated.1, image.display(), size.0, size.1, size_advice(*size, *stated)
    )]
    ImageSize {
        /// The path of the file.
        path: PathBuf,
        /// The path of the image.
        image: PathBuf,
        /// The width and height of the image as it is read.
        size: (u32, u32),
        /// The width and height that the file states.
        stated: (u32, u32),
    },
    /// An image has the number 0, but the frames of MOT are numbered from 1.
    #[error(
        "the image `{}` would be frame 0, but frames in `{}` begin at 1; rename the images so that they begin at 1",
        image.display(), path.display()
    )]
    FrameZero {
        /// The path of the file.
        path: PathBuf,
        /// The path of the image.
        image: PathBuf,
    },
    /// No frame of the clip has an entry in the file.
    #[error("no frame of the clip `{clip}` has an entry in `{}`, which {holds}; check that they belong together", path.display())]
    NoEntry {
        /// The path of the file or folder.
        path: PathBuf,
        /// The name of the clip.
        clip: String,
        /// A text that describes the entries of the file, for the message.
        holds: String,
    },
}

/// Returns the end of a message about sizes that differ.
fn size_advice(size: (u32, u32), stated: (u32, u32)) -> &'static str {
    if size == (stated.1, stated.0) {
        "; if the image is a turned photo, --orientation upright reads it as it was labelled"
    } else {
        "; use the images that were labelled"
    }
}
