// SPDX-License-Identifier: MIT OR Apache-2.0
//! Streams of images, such as the MJPEG of cameras: images of one size and kind that follow each
//! other directly. What cameras and phones put behind the end of a photo is no stream: previews and
//! gain maps have another size, and photos of several views say so in their first picture.

use super::conversion::ImageOutline;
use super::{jpeg, png};

/// The kind of the images of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StreamKind {
    Jpeg,
    Png,
    Bmp,
}

impl StreamKind {
    /// Returns the name of ffmpeg's demuxer, which would else follow from the name of the file.
    pub(crate) fn demuxer(self) -> &'static str {
        match self {
            Self::Jpeg => "jpeg_pipe",
            Self::Png => "png_pipe",
            Self::Bmp => "bmp_pipe",
        }
    }
}

/// Returns the kind of a stream, if another image of the same size and kind follows the first one
/// directly. The bytes must reach as far as its header.
pub(super) fn stream_kind(bytes: &[u8]) -> Option<StreamKind> {
    let ImageOutline { header, after } = outline(bytes)?;
    let next = outline(after?).filter(|next| next.header == header);
    next.map(|_| match bytes[0] {
        0xFF => StreamKind::Jpeg,
        b'B' => StreamKind::Bmp,
        _ => StreamKind::Png,
    })
}

fn outline(bytes: &[u8]) -> Option<ImageOutline<'_>> {
    match image::guess_format(bytes).ok()? {
        image::ImageFormat::Jpeg => jpeg::outline(bytes),
        image::ImageFormat::Png => png::outline(bytes),
        image::ImageFormat::Bmp => bmp_outline(bytes),
        _ => None,
    }
}

/// Returns the outline of a BMP: its length stands in its header.
fn bmp_outline(bytes: &[u8]) -> Option<ImageOutline<'_>> {
    let length = u32::from_le_bytes(*bytes.get(2..)?.first_chunk()?);
    // The size of the header, width, height, planes and bits per pixel.
    let header = bytes.get(14..30)?;
    Some(ImageOutline { header, after: bytes.get(usize::try_from(length).ok()?..) })
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::{DynamicImage, ImageFormat};

    use super::*;

    fn is_stream(bytes: &[u8]) -> bool {
        stream_kind(bytes).is_some()
    }

    fn encoded(width: u32, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        DynamicImage::new_luma8(width, 9).write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn only_images_of_one_size_and_kind_are_a_stream() {
        for format in [ImageFormat::Jpeg, ImageFormat::Png, ImageFormat::Bmp] {
            let (one, other) = (encoded(16, format), encoded(24, format));
            assert!(!is_stream(&one) && !is_stream(&[]), "{format:?}");
            assert!(is_stream(&one.repeat(2)) && is_stream(&one.repeat(3)), "{format:?}");
            // The second image may be incomplete.
            assert!(is_stream(&[&one[..], &one[..one.len() - 9]].concat()), "{format:?}");
            // These are a preview, padding, another kind of image, and a video of a motion photo.
            for tail in [&other[..], &[0; 40], b"\0\0\0\x20ftypmp42"] {
                assert!(!is_stream(&[&one[..], tail].concat()), "{format:?}");
                assert!(!is_stream(&[&one[..], tail, &one[..]].concat()), "{format:?}");
            }
            for kind in [ImageFormat::Jpeg, ImageFormat::Png, ImageFormat::Bmp] {
                let mixed = [&one[..], &encoded(16, kind)].concat();
                assert_eq!(is_stream(&mixed), kind == format, "{format:?}, {kind:?}");
            }
        }
    }

    /// Photos of two views (MPO) have two pictures of one size, and say so in a segment.
    #[test]
    fn a_photo_of_several_views_is_no_stream() {
        let one = encoded(16, ImageFormat::Jpeg);
        let marked = [&one[..2], b"\xFF\xE2\0\x08MPF\0II", &one[2..]].concat();
        assert!(!is_stream(&[&marked[..], &one].concat()));
        let profile = [&one[..2], b"\xFF\xE2\0\x08ICC_PR", &one[2..]].concat();
        assert!(is_stream(&[&profile[..], &one].concat()));
    }
}
