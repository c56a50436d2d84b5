// SPDX-License-Identifier: MIT OR Apache-2.0
//! The conversion of a decoded image: luma of a mosaic, then the orientation. The outline of an
//! image in a file that may hold several.

use super::{decoder_error, jpeg, luma_samples, supported_format};
use crate::bayer::{BayerPattern, MIN_MOSAIC_SIDE, luma_of_mosaic};
use crate::{FootageError, InputOptions, Orientation};
use image::{DynamicImage, ImageBuffer, ImageDecoder as _, ImageFormat, ImageReader};
use std::io::Cursor;
use std::path::Path;

/// The conversion of images that the options of an input ask for.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ImageConversion {
    bayer: Option<BayerPattern>,
    orientation: Orientation,
}

impl ImageConversion {
    /// Returns the conversion that the options ask for.
    pub(crate) fn from_options(options: &InputOptions) -> Self {
        Self { bayer: options.bayer, orientation: options.orientation }
    }

    /// Converts an image that was decoded from `bytes`.
    pub(super) fn convert(
        self,
        image: DynamicImage,
        bytes: &[u8],
        path: &Path,
    ) -> Result<DynamicImage, FootageError> {
        // A mosaic has its pattern in the rows and columns as they are stored.
        let mut image = match self.bayer {
            None => image,
            Some(pattern) => grey_of_mosaic(image, pattern, path)?,
        };
        match self.orientation {
            Orientation::Stored => {}
            Orientation::Upright => image.apply_orientation(orientation_of(bytes, path)?),
        }
        Ok(image)
    }
}

/// Returns the EXIF orientation of an image.
fn orientation_of(bytes: &[u8], path: &Path) -> Result<image::metadata::Orientation, FootageError> {
    let Some(format) = supported_format(bytes) else {
        return Ok(image::metadata::Orientation::NoTransforms);
    };
    let orientation = if format == ImageFormat::Jpeg {
        jpeg::orientation(bytes)
    } else {
        let decoder = ImageReader::with_format(Cursor::new(bytes), format).into_decoder();
        decoder.and_then(|mut decoder| decoder.orientation())
    };
    orientation.map_err(|error| decoder_error(path, &error))
}

/// Returns true if the EXIF data of an image, of which only the beginning may be there, turn or
/// mirror it.
pub(super) fn is_turned(bytes: &[u8], path: &Path) -> bool {
    let stored = image::metadata::Orientation::NoTransforms;
    orientation_of(bytes, path).is_ok_and(|orientation| orientation != stored)
}

/// Returns the luma of a mosaic as a grey image of the same depth.
fn grey_of_mosaic(
    image: DynamicImage,
    pattern: BayerPattern,
    path: &Path,
) -> Result<DynamicImage, FootageError> {
    let (width, height) = (image.width(), image.height());
    let refused = |problem: &str| FootageError::Option {
        option: "--bayer",
        problem: format!("`{}` {problem}", path.display()),
    };
    if image.color().has_color() {
        return Err(refused("has colours, but a mosaic is a grey image; leave the option out"));
    }
    if (width.min(height) as usize) < MIN_MOSAIC_SIDE {
        return Err(refused("is smaller than 2x2 pixels, so it has no pattern"));
    }
    let (samples, depth) = luma_samples(image);
    let luma = luma_of_mosaic(&samples, width as usize, pattern);
    let grey = if depth == 8 {
        let bytes = luma.iter().map(|&value| u8::try_from(value).expect("it has 8 bits"));
        ImageBuffer::from_raw(width, height, bytes.collect()).map(DynamicImage::ImageLuma8)
    } else {
        ImageBuffer::from_raw(width, height, luma).map(DynamicImage::ImageLuma16)
    };
    Ok(grey.expect("a mosaic has as much luma as samples"))
}

/// The header of an image, and the bytes behind its end, if its end was found.
pub(super) struct ImageOutline<'a> {
    pub(super) header: &'a [u8],
    pub(super) after: Option<&'a [u8]>,
}
