// SPDX-License-Identifier: MIT OR Apache-2.0
//! The decoder of PNG and its check that a file is complete: every chunk has a correct checksum, and
//! there is an end chunk. The decoder ignores the checksums of chunks that it does not need.

use std::io::Cursor;

use image::error::{DecodingError, ImageError, ImageResult, LimitError, LimitErrorKind};
use image::{DynamicImage, ImageBuffer, ImageFormat, Limits, Pixel};
use png::{BitDepth, ColorType, DecodeOptions, Decoder, Transformations};

use super::conversion::ImageOutline;
use super::damage::PictureFault;

const SIGNATURE: usize = 8;

/// A chunk with its name and its data.
struct PngChunk<'a> {
    name: [u8; 4],
    data: &'a [u8],
}

/// Finds damage between the signature and the end chunk; bytes after it are ignored.
pub(super) fn check(bytes: &[u8]) -> Result<(), PictureFault> {
    let mut rest = bytes.get(SIGNATURE..).unwrap_or_default();
    while &next_chunk(&mut rest)?.name != b"IEND" {}
    Ok(())
}

/// Decodes a PNG, and checks the checksum of its compressed pixels. Palettes become colours, and
/// samples of fewer than 8 bits get 8 bits.
///
/// # Errors
/// Fails if the picture is larger than the limits, or damaged.
pub(super) fn decode(bytes: &[u8], mut limits: Limits) -> ImageResult<DynamicImage> {
    let mut options = DecodeOptions::default();
    options.set_ignore_checksums(false);
    let mut decoder = Decoder::new_with_options(Cursor::new(bytes), options);
    let most = limits.max_alloc.and_then(|most| most.try_into().ok());
    decoder.set_limits(png::Limits { bytes: most.unwrap_or(usize::MAX) });
    decoder.set_transformations(Transformations::EXPAND);
    let (width, height) = decoder.read_header_info().map_err(error)?.size();
    limits.check_dimensions(width, height)?;
    let mut reader = decoder.read_info().map_err(error)?;
    let length = reader.output_buffer_size().unwrap_or(usize::MAX);
    limits.reserve_usize(length)?;
    let mut bytes = vec![0; length];
    let (colours, depth) = reader.output_color_type();
    reader.next_frame(&mut bytes).map_err(error)?;
    let size = (width, height);
    Ok(if depth == BitDepth::Sixteen {
        let words = bytes.chunks_exact(2).map(|word| u16::from_be_bytes([word[0], word[1]]));
        let words = words.collect();
        match colours {
            ColorType::Grayscale => image(size, words, DynamicImage::ImageLuma16),
            ColorType::GrayscaleAlpha => image(size, words, DynamicImage::ImageLumaA16),
            ColorType::Rgba => image(size, words, DynamicImage::ImageRgba16),
            ColorType::Rgb | ColorType::Indexed => image(size, words, DynamicImage::ImageRgb16),
        }
    } else {
        match colours {
            ColorType::Grayscale => image(size, bytes, DynamicImage::ImageLuma8),
            ColorType::GrayscaleAlpha => image(size, bytes, DynamicImage::ImageLumaA8),
            ColorType::Rgba => image(size, bytes, DynamicImage::ImageRgba8),
            ColorType::Rgb | ColorType::Indexed => image(size, bytes, DynamicImage::ImageRgb8),
        }
    })
}

/// Makes an image of the samples of its pixels.
fn image<P: Pixel>(
    (width, height): (u32, u32),
    samples: Vec<P::Subpixel>,
    kind: fn(ImageBuffer<P, Vec<P::Subpixel>>) -> DynamicImage,
) -> DynamicImage {
    let pixels = ImageBuffer::from_raw(width, height, samples);
    kind(pixels.expect("the decoder returns every sample"))
}

fn error(error: png::DecodingError) -> ImageError {
    match error {
        png::DecodingError::IoError(error) => ImageError::IoError(error),
        png::DecodingError::LimitsExceeded => {
            ImageError::Limits(LimitError::from_kind(LimitErrorKind::InsufficientMemory))
        }
        other => ImageError::Decoding(DecodingError::new(ImageFormat::Png.into(), other)),
    }
}

/// Returns the outline of a PNG. Returns `None` if its first chunk is no header.
pub(super) fn outline(bytes: &[u8]) -> Option<ImageOutline<'_>> {
    let mut rest = bytes.get(SIGNATURE..)?;
    let header = next_chunk(&mut rest).ok().filter(|chunk| &chunk.name == b"IHDR")?.data;
    while let Ok(chunk) = next_chunk(&mut rest) {
        if &chunk.name == b"IEND" {
            return Some(ImageOutline { header, after: Some(rest) });
        }
    }
    Some(ImageOutline { header, after: None })
}

/// Takes the next chunk from the front: length, name, data, checksum.
fn next_chunk<'a>(rest: &mut &'a [u8]) -> Result<PngChunk<'a>, PictureFault> {
    let short = || PictureFault::truncated("it has no end chunk (IEND)");
    let (length, body) = rest.split_first_chunk().ok_or_else(short)?;
    let length = u32::from_be_bytes(*length) as usize;
    let (name, data) = body.split_first_chunk().ok_or_else(short)?;
    let (data, after) = data.split_at_checked(length).ok_or_else(short)?;
    let (sum, after) = after.split_first_chunk().ok_or_else(short)?;
    if crc32fast::hash(&body[..4 + length]) != u32::from_be_bytes(*sum) {
        let name = name.escape_ascii();
        return Err(PictureFault::damaged(format!("the checksum of its chunk {name} is wrong")));
    }
    *rest = after;
    Ok(PngChunk { name: *name, data })
}
