// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame as the input of a network, with the positions that have changed ([`FrameInput`]). A
//! [`PixelMapping`] converts pixels to the values that a network takes.

use super::error::VisionError;
use super::framing::FrameScaling;
use crate::mask::Mask;
use crate::tensor::TensorForm;
use foveate_pixels::FramePixels;
use serde::Serialize;

/// The format of frames: one size and depth, and square regions that change as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameFormat {
    /// The pixels of a row, at least 1.
    pub width: u32,
    /// The number of rows, at least 1.
    pub height: u32,
    /// The largest value of a pixel, at least 1.
    pub pixel_max: u32,
    /// The side of a region in pixels, at least 1. The regions at the right and at the bottom may
    /// reach beyond the frame.
    pub region_side: u32,
}

/// The input of the network, and the frame from which it was made.
#[derive(Clone, Debug)]
pub struct FrameInput {
    /// The width of the frame, in pixels.
    width: usize,
    /// The side of a region, in pixels.
    side: usize,
    /// The number of regions of a row.
    columns: usize,
    frame: Vec<u16>,
    /// The regions in which the frame differs from the previous one.
    changed_by_region: Vec<bool>,
    inputs: PixelConversion,
    /// The values of the network's input, in row-major order.
    pub values: Vec<f32>,
    /// The positions at which the input may differ from the previous one, because they depend on a
    /// changed region.
    pub changed: Mask,
    /// The number of changed regions.
    pub changed_regions: usize,
}

#[derive(Clone, Debug)]
enum PixelConversion {
    /// Every pixel of the frame is one pixel of the input. The tables hold the input value of every
    /// pixel value, one table per channel.
    Lookup(Vec<Vec<f32>>),
    /// A pixel of the input is interpolated between pixels of the frame.
    Interpolated { scaling: Box<FrameScaling>, mapping: PixelMapping, channels: usize, max: f64 },
}

impl FrameInput {
    /// Returns the input for a black frame of this format.
    pub(super) fn new(
        frames: FrameFormat,
        input: &TensorForm,
        mapping: &PixelMapping,
        scaling: Option<&FrameScaling>,
    ) -> Self {
        let (channels, max) = (input.shape()[1], f64::from(frames.pixel_max));
        let positions = input.position_count();
        let inputs = match scaling {
            None => {
                let table = |channel| {
                    let value = |pixel: u32| mapping.input_value(channel, f64::from(pixel) / max);
                    (0..=frames.pixel_max).map(value).collect()
                };
                PixelConversion::Lookup((0..channels).map(table).collect())
            }
            Some(scaling) => PixelConversion::Interpolated {
                scaling: Box::new(scaling.clone()),
                mapping: mapping.clone(),
                channels,
                max,
            },
        };
        // A letterbox is grey around the frame.
        let outside = scaling.map_or(0.0, |_| f64::from(FrameScaling::padding()));
        let (width, height) = (frames.width as usize, frames.height as usize);
        let regions_along = |side: u32| side.div_ceil(frames.region_side) as usize;
        let mut picture = Self {
            width,
            side: frames.region_side as usize,
            columns: regions_along(frames.width),
            frame: vec![0; width * height],
            changed_by_region: vec![
                true;
                regions_along(frames.width) * regions_along(frames.height)
            ],
            values: (0..channels)
                .flat_map(|channel| vec![mapping.input_value(channel, outside); positions])
                .collect(),
            inputs,
            changed: Mask::empty(input.height(), input.width()),
            changed_regions: 0,
        };
        picture.update_input();
        picture.changed = Mask::empty(input.height(), input.width());
        picture
    }

    /// Stores the next frame, and updates the input and its changed positions.
    ///
    /// # Panics
    /// Panics if the frame does not have the size of the format. Without scaling it also panics if
    /// a pixel is larger than the largest value of the format.
    pub fn set_frame(&mut self, frame: FramePixels<'_>) {
        match frame {
            FramePixels::Bytes(pixels) => self.update(pixels),
            FramePixels::Words(pixels) => self.update(pixels),
        }
        self.changed = Mask::empty(self.changed.height(), self.changed.width());
        self.update_input();
    }

