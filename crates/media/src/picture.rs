// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reader of image files: PNG, JPEG, BMP and PNM. The content decides the type, not the name.
//!
//! * Colour becomes luma by [`luma`], on 8-bit samples or, if the file has more bits, on 16-bit
//!   samples. Alpha and colour profiles are ignored, and so is the EXIF orientation unless it is wanted.
//! * Samples of fewer bits (1-, 2-, 4-bit PNG, PNM with another maximum than 255 or 65535) become
//!   the nearest value of the full range of 8 or 16 bits.
//! * These 8 or 16 bits become P bits by [`convert_depth`].
//! * Files that end early or are damaged are refused, even if a decoder would fill the missing part
//!   with grey. Each format has its own check for errors that its decoder ignores.

mod bmp;
mod conversion;
mod damage;
mod jpeg;
mod png;
mod pnm;
mod stream;

use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

use foveate_pixels::Frame;
use image::error::{ImageError, LimitErrorKind};
use image::{DynamicImage, ImageFormat, ImageReader, Limits};

pub(crate) use self::conversion::ImageConversion;
use self::damage::PictureFault;
pub(crate) use self::stream::StreamKind;
use crate::FootageError;
use crate::input::unread_image_type_by_content;
use crate::limits::{MAX_FILE_GIB, MAX_SIDE};
use foveate_pixels::{convert_depth, luma};

/// Reads an image file as a frame of `bits` bits per pixel.
///
/// # Errors
/// Fails if the file cannot be read, is too large, truncated or damaged, or is not a supported
/// image.
pub fn read(path: &Path, bits: u32) -> Result<Frame, FootageError> {
    decode(&bytes_of(path)?, path, bits)
}

/// Decodes the bytes of an image. Errors name `path`.
///
/// # Errors
/// Fails if the image is too large, truncated or damaged, or is not a supported image.
pub fn decode(bytes: &[u8], path: &Path, bits: u32) -> Result<Frame, FootageError> {
    decode_converted(bytes, path, bits, ImageConversion::default())
}

pub(crate) fn decode_converted(
    bytes: &[u8],
    path: &Path,
    bits: u32,
    conversion: ImageConversion,
) -> Result<Frame, FootageError> {
    let image = conversion.convert(decode_image(bytes, path)?, bytes, path)?;
    let (width, height) = (image.width(), image.height());
    let (samples, depth) = luma_samples(image);
    let pixels = samples.into_iter().map(|value| convert_depth(value, depth, bits)).collect();
    Frame::new(width, height, bits, pixels).map_err(|error| FootageError::Damaged {
        path: path.to_owned(),
        problem: error.to_string(),
    })
}

/// Reads an image file with the depth that it has.
pub(crate) fn read_image(path: &Path) -> Result<DynamicImage, FootageError> {
    decode_image(&bytes_of(path)?, path)
}

/// Decodes the bytes of an image, and checks what the decoder ignores.
fn decode_image(bytes: &[u8], path: &Path) -> Result<DynamicImage, FootageError> {
    let format =
        supported_format(bytes).ok_or_else(|| match unread_image_type_by_content(bytes) {
            Some(name) => FootageError::ImageType { path: path.to_owned(), name },
            None => FootageError::UnsupportedType { path: path.to_owned() },
        })?;
    let refused = |fault: PictureFault| match fault {
        PictureFault::Truncated(problem) => {
            FootageError::Truncated { path: path.to_owned(), problem }
        }
        PictureFault::Damaged(problem) => FootageError::Damaged { path: path.to_owned(), problem },
    };
    match format {
        ImageFormat::Png => png::check(bytes).map_err(refused)?,
        ImageFormat::Jpeg => jpeg::check(bytes).map_err(refused)?,
        _ => {}
    }
    if stream::stream_kind(bytes).is_some() || (format == ImageFormat::Png && has_animation(bytes))
    {
        return Err(FootageError::Animated { path: path.to_owned() });
    }
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_FILE_GIB << 30);
    let image = match format {
        ImageFormat::Png => png::decode(bytes, limits),
        ImageFormat::Jpeg => jpeg::decode(bytes, limits),
        _ => {
            let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
            reader.limits(limits);
            reader.decode()
        }
    };
    let image = image.map_err(|error| decoder_error(path, &error))?;
    // The decoder has read these headers within the limits.
    match format {
        ImageFormat::Pnm => pnm::check(bytes).map_err(refused)?,
        ImageFormat::Bmp => bmp::check(bytes).map_err(refused)?,
        _ => {}
    }
    Ok(image)
}

/// Returns the bytes of an image file, up to the limit of a file.
pub(crate) fn bytes_of(path: &Path) -> Result<Vec<u8>, FootageError> {
    let unreadable = |problem: String| FootageError::Unreadable { path: path.to_owned(), problem };
    let file = open_file(path).map_err(|error| unreadable(error.to_string()))?;
    let mut bytes = Vec::new();
    let limit = MAX_FILE_GIB << 30;
    let length = file.take(limit + 1).read_to_end(&mut bytes);
    match length.map(u64::try_from) {
        Ok(Ok(length)) if length <= limit => Ok(bytes),
        Ok(_) => Err(FootageError::TooLarge { path: path.to_owned() }),
        Err(error) => Err(unreadable(error.to_string())),
    }
}

/// Opens a regular file. A wait for another kind of file, such as a FIFO, might never end.
fn open_file(path: &Path) -> std::io::Result<File> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not a file"));
    }
    foveate_tools::open_file(path)
}

/// Returns true if a file starts as an image of a supported type does.
pub(crate) fn is_image(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = open_file(path).map(|file| file.take(16).read_to_end(&mut start));
    matches!(read, Ok(Ok(_))) && supported_format(&start).is_some()
}

