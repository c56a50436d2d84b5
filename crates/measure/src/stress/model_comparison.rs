// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison of the functional model, the engine and, for designs of `pipelined`, the
//! cycle-level model over the same frames.

use foveate_design::{Design, Hardware, PipelinedDesign};
use foveate_engine::Engine;
use foveate_model::{
    CoreInput, FunctionalCamera, PipelinedRcm, RpuOutput, ThresholdInputs, region_stream,
};
use foveate_pixels::Frame;

use super::designs::RandomNumbers;

/// The number of values that differ, and the number that were compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct AgreementTally {
    /// The number of values that differ from those of the functional model.
    pub(crate) differing: u64,
    pub(crate) compared: u64,
}

impl AgreementTally {
    fn check(&mut self, equal: bool) {
        self.differing += u64::from(!equal);
        self.compared += 1;
    }

    pub(crate) fn add(self, other: Self) -> Self {
        Self {
            differing: self.differing + other.differing,
            compared: self.compared + other.compared,
        }
    }
}

/// Runs frames through the models. If `unrest` is set, gaps are inserted between pixels, and
/// before every eighth frame a part of a frame is sent, after which all models are reset.
pub(crate) fn compare_models(
    design: &Design,
    frames: impl IntoIterator<Item = Frame>,
    unrest: bool,
) -> AgreementTally {
    let mut tally = AgreementTally::default();
    let mut camera = FunctionalCamera::new(design);
    let mut engine = Engine::new(design);
    let pipelined = match design.hardware() {
        Hardware::Pipelined(own) => Some(design.with_hardware(own)),
        Hardware::Serial(_) | Hardware::Raster(_) => None,
    };
    let mut cycle_level = pipelined.map(|design| CycleLevelRun::new(design, unrest));
    // A decision may come one frame late, and those that are pending at a reset never come.
    let mut pending = std::collections::VecDeque::new();
    for (number, frame) in (0u64..).zip(frames) {
        if unrest && number % 8 == 7 {
            if let Some(run) = &mut cycle_level {
                run.cut_frame_by_reset(&frame);
            }
            camera.reset();
            engine.reset();
            pending.clear();
        }
        let (Ok(expected), Ok(actual)) = (camera.step(&frame), engine.step(&frame)) else {
            tally.check(false);
            continue;
        };
        tally.check(expected.srs == actual.srs && expected.trs == actual.trs);
        tally.check(expected.scores == actual.scores);
        tally.check(expected.displacements == actual.displacements);
        tally.check(expected.temporal_count == actual.temporal_count);
        tally.check(expected.actions == actual.actions);
        let rendered = expected.rendered.pixels() == engine.rendered().to_words();
        tally.check(rendered);
        let Some(run) = &mut cycle_level else { continue };
        pending.push_back(expected.clone());
        for decision in run.send_frame(&frame) {
            let Some(expected) = pending.pop_front() else {
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
struct CycleLevelRun<'a> {
    design: PipelinedDesign<'a>,
    rcm: PipelinedRcm,
    thresholds: ThresholdInputs,
    random: RandomNumbers,
    /// The values at the pixel ports while no pixel is valid.
    idle: Vec<u16>,
    has_gaps: bool,
}

impl<'a> CycleLevelRun<'a> {
    fn new(design: PipelinedDesign<'a>, unrest: bool) -> Self {
        Self {
            design,
            rcm: PipelinedRcm::new(design),
            thresholds: ThresholdInputs::from_camera(&design),
            random: RandomNumbers::new(7),
            idle: vec![0; design.regions() as usize],
            has_gaps: unrest,
        }
    }

    /// Sends one frame, with or without gaps, and then idle clocks until all its decisions have
    /// come. Returns the outputs of every decision.
    fn send_frame(&mut self, frame: &Frame) -> Vec<Vec<RpuOutput>> {
        let mut decisions = Vec::new();
        for pixels in self.pixel_streams(frame) {
            while self.has_gaps && self.random.below(4) == 0 {
                self.clock_once(None, &mut decisions);
            }
            self.clock_once(Some(&pixels), &mut decisions);
        }
        for _ in 0..2 * self.design.region_size() + 8 {
            self.clock_once(None, &mut decisions);
        }
        decisions
    }

    /// Sends a part of a frame, and a reset.
    fn cut_frame_by_reset(&mut self, frame: &Frame) {
        let streams = self.pixel_streams(frame);
        let cut = self.random.below(streams.len() as u64);
        for pixels in
            streams.iter().take(usize::try_from(cut).expect("less than the pixels of a stream"))
        {
            self.clock_once(Some(pixels), &mut Vec::new());
        }
        self.step(true, None);
    }

    fn clock_once(&mut self, pixels: Option<&[u16]>, decisions: &mut Vec<Vec<RpuOutput>>) {
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
    fn pixel_streams(&self, frame: &Frame) -> Vec<Vec<u16>> {
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
    use crate::stress::designs::{config, design};
    use foveate_camera::FeatureKind;

    #[test]
    fn frames_of_another_design_are_noticed() {
        let config = config((16, 16), 8, 8, &[FeatureKind::Edge]);
        let frames = || (0..3).map(|seed| RandomNumbers::new(seed).frame((16, 16), 8));
        let tally = compare_models(&design(&config), frames(), false);
        assert_eq!(tally.differing, 0);
        assert!(tally.compared > 3 * (5 + 4), "{tally:?}");
        let wrong_size =
            compare_models(&design(&config), [RandomNumbers::new(1).frame((16, 24), 8)], false);
        assert_eq!(wrong_size.differing, 1);
    }
}
