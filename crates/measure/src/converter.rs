// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames that are compared, in one pixel type, at the depth of the ideal.

use foveate_camera::Camera;
use foveate_ideal::IdealOutcome;
use foveate_pixels::{FramePixels, convert_depth};

use crate::sample::PixelSample;

/// The memory for frames that need another type or depth.
#[derive(Clone, Debug)]
pub(crate) struct FrameConverter<T> {
    denoised: Vec<T>,
    rendered: Vec<T>,
    screen: Vec<T>,
    own_denoised: Vec<T>,
    /// The pixel of the ideal for every pixel of the candidate.
    depth_table: Vec<T>,
    has_same_depth: bool,
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
    /// The denoised frame of the candidate.
    pub(crate) own_denoised: &'p [T],
}

impl<T: PixelSample> FrameConverter<T> {
    pub(crate) fn new(ideal: &Camera, candidate: &Camera) -> Self {
        let (from, to) = (candidate.pixel_bits(), ideal.pixel_bits());
        let values = 0..=u16::try_from(candidate.pixel_max()).expect("a pixel has at most 16 bits");
        let depth_table = values.map(|value| T::from_word(convert_depth(value, from, to)));
        Self {
            denoised: Vec::new(),
            rendered: Vec::new(),
            screen: Vec::new(),
            own_denoised: Vec::new(),
            depth_table: depth_table.collect(),
            has_same_depth: from == to,
        }
    }

    /// Converts the frames of one step; returns `None` if a plane has the wrong type.
    pub(crate) fn convert<'p>(
        &'p mut self,
        input: FramePixels<'p>,
        ideal: &IdealOutcome,
        (screen, own_denoised): (FramePixels<'p>, &[u16]),
    ) -> Option<ComparedFrames<'p, T>> {
        let input = T::plane_pixels(input)?;
        convert_grey_levels(&ideal.denoised, &mut self.denoised);
        convert_grey_levels(&ideal.rendered, &mut self.rendered);
        convert_screen(own_denoised, &self.depth_table, &mut self.own_denoised);
        let screen = if self.has_same_depth {
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
        let Self { denoised, rendered, own_denoised, .. } = self;
        Some(ComparedFrames { input, denoised, rendered, screen, own_denoised })
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
