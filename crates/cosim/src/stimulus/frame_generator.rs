// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whole frames of patterns, with one drawing state for every region ([`FrameGenerator`]). For
//! thresholds that are aimed at these frames, a [`DecisionPredictor`] knows the clocks at which
//! a pipelined array decides, and the scores that it decides on.

use super::frame_feed::FrameFeed;
use super::random::Random;
use super::stimulus_pattern::{PatternGenerator, StimulusPattern};
use crate::error::CosimError;
use foveate_camera::FeatureKind;
use foveate_design::{Design, Hardware, PortRole};
use foveate_model::{
    CoreInput, CycleModel, FrameSync, PipelinedRpu, RpuInput, ThresholdInputs, ZoneInputs,
};
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

/// A separate RPU that runs along with the array. A decision comes at the same clock in every lane,
/// and pixels, borders and thresholds do not change that clock.
pub(super) struct DecisionPredictor {
    rpu: PipelinedRpu,
    /// The frame synchronization in front of the RPU, equal to the one in front of the lanes.
    sync: FrameSync,
    kinds: Vec<FeatureKind>,
    /// The largest summary level; `None` if irrelevant regions send no means.
    summary_level: Option<u32>,
}

impl DecisionPredictor {
    /// Returns the prediction, or `None` if thresholds must not change within a frame.
    /// `finds_frames` says that the frame synchronization of the design is simulated.
    pub(super) fn for_design(design: &Design, finds_frames: bool) -> Option<Self> {
        let own = match design.hardware() {
            Hardware::Pipelined(own) => design.with_hardware(own),
            Hardware::Serial(_) | Hardware::Raster(_) => return None,
        };
        let sync = if finds_frames { FrameSync::new(design) } else { FrameSync::without_sync() };
        let summary_level = design.periphery().map(|_| design.pixel_max());
        Some(Self {
            rpu: PipelinedRpu::new(own),
            sync,
            kinds: design.feature_kinds(),
            summary_level,
        })
    }

    /// Steps by one edge, and returns true if it makes a decision. Every edge of a sequence with
    /// aimed thresholds must be stepped. Other sequences need no steps, because the reset at the
    /// start of a sequence synchronizes it again.
    pub(super) fn decides(&mut self, input: &CoreInput<'_>) -> bool {
        let &CoreInput { reset, valid, sof, border, pixels, thresholds, .. } = input;
        let valid = if reset {
            self.sync.reset();
            false
        } else {
            self.sync.step(valid, sof, true)
        };
        let input = RpuInput { reset, valid, pixel: pixels[0], border };
        self.rpu.step(&input, thresholds).decision_valid
    }

    /// Returns the scores and the temporal count of a lane after this edge. They do not depend on
    /// the minima at the edge, so a copy of the core can compute them in advance.
    pub(super) fn predict_scores(
        &self,
        core: &dyn CycleModel,
        input: &CoreInput<'_>,
        lane: usize,
    ) -> ([u64; FeatureKind::COUNT], u32) {
        let mut ahead = core.duplicate();
        ahead.clock(input);
        let mut values = Vec::new();
        let mut shown = |role| {
            values.clear();
            ahead.append_output(role, &mut values);
            values[lane]
        };
        let mut scores = [0; FeatureKind::COUNT];
        for (score, &kind) in scores.iter_mut().zip(&self.kinds) {
            *score = shown(PortRole::Score(kind));
        }
        let count = shown(PortRole::TemporalCount);
        (scores, u32::try_from(count).expect("a count has at most 32 bits"))
    }

    /// Returns the smallest summary level at which the lane sends no summary after this edge, which
    /// is the widest difference of its means from those on the screen. Returns `None` if the level
    /// does not decide it.
    pub(super) fn decisive_summary_level(
        &self,
        core: &dyn CycleModel,
        input: &CoreInput<'_>,
        lane: usize,
    ) -> Option<u32> {
        let is_sent = |summary_level: u32| {
            // The class of the region decides which of the levels is in use.
            let with_level = |own: &ThresholdInputs| ThresholdInputs { summary_level, ..*own };
            let thresholds = with_level(input.thresholds);
            let keen = with_level(input.zones.map_or(input.thresholds, |zones| zones.keen));
            let zones = input.zones.map(|zones| ZoneInputs {
                keen: &keen,
                off_summary_level: summary_level,
                ..zones
            });
            let mut ahead = core.duplicate();
            ahead.clock(&CoreInput { thresholds: &thresholds, zones, ..*input });
            let mut values = Vec::new();
            ahead.append_output(PortRole::Summary, &mut values);
            values[lane] == 1
        };
        let (mut sent, mut silent) = (0, self.summary_level?);
        if !is_sent(sent) || is_sent(silent) {
            return None;
        }
        while silent - sent > 1 {
            let middle = sent.midpoint(silent);
            (sent, silent) = if is_sent(middle) { (middle, silent) } else { (sent, middle) };
        }
        Some(silent)
    }
}
