// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whole frames of patterns, with one drawing state for every region.

use super::frame_feed::FrameFeed;
use super::random::Random;
use super::stimulus_pattern::{PatternGenerator, StimulusPattern};
use crate::error::CosimError;
use foveate_pixels::Frame;

/// The choice of the data of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PatternAim {
    /// Patterns are drawn as they are.
    Free,
    /// About half of the regions are drawn near a minimum of the design.
    NearMinimum,
    /// Noise is drawn that is relevant with the thresholds of the design.
    RelevantNoise,
}

/// The drawing states of all squares of a frame.
pub(crate) struct FrameGenerator {
    /// The drawing state of each square.
    generators: Vec<PatternGenerator>,
    /// The side of a square, in pixels.
    side: u32,
    /// The columns and rows of the frame, which cuts off the last squares.
    size: (u32, u32),
    /// The number of bits of a pixel.
    bits: u32,
}

impl FrameGenerator {
    pub(crate) fn new(feed: &FrameFeed<'_>, random: &mut Random) -> Self {
        let (design, side, size) = (feed.design(), feed.square_side(), feed.size());
        let squares = size.0.div_ceil(side) * size.1.div_ceil(side);
        let generators =
            (0..squares).map(|_| PatternGenerator::new(design, side, random.fork())).collect();
        Self { generators, side, size, bits: design.pixel_bits() }
    }

    /// Draws the next frame. With `mixed` every region starts at another pattern. Returns true if
    /// noise was drawn that is relevant unless neighbors change its scores.
    pub(crate) fn draw(
        &mut self,
        patterns: &[StimulusPattern],
        turn: usize,
        mixed: bool,
        aim: PatternAim,
        random: &mut Random,
    ) -> bool {
        let mut has_relevant_noise = false;
        for (region, generator) in self.generators.iter_mut().enumerate() {
            let shift = if mixed { region } else { 0 };
            let pattern = patterns[(turn + shift) % patterns.len()];
            match (aim, pattern) {
                (PatternAim::RelevantNoise, StimulusPattern::Noise) => {
                    has_relevant_noise |= generator.draw_relevant_noise();
                }
                // `MeanStep` already aims at a threshold.
                (PatternAim::NearMinimum, pattern)
                    if pattern != StimulusPattern::MeanStep && random.one_in(2) =>
                {
                    generator.draw_near_minimum(pattern);
                }
                _ => generator.draw(pattern),
            }
        }
        has_relevant_noise
    }

    /// Draws the regions again for which `is_drawn` is true; they are numbered row by row.
    pub(crate) fn draw_where(
        &mut self,
        pattern: StimulusPattern,
        is_drawn: impl Fn(usize) -> bool,
    ) {
        let chosen = self.generators.iter_mut().enumerate().filter(|(at, _)| is_drawn(*at));
        chosen.for_each(|(_, generator)| generator.draw(pattern));
    }

    /// Returns the drawn frame.
    pub(crate) fn frame(&self) -> Result<Frame, CosimError> {
        let (side, (width, height)) = (self.side, self.size);
        let columns = width.div_ceil(side);
        let pixel = |x: u32, y: u32| {
            let generator = &self.generators[(y / side * columns + x / side) as usize];
            generator.pixels[(y % side * side + x % side) as usize]
        };
        Ok(Frame::from_fn(width, height, self.bits, pixel)?)
    }
}
