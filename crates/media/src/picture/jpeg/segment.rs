// SPDX-License-Identifier: MIT OR Apache-2.0
//! The segments of a JPEG. Its header and its end, found without its codes.

use crate::picture::conversion::ImageOutline;
use crate::picture::damage::PictureFault;

/// A marker and what it announces.
pub(super) struct Segment<'a> {
    pub(super) marker: u8,
    /// What stands between the length and the end. Markers without a length have no content.
    pub(super) content: &'a [u8],
    pub(super) end: usize,
}

impl<'a> Segment<'a> {
    /// Finds the segment at a position.
    pub(super) fn at(bytes: &'a [u8], at: usize) -> Result<Self, PictureFault> {
        let Some((marker, start)) = marker_at(bytes, at) else {
            let rest = bytes.get(at..).unwrap_or_default();
            return Err(if rest.iter().all(|&byte| byte == 0xFF) {
                PictureFault::truncated("it has no end marker (EOI)")
            } else {
                PictureFault::damaged("there are bytes before a marker")
            });
        };
        if matches!(marker, 0x01 | 0xD0..=0xD9) {
            return Ok(Self { marker, content: &[], end: start });
        }
        let short = || PictureFault::truncated("it ends inside a segment");
        let rest = &bytes[start..];
        let length = usize::from(u16::from_be_bytes(*rest.first_chunk().ok_or_else(short)?));
        if length < 2 {
            return Err(PictureFault::damaged(format!("a segment has the length {length}")));
        }
        let content = rest.get(2..length).ok_or_else(short)?;
        Ok(Self { marker, content, end: start + length })
    }
}

/// Returns the marker at a position, which may begin with several bytes FF, and the position after
/// it.
pub(super) fn marker_at(bytes: &[u8], at: usize) -> Option<(u8, usize)> {
    let rest = bytes.get(at..)?;
    let fill = rest.iter().take_while(|&&byte| byte == 0xFF).count();
    let marker = *rest.get(fill)?;
    (fill > 0 && marker != 0).then_some((marker, at + fill + 1))
}

/// Returns the outline of a JPEG. Returns `None` if it has no header, and for a photo with further
/// pictures.
pub(in crate::picture) fn outline(bytes: &[u8]) -> Option<ImageOutline<'_>> {
    let mut header = None;
    // The start marker SOI has two bytes.
    let mut at = 2;
    while let Ok(Segment { marker, content, end }) = Segment::at(bytes, at) {
        at = end;
        match marker {
            0xD8 => break,
            0xD9 => return Some(ImageOutline { header: header?, after: bytes.get(at..) }),
            // It announces further pictures, such as the second one of a stereo photo.
            0xE2 if content.starts_with(b"MPF\0") => return None,
            // DHT, JPG and DAC lie between the headers of frames.
            0xC4 | 0xC8 | 0xCC => {}
            // The header tells the kind of JPEG by its marker, and by the length after it.
            0xC0..=0xCF => header = bytes.get(end - content.len() - 3..end),
            0xDA => {
                let is_marker =
                    |pair: &[u8]| pair[0] == 0xFF && !matches!(pair[1], 0 | 0xFF | 0xD0..=0xD7);
                let Some(length) = bytes[at..].windows(2).position(is_marker) else { break };
                at += length;
            }
            _ => {}
        }
    }
    Some(ImageOutline { header: header?, after: None })
}
