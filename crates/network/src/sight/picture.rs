// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame as the input of a network, and where it has changed.

use super::framing::Lens;
use super::mapping::Mapping;
use crate::form::Form;
use crate::mask::Mask;
use foveate_frame::Plane;

/// Frames of one size and depth, in square regions that change as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frames {
    /// Pixels of a row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// The largest value of a pixel, at least 1.
    pub pixel_max: u32,
    /// Pixels of a region's side, at least 1. Those at the right and at the bottom may reach beyond the frame.
    pub region: u32,
}

/// The picture that the network sees, and the frame that it was made of.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Width of the frame, and side of a region.
    width: usize,
    side: usize,
    /// Regions of a row.
    columns: usize,
    frame: Vec<u16>,
    /// Regions in which it differs from the one before.
    fresh: Vec<bool>,
    inputs: Inputs,
    /// The input of the network.
    pub values: Vec<f32>,
    /// Where the input differs from the one before, as far as whole regions say.
    pub changed: Mask,
    /// How many regions that are.
    pub changed_regions: usize,
}

/// How pixels of the frame become values.
#[derive(Clone, Debug)]
enum Inputs {
    /// Each becomes one: what each grey is, channel by channel.
    Each(Vec<Vec<f32>>),
    /// Between pixels of another size.
    Between { lens: Box<Lens>, mapping: Mapping, channels: usize, max: f64 },
}

impl Picture {
    /// A black picture of such frames for the input of a network.
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
        // Beside a frame in a letterbox there is grey.
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

    /// Takes over a frame.
    ///
    /// # Panics
    /// If it has another size, or a pixel is larger than one of these frames can be.
    pub fn show(&mut self, frame: Plane<'_>) {
        match frame {
            Plane::Bytes(pixels) => self.update(pixels),
            Plane::Words(pixels) => self.update(pixels),
        }
        self.changed = Mask::empty(self.changed.height(), self.changed.width());
        self.project();
    }

    /// The frame that was shown last.
    #[must_use]
    pub fn frame(&self) -> &[u16] {
        &self.frame
    }

    /// The part of every row of a region.
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

    /// Brings what is fresh into the input.
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

    /// What is not marked as changed has the values from before, and all have those of a picture that never saw another frame.
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
