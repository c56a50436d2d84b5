// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why there are no boxes. Every message names the file, and the line where there is one.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Boxes that cannot be read, or that do not fit the clips.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BoxError {
    /// The file or folder cannot be read.
    #[error("cannot read boxes `{}`: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file is wrong as a whole, or in a place that its problem names.
    #[error("cannot read boxes `{}`: {problem}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong, and what would be right.
        problem: String,
    },
    /// A line of the file is wrong.
    #[error("cannot read boxes `{}`, line {line}: {problem}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: u64,
        /// What is wrong, and what would be right.
        problem: String,
    },
    /// There is no such file, neither as given nor beside the clip.
    #[error(
        "boxes `{}` do not exist, neither as given nor in the folder of the clip `{clip}` or the one above it; \
         check the path",
        path.display()
    )]
    Missing {
        /// The path as given.
        path: PathBuf,
        /// The clip.
        clip: String,
    },
    /// As many files as clips are needed, or one for all.
    #[error(
        "{files} files of boxes are given for {clips} clips; give one for each in their order, or one for all"
    )]
    Count {
        /// How many files are given.
        files: usize,
        /// How many clips there are.
        clips: usize,
    },
    /// Frame numbers mean frames of one clip.
    #[error(
        "boxes `{}` go by frame number, so they belong to one clip, but `{one}` and `{other}` would share them; \
         give a file for each clip",
        path.display()
    )]
    Shared {
        /// The file.
        path: PathBuf,
        /// A clip.
        one: String,
        /// Another.
        other: String,
    },
    /// A name in the file fits two images.
    #[error(
        "the boxes of `{name}` in `{}` fit two images, `{}` and `{}`; write the names with their folders",
        path.display(), one.display(), other.display()
    )]
    Ambiguous {
        /// The file.
        path: PathBuf,
        /// The name in it.
        name: String,
        /// An image.
        one: PathBuf,
        /// Another.
        other: PathBuf,
    },
    /// Names of images count from 0, frames of MOT from 1.
    #[error(
        "the image `{}` would be frame 0, but frames in `{}` begin at 1; rename the images so that they begin at 1",
        image.display(), path.display()
    )]
    FrameZero {
        /// The file.
        path: PathBuf,
        /// The image.
        image: PathBuf,
    },
    /// No frame of the clip is in the file.
    #[error("no frame of the clip `{clip}` has an entry in `{}`, which {holds}; check that they belong together", path.display())]
    NoneFit {
        /// The file.
        path: PathBuf,
        /// The clip.
        clip: String,
        /// What it holds instead.
        holds: String,
    },
}
