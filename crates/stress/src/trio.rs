// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison of the functional model, the engine and the cycle-level model over the same
//! frames.

use foveate_design::{Design, PipelinedDesign};
use foveate_engine::Engine;
use foveate_frame::Frame;
use foveate_model::{
    CoreInput, FunctionalCamera, PipelinedRcm, RpuOutput, Thresholds, region_stream,
};

use crate::pixels::Random;

/// The number of values that differ, and the number that were compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct AgreementTally {
    /// The number of values that differ from those of the functional model.
    pub(crate) wrong: u64,
    /// The number of values that were compared.
    pub(crate) tried: u64,
}

impl AgreementTally {
    fn check(&mut self, equal: bool) {
        self.wrong += u64::from(!equal);
        self.tried += 1;
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self { wrong: self.wrong + other.wrong, tried: self.tried + other.tried }
    }
}

/// Runs frames through all three. `unrest` inserts gaps between pixels and, before every eighth
/// frame, a part of a frame that a reset ends. All three are reset then.
pub(crate) fn compare(
    design: &Design,
    frames: impl IntoIterator<Item = Frame>,
    unrest: bool,
) -> AgreementTally {
    let mut tally = AgreementTally::default();
    let mut camera = FunctionalCamera::new(design);
    let mut engine = Engine::new(design);
    let pipelined = design.pipelined().expect("cases are of pipelined designs");
    let mut clocks = Clocks::new(pipelined, unrest);
    // A decision may come one frame late, and those that are pending at a reset never come.
    let mut owed = std::collections::VecDeque::new();
    for (number, frame) in (0u64..).zip(frames) {
        if unrest && number % 8 == 7 {
            clocks.interrupt(&frame);
            camera.reset();
            engine.reset();
            owed.clear();
        }
        let (Ok(expected), Ok(fast)) = (camera.step(&frame), engine.step(&frame)) else {
            tally.check(false);
            continue;
        };
        tally.check(expected.srs == fast.srs && expected.trs == fast.trs);
        tally.check(expected.scores == fast.scores);
        tally.check(expected.temporal_count == fast.temporal_count);
        tally.check(expected.actions == fast.actions);
        let rendered = expected.rendered.pixels() == engine.rendered().to_words();
        tally.check(rendered);
        owed.push_back(expected.clone());
        for decision in clocks.frame(&frame) {
            let Some(expected) = owed.pop_front() else {
                tally.check(false);
                continue;
            };
            for (region, output) in decision.iter().enumerate() {
                let scores = expected.scores.iter().map(|scores| scores[region]);
                tally.check(
                    output.srs == expected.srs[region] && output.trs == expected.trs[region],
                );
                tally.check(scores.zip(output.scores).all(|(want, got)| want == got));
                tally.check(output.temporal_count == expected.temporal_count[region]);
            }
        }
    }
    tally
}

/// The cycle-level model, which takes whole frames.
struct Clocks<'a> {
    design: PipelinedDesign<'a>,
    rcm: PipelinedRcm,
    thresholds: Thresholds,
    random: Random,
    /// The values at the pixel ports while no pixel is valid.
    idle: Vec<u16>,
    unrest: bool,
}

impl<'a> Clocks<'a> {
    fn new(design: PipelinedDesign<'a>, unrest: bool) -> Self {
        Self {
            design,
            rcm: PipelinedRcm::new(design),
            thresholds: Thresholds::of(&design),
            random: Random::new(7),
            idle: vec![0; design.regions() as usize],
            unrest,
        }
    }

    /// Sends one frame, with or without gaps, and then idle clocks until all its decisions have
    /// come. Returns the outputs of every decision.
    fn frame(&mut self, frame: &Frame) -> Vec<Vec<RpuOutput>> {
        let mut decisions = Vec::new();
        for pixels in self.streams(frame) {
            while self.unrest && self.random.below(4) == 0 {
                self.clock(None, &mut decisions);
            }
            self.clock(Some(&pixels), &mut decisions);
        }
        for _ in 0..2 * self.design.region_size() + 8 {
            self.clock(None, &mut decisions);
        }
        decisions
    }

    /// Sends a part of a frame, and a reset.
    fn interrupt(&mut self, frame: &Frame) {
        let streams = self.streams(frame);
        let cut = self.random.below(streams.len() as u64);
        for pixels in
            streams.iter().take(usize::try_from(cut).expect("less than the pixels of a stream"))
        {
            self.clock(Some(pixels), &mut Vec::new());
        }
        self.step(true, None);
    }

    fn clock(&mut self, pixels: Option<&[u16]>, decisions: &mut Vec<Vec<RpuOutput>>) {
        let outputs = self.step(false, pixels);
        if outputs[0].decision_valid {
            decisions.push(outputs.to_vec());
        }
    }

    fn step(&mut self, reset: bool, pixels: Option<&[u16]>) -> &[RpuOutput] {
        self.rcm.step(&CoreInput {
            reset,
            valid: pixels.is_some(),
            ..CoreInput::idle(pixels.unwrap_or(&self.idle), &self.thresholds)
        })
    }

    /// Returns the pixels that all regions take at each clock.
    fn streams(&self, frame: &Frame) -> Vec<Vec<u16>> {
        let stream = |region| {
            let mut stream = Vec::new();
            region_stream(&self.design, frame, region, &mut stream);
            stream
        };
        let streams: Vec<_> = (0..self.design.regions()).map(stream).collect();
        let length = streams[0].len();
        (0..length).map(|at| streams.iter().map(|stream| stream[at]).collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::designs::{config, design};
    use foveate_design::FeatureKind;

    #[test]
    fn frames_of_another_design_are_noticed() {
        let config = config((16, 16), 8, 8, &[FeatureKind::Edge]);
        let frames = || (0..3).map(|seed| Random::new(seed).frame((16, 16), 8));
        let tally = compare(&design(&config), frames(), false);
        assert_eq!(tally.wrong, 0);
        assert!(tally.tried > 3 * (5 + 4), "{tally:?}");
        let wrong_size = compare(&design(&config), [Random::new(1).frame((16, 24), 8)], false);
        assert_eq!(wrong_size.wrong, 1);
    }
}
