// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame as the input of a network, with the positions that have changed.

use super::framing::Lens;
use super::mapping::Mapping;
use crate::form::Form;
use crate::mask::Mask;
use foveate_frame::Plane;

/// The format of frames: one size and depth, and square regions that change as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frames {
    /// The pixels of a row, at least 1.
    pub width: u32,
    /// The number of rows, at least 1.
    pub height: u32,
    /// The largest value of a pixel, at least 1.
    pub pixel_max: u32,
    /// The side of a region in pixels, at least 1. The regions at the right and at the bottom may
    /// reach beyond the frame.
    pub region: u32,
}

/// The input of the network, and the frame from which it was made.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The width of the frame, in pixels.
    width: usize,
    /// The side of a region, in pixels.
    side: usize,
    /// The number of regions of a row.
    columns: usize,
    frame: Vec<u16>,
    /// The regions in which the frame differs from the previous one.
    fresh: Vec<bool>,
    inputs: Inputs,
    /// The values of the network's input, in row-major order.
    pub values: Vec<f32>,
    /// The positions at which the input may differ from the previous one, because they depend on a
    /// changed region.
    pub changed: Mask,
    /// The number of changed regions.
    pub changed_regions: usize,
}

/// The conversion of pixels of the frame to input values.
#[derive(Clone, Debug)]
enum Inputs {
    /// Every pixel of the frame is one pixel of the input. The tables hold the input value of every
    /// pixel value, one table per channel.
    Each(Vec<Vec<f32>>),
    /// A pixel of the input is interpolated between pixels of the frame.
    Between { lens: Box<Lens>, mapping: Mapping, channels: usize, max: f64 },
}

impl Picture {
    /// Returns the input for a black frame of this format.
    pub(super) fn new(
        frames: Frames,
        input: &Form,
        mapping: &Mapping,
        lens: Option<&Lens>,
    ) -> Self {
        let (channels, max) = (input.shape()[1], f64::from(frames.pixel_max));
        let places = input.places();
        let inputs = match lens {
            None => {
                let table = |channel| {
                    let value = |pixel: u32| mapping.value(channel, f64::from(pixel) / max);
                    (0..=frames.pixel_max).map(value).collect()
                };
                Inputs::Each((0..channels).map(table).collect())
            }
            Some(lens) => Inputs::Between {
                lens: Box::new(lens.clone()),
                mapping: mapping.clone(),
                channels,
                max,
            },
        };
        // A letterbox is grey around the frame.
        let outside = lens.map_or(0.0, |_| f64::from(Lens::padding()));
        let (width, height) = (frames.width as usize, frames.height as usize);
        let across = |side: u32| side.div_ceil(frames.region) as usize;
        let mut picture = Self {
            width,
            side: frames.region as usize,
            columns: across(frames.width),
            frame: vec![0; width * height],
            fresh: vec![true; across(frames.width) * across(frames.height)],
            values: (0..channels)
                .flat_map(|channel| vec![mapping.value(channel, outside); places])
                .collect(),
            inputs,
            changed: Mask::empty(input.height(), input.width()),
            changed_regions: 0,
        };
        picture.project();
        picture.changed = Mask::empty(input.height(), input.width());
        picture
    }

    /// Stores the next frame, and updates the input and its changed positions.
    ///
    /// # Panics
    /// Panics if the frame is smaller than the format says. Without scaling it also panics if a
    /// pixel is larger than the largest value of the format.
    pub fn show(&mut self, frame: Plane<'_>) {
        match frame {
            Plane::Bytes(pixels) => self.update(pixels),
            Plane::Words(pixels) => self.update(pixels),
        }
        self.changed = Mask::empty(self.changed.height(), self.changed.width());
        self.project();
    }

    /// The last frame.
    #[must_use]
    pub fn frame(&self) -> &[u16] {
        &self.frame
    }

    /// Returns the pixels of each row of a region, as ranges of the frame.
    fn rows(&self, region: usize) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
        let (width, side) = (self.width, self.side);
        let (left, top) = (region % self.columns * side, region / self.columns * side);
        let (right, bottom) = (width.min(left + side), (self.frame.len() / width).min(top + side));
        (top..bottom).map(move |y| y * width + left..y * width + right)
    }

    fn update<T: Copy + Into<u16>>(&mut self, pixels: &[T]) {
        self.changed_regions = 0;
        for region in 0..self.fresh.len() {
            let differs = |row: std::ops::Range<usize>| {
                let mut pairs = pixels[row.clone()].iter().zip(&self.frame[row]);
                pairs.any(|(&new, &old)| new.into() != old)
            };
            self.fresh[region] = self.rows(region).any(differs);
            if self.fresh[region] {
                self.changed_regions += 1;
                for row in self.rows(region) {
                    let pairs = self.frame[row.clone()].iter_mut().zip(&pixels[row]);
                    pairs.for_each(|(old, &new)| *old = new.into());
                }
            }
        }
    }

    /// Updates the input at the positions that depend on changed regions.
    fn project(&mut self) {
        match &self.inputs {
            Inputs::Each(tables) => {
                let places = self.frame.len();
                for region in (0..self.fresh.len()).filter(|&region| self.fresh[region]) {
                    for at in self.rows(region).flatten() {
                        self.changed.insert(at % self.width, at / self.width);
                        for (channel, table) in tables.iter().enumerate() {
                            self.values[channel * places + at] = table[usize::from(self.frame[at])];
                        }
                    }
                }
            }
            Inputs::Between { lens, mapping, channels, max } => {
                let places = self.values.len() / channels;
                let is_fresh = |column, row| self.fresh[row * self.columns + column];
                lens.project(&self.frame, self.side, is_fresh, |(x, y), at, grey| {
                    self.changed.insert(x, y);
                    for channel in 0..*channels {
                        let value = mapping.value(channel, f64::from(grey) / max);
                        self.values[channel * places + at] = value;
                    }
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sight::Framing;

    /// Positions that are not marked as changed must keep their values, and the input must be the
    /// one that a new instance makes of the frame.
    #[test]
    fn inputs_follow_the_frame_and_marks_cover_what_changes() {
        let mut chance = fastrand::Rng::with_seed(7);
        let mapping = Mapping { mean: vec![0.5, 0.0, 0.25], scale: vec![0.25] };
        for framing in
            [Framing::Same, Framing::Letterbox(Some((9, 20))), Framing::Stretch(Some((33, 7)))]
        {
            let frames = Frames { width: 27, height: 18, pixel_max: 255, region: 8 };
            let (width, height) = framing.size((27, 18)).unwrap();
            let input = Form::features(vec![1, 3, height as usize, width as usize]);
            let lens = framing.lens((27, 18), (width, height));
            let new = || Picture::new(frames, &input, &mapping, lens.as_ref());
            let (mut picture, mut pixels) = (new(), vec![0_u8; 27 * 18]);
            for _ in 0..20 {
                for _ in 0..chance.usize(0..4) {
                    let at = chance.usize(0..pixels.len());
                    pixels[at] = chance.u8(..);
                }
                let before = picture.values.clone();
                picture.show(Plane::Bytes(&pixels));
                let mut other = new();
                other.show(Plane::Bytes(&pixels));
                assert_eq!(picture.values, other.values);
                let places = input.places();
                for (at, (old, new)) in before.iter().zip(&picture.values).enumerate() {
                    let (x, y) = (at % places % width as usize, at % places / width as usize);
                    assert!(old == new || picture.changed.contains(x, y), "{framing}: {x}, {y}");
                }
            }
        }
    }
}
