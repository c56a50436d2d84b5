// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pixels and the headers of a JPEG.

use image::error::{
    DecodingError, ImageError, ImageFormatHint, ImageResult, LimitError, LimitErrorKind,
    UnsupportedError, UnsupportedErrorKind,
};
use image::metadata::Orientation;
use image::{DynamicImage, ImageBuffer, ImageFormat, Limits};
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Decodes a JPEG as grey or, if it has colours, as red, green and blue.
///
/// # Errors
/// Fails if the picture is larger than the limits, of an unsupported kind, or damaged.
pub(in crate::picture) fn decode(bytes: &[u8], mut limits: Limits) -> ImageResult<DynamicImage> {
    let mut decoder = decoder(bytes)?;
    let [width, height] = dimensions(&decoder);
    limits.check_dimensions(width, height)?;
    let is_grey = decoder.input_colorspace() == Some(ColorSpace::Luma);
    let colours = if is_grey { ColorSpace::Luma } else { ColorSpace::RGB };
    let channels = u64::try_from(colours.num_components()).expect("there are at most three");
    limits.reserve(u64::from(width) * u64::from(height) * channels)?;
    decoder.set_options(decoder.options().jpeg_set_out_colorspace(colours));
    let samples = decoder.decode().map_err(error)?;
    let image = if is_grey {
        ImageBuffer::from_raw(width, height, samples).map(DynamicImage::ImageLuma8)
    } else {
        ImageBuffer::from_raw(width, height, samples).map(DynamicImage::ImageRgb8)
    };
    Ok(image.expect("the decoder returns every sample"))
}

/// Returns the EXIF orientation of a JPEG.
pub(in crate::picture) fn orientation(bytes: &[u8]) -> ImageResult<Orientation> {
    let decoder = decoder(bytes)?;
    let orientation = decoder.exif().and_then(|exif| Orientation::from_exif_chunk(exif));
    Ok(orientation.unwrap_or(Orientation::NoTransforms))
}

/// Returns the width in the headers of a JPEG.
pub(in crate::picture) fn width(bytes: &[u8]) -> ImageResult<u32> {
    decoder(bytes).map(|decoder| dimensions(&decoder)[0])
}

/// Returns a decoder that has read the headers.
fn decoder(bytes: &[u8]) -> ImageResult<JpegDecoder<ZCursor<&[u8]>>> {
    let options = DecoderOptions::default()
        .set_strict_mode(false)
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(error)?;
    Ok(decoder)
}

fn dimensions(decoder: &JpegDecoder<ZCursor<&[u8]>>) -> [u32; 2] {
    let (width, height) = decoder.dimensions().expect("the headers have been read");
    [width, height].map(|side| u32::try_from(side).expect("the format has 16 bits for a side"))
}

fn error(error: DecodeErrors) -> ImageError {
    let format = ImageFormatHint::Exact(ImageFormat::Jpeg);
    match error {
        DecodeErrors::Unsupported(what) => {
            let kind = UnsupportedErrorKind::GenericFeature(format!("{what:?}"));
            ImageError::Unsupported(UnsupportedError::from_format_and_kind(format, kind))
        }
        DecodeErrors::LargeDimensions(_) => {
            ImageError::Limits(LimitError::from_kind(LimitErrorKind::DimensionError))
        }
        other => ImageError::Decoding(DecodingError::new(format, other)),
    }
}
