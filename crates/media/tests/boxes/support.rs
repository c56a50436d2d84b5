// SPDX-License-Identifier: MIT OR Apache-2.0
//! Helpers that write box files and read the boxes of a frame.

use std::fs;
use std::path::{Path, PathBuf};

use foveate_media::boxes::{BoxError, BoxFile, FrameBoxes, FrameKey, LabelledBox};
use foveate_pixels::Rect;

pub(crate) fn file(folder: &Path, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(&path, text).unwrap();
    path
}

/// Returns an image of 200 x 100 pixels, the first of its input.
pub(crate) fn image(name: &str) -> FrameKey<'_> {
    FrameKey { name: Path::new(name), own_file: true, number: 0, size: (200, 100) }
}

/// Returns a frame of a video.
pub(crate) fn frame(number: u64) -> FrameKey<'static> {
    FrameKey { name: Path::new("04.mp4"), own_file: false, number, size: (200, 100) }
}

/// Returns the boxes of a frame from a file with this text.
pub(crate) fn at(text: &str, place: &FrameKey<'_>) -> Result<FrameBoxes, BoxError> {
    let folder = tempfile::tempdir().unwrap();
    BoxFile::read(&file(folder.path(), "boxes", text))?.boxes_of_frame(place)
}

pub(crate) fn labelled(corners: [f64; 4], track: Option<u64>) -> LabelledBox {
    LabelledBox { rect: Rect::from_corners(corners).unwrap(), track }
}