    /// The last frame.
    #[must_use]
    pub fn frame(&self) -> &[u16] {
        &self.frame
    }

    /// Returns the pixels of each row of a region, as ranges of the frame.
    fn region_rows(&self, region: usize) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
        let (width, side) = (self.width, self.side);
        let (left, top) = (region % self.columns * side, region / self.columns * side);
        let (right, bottom) = (width.min(left + side), (self.frame.len() / width).min(top + side));
        (top..bottom).map(move |y| y * width + left..y * width + right)
    }

    fn update<T: Copy + Into<u16>>(&mut self, pixels: &[T]) {
        assert_eq!(pixels.len(), self.frame.len(), "the frame has another size than the format");
        self.changed_regions = 0;
        for region in 0..self.changed_by_region.len() {
            let differs = |row: std::ops::Range<usize>| {
                // All pixels of a row are compared, with vector instructions.
                let pairs = pixels[row.clone()].iter().zip(&self.frame[row]);
                pairs.fold(false, |differs, (&new, &old)| differs | (new.into() != old))
            };
            self.changed_by_region[region] = self.region_rows(region).any(differs);
            if self.changed_by_region[region] {
                self.changed_regions += 1;
                for row in self.region_rows(region) {
                    let pairs = self.frame[row.clone()].iter_mut().zip(&pixels[row]);
                    pairs.for_each(|(old, &new)| *old = new.into());
                }
            }
        }
    }

    /// Updates the input at the positions that depend on changed regions.
    fn update_input(&mut self) {
        match &self.inputs {
            PixelConversion::Lookup(tables) => {
                let places = self.frame.len();
                for region in (0..self.changed_by_region.len())
                    .filter(|&region| self.changed_by_region[region])
                {
                    for at in self.region_rows(region).flatten() {
                        self.changed.insert(at % self.width, at / self.width);
                        for (channel, table) in tables.iter().enumerate() {
                            self.values[channel * places + at] = table[usize::from(self.frame[at])];
                        }
                    }
                }
            }
            PixelConversion::Interpolated { scaling, mapping, channels, max } => {
                let places = self.values.len() / channels;
                let is_fresh = |column, row| self.changed_by_region[row * self.columns + column];
                scaling.for_each_pixel_of_regions(
                    &self.frame,
                    self.side,
                    is_fresh,
                    |(x, y), at, grey| {
                        self.changed.insert(x, y);
                        for channel in 0..*channels {
                            let value = mapping.input_value(channel, f64::from(grey) / max);
                            self.values[channel * places + at] = value;
                        }
                    },
                );
            }
        }
    }
}

/// The conversion of pixels to inputs of a network: `(pixel / largest pixel - mean) / scale`, in
/// every channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelMapping {
    /// The mean: one value, or one per channel.
    pub mean: Vec<f32>,
    /// The scale: one value, or one per channel.
    pub scale: Vec<f32>,
}

impl PixelMapping {
    /// Fails if the mapping is for another number of channels.
    pub(super) fn check(&self, channels: usize) -> Result<(), VisionError> {
        for (what, values) in [("--mean", &self.mean), ("--scale", &self.scale)] {
            if values.len() != 1 && values.len() != channels {
                return Err(VisionError::ChannelCount { what, found: values.len(), channels });
            }
        }
        Ok(())
    }

    /// Returns the input value in a channel for a pixel given as a share of white.
    pub(super) fn input_value(&self, channel: usize, share: f64) -> f32 {
        let channel_value =
            |values: &[f32]| f64::from(values[if values.len() == 1 { 0 } else { channel }]);
        #[allow(clippy::cast_possible_truncation, reason = "inputs are 32 bits wide")]
        let value = ((share - channel_value(&self.mean)) / channel_value(&self.scale)) as f32;
        value
    }
}

