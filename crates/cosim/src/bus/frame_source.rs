// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames for the buses: regions that become active, are held, and are irrelevant in turn, and
//! frames of noise, in which all regions are active.

use crate::stimulus::StimulusPattern::{self, *};
use crate::stimulus::{FrameFeed, FrameGenerator, Random};
use foveate_design::RasterDesign;
use foveate_frame::Frame;

/// The patterns that each region shows in turn in quiet frames. Few regions are relevant, so that
/// few packets are long. The means of irrelevant regions just meet the summary level, or exceed it.
const QUIET_PATTERNS: &[StimulusPattern] = &[Flat, MeanStep, Same, MeanStep, Noise, Flicker, Same];
/// The patterns of a frame in which each row of regions has some active regions, and no more.
const SPARSE_PATTERNS: &[StimulusPattern] = &[Noise, Flat, Flat, Flat, Flat, Flat, Flat, Flat];
/// One in so many frames is noise all over.
const NOISE_PERIOD: usize = 3;

/// A source of frames for a design, one after the other.
pub(super) struct BusFrameSource {
    /// The drawing states of quiet frames and of frames of noise. A quiet frame follows the last
    /// quiet one.
    quiet: FrameGenerator,
    noise: FrameGenerator,
    frame_number: usize,
    random: Random,
}

impl BusFrameSource {
    pub(super) fn new(design: RasterDesign<'_>, random: &mut Random) -> Self {
        let feed = FrameFeed::for_design(design.design());
        let [quiet, noise] = [0; 2].map(|_| FrameGenerator::new(&feed, random));
        Self { quiet, noise, frame_number: 0, random: random.fork() }
    }

    /// Returns the next frame; every third one is noise.
    pub(super) fn next(&mut self) -> Frame {
        match self.frame_number % NOISE_PERIOD == NOISE_PERIOD - 1 {
            true => self.noise_frame(),
            false => self.quiet_frame(),
        }
    }

    /// Returns the next frame, which is noise all over.
    pub(super) fn noise_frame(&mut self) -> Frame {
        self.frame_number += 1;
        drawn_frame(&mut self.noise, &[Noise], 0, &mut self.random)
    }

    /// Returns the next frame, in which few regions are active.
    pub(super) fn quiet_frame(&mut self) -> Frame {
        self.frame_number += 1;
        drawn_frame(&mut self.quiet, QUIET_PATTERNS, self.frame_number, &mut self.random)
    }

    /// Returns the next frame; one in eight regions is noise, and the others are flat.
    pub(super) fn sparse_frame(&mut self) -> Frame {
        self.frame_number += 1;
        drawn_frame(&mut self.noise, SPARSE_PATTERNS, 0, &mut self.random)
    }

    /// Returns the next frame, which is noise in the lower half of the levels. So no change from
    /// one such frame to the next sets the highest bit.
    pub(super) fn dark_frame(&mut self) -> Frame {
        let noise = self.noise_frame();
        let pixels = noise.pixels().iter().map(|pixel| pixel / 2).collect();
        Frame::new(noise.width(), noise.height(), noise.bits(), pixels)
            .expect("half of a pixel is a pixel")
    }
}

fn drawn_frame(
    generator: &mut FrameGenerator,
    patterns: &[StimulusPattern],
    turn: usize,
    random: &mut Random,
) -> Frame {
    generator.draw(patterns, turn, true, false, random);
    generator.frame().expect("pixels are those of the design")
}
