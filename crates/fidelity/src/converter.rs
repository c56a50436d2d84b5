// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames that are compared, in one pixel type, at the depth of the ideal.

use foveate_camera::Camera;
use foveate_frame::{FramePixels, convert_depth};
use foveate_ideal::IdealOutcome;

use crate::sample::PixelSample;

/// The memory for frames that need another type or depth.
#[derive(Clone, Debug)]
pub(crate) struct FrameConverter<T> {
    denoised: Vec<T>,
    rendered: Vec<T>,
    screen: Vec<T>,
    /// The pixel of the ideal for every pixel of the candidate; empty if both have the same depth.
    depth_table: Vec<T>,
}

/// The pixels of one frame, in row-major order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ComparedFrames<'p, T> {
    pub(crate) input: &'p [T],
    /// The denoised frame of the ideal.
    pub(crate) denoised: &'p [T],
    /// The ideal's screen.
    pub(crate) rendered: &'p [T],
    /// The candidate's screen.
    pub(crate) screen: &'p [T],
}

impl<T: PixelSample> FrameConverter<T> {
    pub(crate) fn new(ideal: &Camera, candidate: &Camera) -> Self {
        let (from, to) = (candidate.pixel_bits(), ideal.pixel_bits());
        let values = 0..=u16::try_from(candidate.pixel_max()).expect("a pixel has at most 16 bits");
        let depths = match from == to {
            true => Vec::new(),
            false => values.map(|value| T::from_word(convert_depth(value, from, to))).collect(),
        };
        Self { denoised: Vec::new(), rendered: Vec::new(), screen: Vec::new(), depth_table: depths }
    }

    /// Converts the frames of one step; returns `None` if a plane has the wrong type.
    pub(crate) fn convert<'p>(
        &'p mut self,
        input: FramePixels<'p>,
        ideal: &IdealOutcome,
        screen: FramePixels<'p>,
    ) -> Option<ComparedFrames<'p, T>> {
        let input = T::plane_pixels(input)?;
        convert_grey_levels(&ideal.denoised, &mut self.denoised);
        convert_grey_levels(&ideal.rendered, &mut self.rendered);
        let screen = if self.depth_table.is_empty() {
            T::plane_pixels(screen)?
        } else {
            match screen {
                FramePixels::Bytes(pixels) => {
                    convert_screen(pixels, &self.depth_table, &mut self.screen);
                }
                FramePixels::Words(pixels) => {
                    convert_screen(pixels, &self.depth_table, &mut self.screen);
                }
            }
            &self.screen
        };
        Some(ComparedFrames { input, denoised: &self.denoised, rendered: &self.rendered, screen })
    }
}

fn convert_grey_levels<T: PixelSample>(levels: &[f64], pixels: &mut Vec<T>) {
    pixels.resize(levels.len(), T::default());
    for (pixel, &level) in pixels.iter_mut().zip(levels) {
        *pixel = T::from_grey_level(level);
    }
}

fn convert_screen<T: PixelSample>(from: &[impl Copy + Into<usize>], depths: &[T], to: &mut Vec<T>) {
    let last = depths.len() - 1;
    to.clear();
    to.extend(from.iter().map(|&pixel| depths[pixel.into().min(last)]));
}
