// SPDX-License-Identifier: MIT OR Apache-2.0
//! The header and the end of a JPEG, found without its codes.

use super::bits::marker_at;
use super::segment;
use crate::picture::outline::ImageOutline;

/// The segment that announces further pictures in a file, such as the second one of a stereo photo.
const MULTI_PICTURE: (u8, &[u8]) = (0xE2, b"MPF\0");

/// Returns the outline of a JPEG. Returns `None` if it has no header, and for a photo with further
/// pictures.
pub(in crate::picture) fn outline(bytes: &[u8]) -> Option<ImageOutline<'_>> {
    let mut header = None;
    // The start marker SOI has two bytes.
    let mut at = 2;
    while let Some((marker, next)) = marker_at(bytes, at) {
        at = next;
        match marker {
            0xD9 => return Some(ImageOutline { header: header?, after: bytes.get(at..) }),
            0x01 | 0xD0..=0xD7 => continue,
            0xD8 => break,
            _ => {}
        }
        let Ok(content) = segment(bytes, at) else { break };
        let start = at;
        at += 2 + content.len();
        match marker {
            _ if marker == MULTI_PICTURE.0 && content.starts_with(MULTI_PICTURE.1) => return None,
            // DHT, JPG and DAC lie between the headers of frames.
            0xC4 | 0xC8 | 0xCC => {}
            // The header tells the kind of JPEG by its marker.
            0xC0..=0xCF => header = bytes.get(start - 1..at),
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
