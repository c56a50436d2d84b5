// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kind of a file according to its first bytes, independent of its name.

use std::io::{self, Read};
use std::path::Path;

use image::ImageFormat;

use crate::sets::idx;
use crate::y4m;

/// The first bytes of a ZIP archive with entries, and of one without.
const ZIP_MAGICS: [&[u8]; 2] = [b"PK\x03\x04", b"PK\x05\x06"];

/// The number of bytes that are read.
const START: u64 = 512;

/// The kind of a file according to its first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ContentKind {
    /// An image that can be read.
    Image,
    /// An image of a type that is not read, with the name of the type.
    OtherImage(&'static str),
    Video,
    DataSet,
    /// A ZIP archive.
    Archive,
    Text,
    Unknown,
}

/// Reads the first bytes of a file. A pipe or a device is not opened, since bytes that are read
/// from it are lost.
pub(crate) fn content(path: &Path) -> io::Result<ContentKind> {
    let mut start = Vec::new();
    if path.metadata()?.is_file() {
        foveate_tools::open_file(path)?.take(START).read_to_end(&mut start)?;
    }
    Ok(content_kind_of(&start))
}

/// Returns the name of an image type that is not read.
pub(crate) fn unread_image_type_by_content(start: &[u8]) -> Option<&'static str> {
    const JPEG_XL: &[u8] = b"\0\0\0\x0cJXL ";
    const JPEG_2000: &[u8] = b"\0\0\0\x0cjP  ";
    let brand = start.get(4..12).unwrap_or_default();
    Some(match image::guess_format(start).ok() {
        Some(ImageFormat::WebP) => "WebP",
        Some(ImageFormat::Tiff) => "TIFF",
        Some(ImageFormat::Avif) => "AVIF",
        Some(ImageFormat::OpenExr) => "OpenEXR",
        Some(ImageFormat::Hdr) => "Radiance HDR",
        Some(ImageFormat::Qoi) => "QOI",
        Some(ImageFormat::Dds) => "DDS",
        Some(ImageFormat::Farbfeld) => "Farbfeld",
        _ if start.starts_with(JPEG_XL) || start.starts_with(b"\xFF\x0A") => "JPEG XL",
        _ if start.starts_with(JPEG_2000) || start.starts_with(b"\xFF\x4F\xFF\x51") => "JPEG 2000",
        _ if matches!(brand, b"ftypheic" | b"ftypheix" | b"ftypmif1") => "HEIF",
        _ if start.starts_with(b"8BPS\0\x01") => "Photoshop",
        _ => return None,
    })
}

/// Returns the kind of a file that starts with these bytes.
pub(crate) fn content_kind_of(start: &[u8]) -> ContentKind {
    if let Some(name) = unread_image_type_by_content(start) {
        return ContentKind::OtherImage(name);
    }
    if is_image(start) {
        ContentKind::Image
    } else if is_video(start) {
        ContentKind::Video
    } else if start.starts_with(&idx::MAGIC) {
        ContentKind::DataSet
    } else if is_archive_start(start) {
        ContentKind::Archive
    } else if is_text(start) {
        ContentKind::Text
    } else {
        ContentKind::Unknown
    }
}

pub(crate) fn is_archive_start(start: &[u8]) -> bool {
    ZIP_MAGICS.iter().any(|magic| start.starts_with(magic))
}

/// Returns true for the start of a supported image. Types whose signature has two letters need more
/// evidence, or much text would pass for an image.
fn is_image(start: &[u8]) -> bool {
    match image::guess_format(start) {
        Ok(ImageFormat::Png | ImageFormat::Jpeg) => true,
        Ok(ImageFormat::Bmp) => {
            matches!(
                start.get(6..18),
                Some([0, 0, 0, 0, .., 12 | 40 | 52 | 56 | 64 | 108 | 124, 0, 0, 0])
            )
        }
        Ok(ImageFormat::Pnm) => {
            start.get(2).is_some_and(|byte| byte.is_ascii_whitespace() || *byte == b'#')
        }
        _ => false,
    }
}

fn is_video(start: &[u8]) -> bool {
    let at =
        |place: usize, mark: &[u8]| start.get(place..).is_some_and(|rest| rest.starts_with(mark));
    let starts: [&[u8]; 8] = [
        b"GIF8",
        b"OggS",
        b"FLV\x01",
        b"\x1A\x45\xDF\xA3",
        b"\x30\x26\xB2\x75\x8E\x66\xCF\x11",
        b"\0\0\x01\xBA",
        b"\0\0\x01\xB3",
        y4m::MAGIC,
    ];
    starts.iter().any(|mark| start.starts_with(mark))
        || at(4, b"ftyp")
        || at(4, b"moov")
        || (start.starts_with(b"RIFF") && at(8, b"AVI "))
        || (start.len() > 376 && [0, 188, 376].iter().all(|&place| start[place] == 0x47))
}

/// Returns true for valid UTF-8 that has only printable characters and white space.
fn is_text(start: &[u8]) -> bool {
    let text = match str::from_utf8(start) {
        Ok(text) => text,
        // The last character may be incomplete.
        Err(error) if error.error_len().is_none() => {
            str::from_utf8(&start[..error.valid_up_to()]).unwrap_or_default()
        }
        Err(_) => return false,
    };
    !text.is_empty()
        && !text.contains(|c: char| c.is_control() && !c.is_whitespace() && c != '\x1B')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_bytes_tell_what_a_file_is() {
        let transport: Vec<u8> = (0..400).map(|at| if at % 188 == 0 { 0x47 } else { 1 }).collect();
        for (start, content) in [
            (&b"\x89PNG\r\n\x1a\n...."[..], ContentKind::Image),
            (b"P5 3 2 255\n......", ContentKind::Image),
            (b"BM\x46\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0", ContentKind::Image),
            (b"BMW and P5 are words", ContentKind::Text),
            (b"P50 is a word, too", ContentKind::Text),
            (b"II*\0\x08\0\0\0", ContentKind::OtherImage("TIFF")),
            (b"RIFF\x10\0\0\0WEBPVP8X", ContentKind::OtherImage("WebP")),
            (b"RIFF\x10\0\0\0AVI LIST", ContentKind::Video),
            (b"RIFF\x10\0\0\0WAVEfmt ", ContentKind::Unknown),
            (b"\0\0\0\x20ftypisom\0\0\x02\0", ContentKind::Video),
            (b"\0\0\0\x20ftypheic\0\0\0\0", ContentKind::OtherImage("HEIF")),
            (b"YUV4MPEG2 W4 H4", ContentKind::Video),
            (&transport, ContentKind::Video),
            (b"\0\0\x08\x03\0\0\0\x02", ContentKind::DataSet),
            (b"PK\x03\x04\x14\0", ContentKind::Archive),
            ("schöne Zeilen\n\x1B[1mfett".as_bytes(), ContentKind::Text),
            (&"ö".as_bytes()[..1], ContentKind::Unknown),
            (b"", ContentKind::Unknown),
            (b"\0\x01\x02", ContentKind::Unknown),
        ] {
            assert_eq!(content_kind_of(start), content, "{}", start.escape_ascii());
        }
    }
}
