// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kind of a file according to its extension.

use std::path::Path;

/// Files with these extensions are read from folders and patterns as images.
const IMAGE_EXTENSIONS: [&str; 11] =
    ["png", "jpg", "jpeg", "jpe", "jfif", "bmp", "pgm", "ppm", "pbm", "pnm", "pam"];
/// Files with these extensions are read from folders and patterns as clips.
const VIDEO_EXTENSIONS: [&str; 17] = [
    "mp4", "m4v", "mov", "avi", "mkv", "webm", "mpg", "mpeg", "ts", "mts", "m2ts", "wmv", "flv",
    "ogv", "3gp", "gif", "y4m",
];
const UNREAD_IMAGE_TYPES: [(&str, &[&str]); 14] = [
    ("WebP", &["webp"]),
    ("TIFF", &["tif", "tiff"]),
    ("HEIF", &["heic", "heif", "hif"]),
    ("AVIF", &["avif"]),
    ("JPEG XL", &["jxl"]),
    ("JPEG 2000", &["jp2", "j2k", "jpx", "jpf"]),
    ("OpenEXR", &["exr"]),
    ("Radiance HDR", &["hdr"]),
    ("TGA", &["tga"]),
    ("Photoshop", &["psd"]),
    ("icon", &["ico"]),
    ("QOI", &["qoi"]),
    ("raw camera", &["dng", "cr2", "cr3", "nef", "arw", "raf", "orf", "rw2", "raw"]),
    ("animated PNG", &["apng"]),
];
/// Videos with these extensions are read if they are named, but not searched in folders.
const OTHER_VIDEO_EXTENSIONS: [&str; 27] = [
    "264", "265", "h264", "h265", "hevc", "avc", "ivf", "nut", "mxf", "vob", "asf", "rm", "rmvb",
    "dv", "divx", "f4v", "qt", "m1v", "m2v", "mpv", "3g2", "ogm", "mjpg", "mjpeg", "mj2", "yuv",
    "av1",
];
/// The extensions of text and tables, which are often beside images.
const NOTE_EXTENSIONS: [&str; 12] =
    ["txt", "csv", "tsv", "json", "xml", "yaml", "yml", "toml", "md", "log", "ini", "html"];

fn extension_in(path: &Path, known: &[&str]) -> bool {
    path.extension()
        .is_some_and(|extension| known.iter().any(|known| extension.eq_ignore_ascii_case(known)))
}

pub(crate) fn is_image_name(path: &Path) -> bool {
    extension_in(path, &IMAGE_EXTENSIONS)
}

pub(crate) fn is_video_name(path: &Path) -> bool {
    extension_in(path, &VIDEO_EXTENSIONS)
}

pub(crate) fn unread_image_type_by_name(path: &Path) -> Option<&'static str> {
    let found = UNREAD_IMAGE_TYPES.iter().find(|(_, extensions)| extension_in(path, extensions));
    found.map(|(name, _)| *name)
}

pub(crate) fn is_other_video(path: &Path) -> bool {
    extension_in(path, &OTHER_VIDEO_EXTENSIONS)
}

pub(crate) fn is_note(path: &Path) -> bool {
    extension_in(path, &NOTE_EXTENSIONS)
}
