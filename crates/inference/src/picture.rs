// SPDX-License-Identifier: MIT OR Apache-2.0
//! A rendered frame as the input of a network, and where it has changed.

use crate::InferenceError;
use foveate_design::Design;
use foveate_frame::Plane;
use foveate_network::{Form, Mask};
use serde::Serialize;

/// How pixels become inputs: `(pixel / largest pixel - mean) / scale`, in every channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mapping {
    /// One value, or one per channel.
    pub mean: Vec<f32>,
    /// One value, or one per channel.
    pub scale: Vec<f32>,
}

impl Mapping {
    /// Refuses a mapping for other channels.
    pub(crate) fn check(&self, channels: usize) -> Result<(), InferenceError> {
        for (what, values) in [("--mean", &self.mean), ("--scale", &self.scale)] {
            if values.len() != 1 && values.len() != channels {
                return Err(InferenceError::Channels { what, found: values.len(), channels });
            }
        }
        Ok(())
    }
}

/// The picture that the network sees, and the frame that it was made of.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    side: usize,
    /// What each pixel becomes, channel by channel.
    tables: Vec<Vec<f32>>,
    frame: Vec<u16>,
    pub(crate) values: Vec<f32>,
    /// Where it differs from the one before, in whole regions.
    pub(crate) changed: Mask,
    /// How many regions that are.
    pub(crate) changed_regions: usize,
}

impl Picture {
    /// A black picture for a camera and the input of a network, of the same size.
    pub(crate) fn new(design: &Design, input: &Form, mapping: &Mapping) -> Self {
        let (channels, max) = (input.shape()[1], design.pixel_max());
        let of =
            |values: &[f32], channel: usize| values[if values.len() == 1 { 0 } else { channel }];
        let table = |channel: usize| {
            let (mean, scale) =
                (f64::from(of(&mapping.mean, channel)), f64::from(of(&mapping.scale, channel)));
            #[allow(clippy::cast_possible_truncation, reason = "inputs are 32 bits wide")]
            let value = |pixel: u32| ((f64::from(pixel) / f64::from(max) - mean) / scale) as f32;
            (0..=max).map(value).collect::<Vec<f32>>()
        };
        let tables: Vec<_> = (0..channels).map(table).collect();
        let places = input.places();
        Self {
            side: design.region_size() as usize,
            values: tables.iter().flat_map(|table| vec![table[0]; places]).collect(),
            tables,
            frame: vec![0; places],
            changed: Mask::empty(input.height(), input.width()),
            changed_regions: 0,
        }
    }

    /// Takes over what is on the screen.
    pub(crate) fn show(&mut self, screen: Plane<'_>) {
        match screen {
            Plane::Bytes(pixels) => self.update(pixels),
            Plane::Words(pixels) => self.update(pixels),
        }
    }

    fn update<T: Copy + Into<u16>>(&mut self, pixels: &[T]) {
        let (height, width, side) = (self.changed.height(), self.changed.width(), self.side);
        self.changed = Mask::empty(height, width);
        self.changed_regions = 0;
        let places = height * width;
        for top in (0..height).step_by(side) {
            for left in (0..width).step_by(side) {
                let rows = || {
                    (top..height.min(top + side))
                        .map(|y| y * width + left..y * width + width.min(left + side))
                };
                let differs = rows().any(|row| {
                    pixels[row.clone()]
                        .iter()
                        .zip(&self.frame[row])
                        .any(|(&new, &old)| new.into() != old)
                });
                if !differs {
                    continue;
                }
                self.changed_regions += 1;
                for row in rows() {
                    for at in row {
                        let pixel: u16 = pixels[at].into();
                        self.frame[at] = pixel;
                        self.changed.insert(at % width, at / width);
                        for (channel, table) in self.tables.iter().enumerate() {
                            self.values[channel * places + at] = table[usize::from(pixel)];
                        }
                    }
                }
            }
        }
    }
}
