// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the extension of a file says.

use std::path::Path;

/// Files with these extensions are taken from folders and patterns as images.
const IMAGE_EXTENSIONS: [&str; 9] =
    ["png", "jpg", "jpeg", "bmp", "pgm", "ppm", "pbm", "pnm", "pam"];
/// And these as clips.
pub(crate) const VIDEO_EXTENSIONS: [&str; 17] = [
    "mp4", "m4v", "mov", "avi", "mkv", "webm", "mpg", "mpeg", "ts", "mts", "m2ts", "wmv", "flv",
    "ogv", "3gp", "gif", "y4m",
];

pub(crate) fn extension_in(path: &Path, known: &[&str]) -> bool {
    path.extension()
        .is_some_and(|extension| known.iter().any(|known| extension.eq_ignore_ascii_case(known)))
}

pub(crate) fn is_image_name(path: &Path) -> bool {
    extension_in(path, &IMAGE_EXTENSIONS)
}