/// Returns the width in the header of an image.
pub(crate) fn width(path: &Path) -> Option<u32> {
    let bytes = bytes_of(path).ok()?;
    match supported_format(&bytes)? {
        ImageFormat::Jpeg => jpeg::width(&bytes).ok(),
        format => {
            let reader = ImageReader::with_format(Cursor::new(&bytes[..]), format);
            reader.into_dimensions().ok().map(|(width, _)| width)
        }
    }
}

/// Returns true if the EXIF data of an image turn or mirror it.
pub(crate) fn is_turned(path: &Path) -> bool {
    // EXIF data come before the pixels.
    const HEAD: u64 = 1 << 20;
    let mut start = Vec::new();
    let read = open_file(path).map(|file| file.take(HEAD).read_to_end(&mut start));
    matches!(read, Ok(Ok(_))) && conversion::is_turned(&start, path)
}

/// A kind of image file with several frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ClipImage {
    /// An animated PNG.
    Animation,
    /// Images that follow each other.
    Stream(StreamKind),
}

/// Returns the kind of an image file with several frames.
pub(crate) fn clip_image(path: &Path) -> Option<ClipImage> {
    /// The number of bytes in which the first image of a stream and the header of the second lie.
    const HEAD: u64 = 1 << 28;
    let mut start = Vec::new();
    let read = open_file(path).map(|file| file.take(HEAD).read_to_end(&mut start));
    match (read, stream::stream_kind(&start)) {
        (Ok(Ok(_)), Some(kind)) => Some(ClipImage::Stream(kind)),
        (Ok(Ok(_)), None) => has_animation(&start).then_some(ClipImage::Animation),
        _ => None,
    }
}

/// Returns true if a PNG has a chunk `acTL` before its pixels.
fn has_animation(bytes: &[u8]) -> bool {
    const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
    /// The bytes of length, type and checksum.
    const FRAME: usize = 12;
    let Some(mut rest) = bytes.strip_prefix(SIGNATURE) else { return false };
    while let [a, b, c, d, kind @ ..] = rest {
        match kind.first_chunk() {
            Some(b"acTL") => return true,
            Some(b"IDAT") | None => return false,
            Some(_) => {}
        }
        let length = u32::from_be_bytes([*a, *b, *c, *d]);
        let next = usize::try_from(length).ok().and_then(|length| length.checked_add(FRAME));
        rest = next.and_then(|next| rest.get(next..)).unwrap_or_default();
    }
    false
}

fn supported_format(bytes: &[u8]) -> Option<ImageFormat> {
    let format = image::guess_format(bytes).ok()?;
    let known = [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Bmp, ImageFormat::Pnm];
    known.contains(&format).then_some(format)
}

fn decoder_error(path: &Path, error: &ImageError) -> FootageError {
    let path = path.to_owned();
    let problem = one_line(&error.to_string());
    match error {
        ImageError::Limits(limit) => match limit.kind() {
            LimitErrorKind::DimensionError | LimitErrorKind::InsufficientMemory => {
                FootageError::TooLarge { path }
            }
            _ => FootageError::Damaged { path, problem },
        },
        ImageError::IoError(io) if io.kind() == std::io::ErrorKind::UnexpectedEof => {
            FootageError::Truncated { path, problem: "pixels are missing at its end".to_owned() }
        }
        ImageError::Unsupported(_) => FootageError::UnsupportedFeature { path, problem },
        _ => FootageError::Damaged { path, problem },
    }
}

/// Returns a decoder's message without line breaks and other control characters, which a damaged
/// file may have put into it.
fn one_line(text: &str) -> String {
    let plain = text.replace(char::is_control, " ");
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns one luma sample per pixel, and the number of bits of a sample.
fn luma_samples(image: DynamicImage) -> (Vec<u16>, u32) {
    let wide = |value: &u8| u16::from(*value);
    match image {
        DynamicImage::ImageLuma8(grey) => (grey.as_raw().iter().map(wide).collect(), 8),
        DynamicImage::ImageLumaA8(grey) => (grey.pixels().map(|p| wide(&p.0[0])).collect(), 8),
        DynamicImage::ImageLuma16(grey) => (grey.into_raw(), 16),
        DynamicImage::ImageLumaA16(grey) => (grey.pixels().map(|p| p.0[0]).collect(), 16),
        DynamicImage::ImageRgb16(_) | DynamicImage::ImageRgba16(_) => {
            let colour = image.into_rgb16();
            (colour.pixels().map(|p| luma(p.0[0], p.0[1], p.0[2])).collect(), 16)
        }
        _ => {
            let colour = image.into_rgb8();
            let mix = |p: &image::Rgb<u8>| luma(p.0[0].into(), p.0[1].into(), p.0[2].into());
            (colour.pixels().map(mix).collect(), 8)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_animation_is_told_before_the_pixels() {
        let chunk = |kind: &[u8; 4], length: u8| {
            [&[0, 0, 0, length][..], kind, &vec![7; length.into()], &[0; 4]].concat()
        };
        let png = |chunks: &[Vec<u8>]| [&b"\x89PNG\r\n\x1a\n"[..], &chunks.concat()].concat();
        let (head, text, pixels) = (chunk(b"IHDR", 13), chunk(b"tEXt", 40), chunk(b"IDAT", 9));
        let animated = chunk(b"acTL", 8);
        assert!(has_animation(&png(&[head.clone(), text.clone(), animated.clone()])));
        for still in [
            png(&[head.clone(), text.clone(), pixels.clone(), animated.clone()]),
            png(&[head.clone(), chunk(b"tEXt", 200)[..100].to_vec()]),
            png(&[]),
            [b"GIF89a".to_vec(), animated].concat(),
        ] {
            assert!(!has_animation(&still));
        }
    }
}