/// Parses a value of a mean as users write it: a number, or a quotient of two numbers.
///
/// # Errors
/// Fails if the text is no number or quotient, or if the value is not finite; the message tells
/// what is expected.
pub fn parse_mean(text: &str) -> Result<f32, String> {
    parse_quotient(text)
        .ok_or_else(|| "expected a number, or a quotient such as 127/255".to_owned())
}

/// Parses a value of a scale as users write it: a number above 0, or a quotient of two numbers.
///
/// # Errors
/// Fails if the text is no number or quotient, or if the value is not finite or not above 0; the
/// message tells what is expected.
pub fn parse_scale(text: &str) -> Result<f32, String> {
    parse_quotient(text)
        .filter(|&value| value > 0.0)
        .ok_or_else(|| "expected a number above 0, or a quotient such as 1/255".to_owned())
}

/// Parses a number, or a quotient of two numbers, and returns it if it is finite.
fn parse_quotient(text: &str) -> Option<f32> {
    let number = |text: &str| text.parse().ok().filter(|value: &f32| value.is_finite());
    let value = match text.split_once('/') {
        None => number(text)?,
        Some((over, under)) => number(over)? / number(under)?,
    };
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::Framing;

    /// Positions that are not marked as changed must keep their values, and the input must be the
    /// one that a new instance makes of the frame.
    #[test]
    fn inputs_follow_the_frame_and_the_mask_covers_all_changes() {
        let mut random = fastrand::Rng::with_seed(7);
        let mapping = PixelMapping { mean: vec![0.5, 0.0, 0.25], scale: vec![0.25] };
        for framing in
            [Framing::Same, Framing::Letterbox(Some((9, 20))), Framing::Stretch(Some((33, 7)))]
        {
            let frames = FrameFormat { width: 27, height: 18, pixel_max: 255, region_side: 8 };
            let (width, height) = framing.input_size((27, 18)).unwrap();
            let input = TensorForm::features(vec![1, 3, height as usize, width as usize]);
            let scaling = framing.scaling((27, 18), (width, height));
            let new = || FrameInput::new(frames, &input, &mapping, scaling.as_ref());
            let (mut picture, mut pixels) = (new(), vec![0_u8; 27 * 18]);
            for _ in 0..20 {
                for _ in 0..random.usize(0..4) {
                    let at = random.usize(0..pixels.len());
                    pixels[at] = random.u8(..);
                }
                let before = picture.values.clone();
                picture.set_frame(FramePixels::Bytes(&pixels));
                let mut other = new();
                other.set_frame(FramePixels::Bytes(&pixels));
                assert_eq!(picture.values, other.values);
                let positions = input.position_count();
                for (at, (old, new)) in before.iter().zip(&picture.values).enumerate() {
                    let (x, y) = (at % positions % width as usize, at % positions / width as usize);
                    assert!(old == new || picture.changed.contains(x, y), "{framing}: {x}, {y}");
                }
            }
        }
    }

    #[test]
    fn values_are_numbers_or_quotients() {
        assert_eq!((parse_mean("-0.5"), parse_mean("127/255")), (Ok(-0.5), Ok(127.0 / 255.0)));
        assert_eq!((parse_scale("2"), parse_scale("1/255")), (Ok(2.0), Ok(1.0 / 255.0)));
        for wrong in ["", "x", "inf", "nan", "1/0", "1/", "1/2/3"] {
            assert!(parse_mean(wrong).unwrap_err().contains("127/255"), "{wrong}");
            assert!(parse_scale(wrong).unwrap_err().contains("1/255"), "{wrong}");
        }
        for wrong in ["0", "-1", "-1/255"] {
            assert!(parse_scale(wrong).is_err() && parse_mean(wrong).is_ok(), "{wrong}");
        }
    }
}
