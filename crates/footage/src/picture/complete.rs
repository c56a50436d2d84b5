// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether an image file reaches its end mark. Decoders are lenient here: a JPEG cut in half decodes
//! to half a picture and grey, and a PNG without its last chunks to whatever was there.

use image::ImageFormat;

/// What is missing, if anything; formats without an end mark are left to their decoder.
pub(super) fn missing(format: ImageFormat, bytes: &[u8]) -> Option<String> {
    match format {
        ImageFormat::Png if !png_ends(bytes) => Some("it has no end chunk (IEND)".to_owned()),
        ImageFormat::Jpeg if !jpeg_ends(bytes) => Some("it has no end marker (EOI)".to_owned()),
        _ => None,
    }
}

/// Follows the chunks: length, type, data, checksum.
fn png_ends(bytes: &[u8]) -> bool {
    const SIGNATURE: usize = 8;
    let mut at = SIGNATURE;
    while let Some(&[a, b, c, d, ref name @ ..]) =
        bytes.get(at..).and_then(<[u8]>::first_chunk::<8>)
    {
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        at = at.saturating_add(length).saturating_add(12);
        if name == b"IEND" {
            return at <= bytes.len();
        }
    }
    false
}

/// Follows the markers; between segments with a length there is only coded data, where a marker is
/// an FF that is followed by neither 00 nor a restart.
fn jpeg_ends(bytes: &[u8]) -> bool {
    let mut at = 2;
    loop {
        let rest = bytes.get(at..).unwrap_or_default();
        let Some(mark) = rest.windows(2).position(|pair| pair[0] == 0xFF && pair[1] != 0xFF) else {
            return false;
        };
        at += mark + 2;
        match rest.get(mark + 1) {
            Some(0xD9) => return true,
            Some(0x00 | 0x01 | 0xD0..=0xD8) => {}
            _ => match bytes.get(at..).and_then(<[u8]>::first_chunk) {
                Some(&length) => at += usize::from(u16::from_be_bytes(length)),
                None => return false,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_mark_inside_a_segment_is_not_the_end() {
        let thumbnail = [0xFF, 0xD8, 0xFF, 0xE1, 0, 4, 0xFF, 0xD9];
        assert!(!jpeg_ends(&thumbnail));
        let whole = [&thumbnail[..], &[0xFF, 0xDA, 0, 2, 7, 0xFF, 0, 0xFF, 0xD3, 9, 0xFF, 0xD9]];
        assert!(jpeg_ends(&whole.concat()));
    }

    #[test]
    fn nothing_is_no_image() {
        assert!(!jpeg_ends(&[]) && !png_ends(&[]));
        assert!(!png_ends(&[0xFF; 64]));
    }
}
