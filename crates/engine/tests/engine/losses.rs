// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lost regions: the engine against a camera that keeps one reference and one summary per region,
//! and forgets them as `docs/raster.md` says.

use foveate_camera::{
    Camera, IrrelevantRendering, ReferencePolicy, ReferenceWriteTime, RegionAction, VoteCombination,
};
use foveate_engine::{Engine, EngineOptions, FrameOutcome};
use foveate_model::{
    RegionScorer, ThresholdInputs, pad, region_action, region_border, region_stream,
};
use foveate_pixels::Frame;
use proptest::prelude::*;

use crate::clip_script::{clip, scripts};
use crate::random_cameras::cameras;

/// A camera that scores one region after the other.
struct RegionwiseCamera {
    camera: Camera,
    scorer: RegionScorer,
    thresholds: ThresholdInputs,
    references: Vec<Option<Vec<u16>>>,
    summaries: Vec<Option<Vec<u16>>>,
}

impl RegionwiseCamera {
    fn new(camera: &Camera) -> Self {
        let regions = camera.regions() as usize;
        Self {
            camera: camera.clone(),
            scorer: RegionScorer::new(camera),
            thresholds: ThresholdInputs::from_camera(camera),
            references: vec![None; regions],
            summaries: vec![None; regions],
        }
    }

    fn step(&mut self, frame: &Frame) -> Vec<(RegionAction, u32)> {
        let padded = pad(&self.camera, frame).unwrap();
        (0..self.camera.regions()).map(|region| self.step_region(region, &padded)).collect()
    }

    fn step_region(&mut self, region: u32, padded: &Frame) -> (RegionAction, u32) {
        let (camera, place) = (&self.camera, region as usize);
        let mut stream = Vec::new();
        region_stream(camera, padded, region, &mut stream);
        self.scorer.load(stream.into_iter(), region_border(camera, region));
        let reference = self.references[place].as_deref();
        let count = self.scorer.temporal_count(reference, &self.thresholds);
        let scores = self.scorer.scores(reference, &self.thresholds);
        let mut votes = camera.features().iter().zip(scores).map(|(own, s)| s >= own.min_score());
        let srs = match camera.combine() {
            VoteCombination::Any => votes.any(|vote| vote),
            VoteCombination::All => votes.all(|vote| vote),
        };
        let trs = count >= camera.temporal().min_count;
        let means = self.scorer.means();
        let differs = |shown: &Vec<u16>| {
            let pairs = shown.iter().zip(&means);
            let level = camera.periphery().unwrap().level;
            pairs.map(|(a, b)| u32::from(a.abs_diff(*b))).any(|difference| difference > level)
        };
        let is_due = || self.summaries[place].as_ref().is_none_or(differs);
        let action = region_action(camera.irrelevant(), srs, trs, is_due);
        let scored = || Some(self.scorer.pixels().collect());
        match (camera.temporal().reference, action) {
            (ReferencePolicy::Previous, _) | (ReferencePolicy::LastSent, RegionAction::Forward) => {
                self.references[place] = scored();
            }
            (ReferencePolicy::LastSent, RegionAction::Hold) => {
                if !srs && camera.irrelevant() != IrrelevantRendering::Hold {
                    self.references[place] = None;
                }
            }
            (ReferencePolicy::LastSent, RegionAction::Blank | RegionAction::Summarize) => {
                self.references[place] = None;
            }
        }
        match action {
            RegionAction::Forward => self.summaries[place] = None,
            RegionAction::Summarize => self.summaries[place] = Some(means),
            RegionAction::Hold | RegionAction::Blank => {}
        }
        (action, count)
    }

    fn forget(&mut self, region: u32) {
        self.summaries[region as usize] = None;
        match self.camera.temporal().reference.write_time() {
            ReferenceWriteTime::EveryFrame => {}
            ReferenceWriteTime::WhenSent => self.references[region as usize] = None,
        }
    }
}

/// Returns the regions that sent something and are lost, by the bits of `seed`.
fn lost_regions(outcome: &FrameOutcome, seed: u64) -> Vec<u32> {
    let sent = (0..).zip(&outcome.actions).filter(|(_, action)| match action {
        RegionAction::Forward | RegionAction::Summarize => true,
        RegionAction::Hold | RegionAction::Blank => false,
    });
    sent.map(|(region, _)| region).filter(|region| seed >> (region % 61) & 1 == 1).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::cases(300)))]

    #[test]
    fn a_lost_region_has_no_reference_and_no_summary(
        camera in cameras(),
        (seed, script) in scripts(),
        threads in 1usize..=2,
        losses in proptest::collection::vec(prop_oneof![Just(0), any::<u64>()], 10),
    ) {
        let options = EngineOptions { threads, ..EngineOptions::default() };
        let mut engine = Engine::with_options(&camera, options).unwrap();
        let mut expected = RegionwiseCamera::new(&camera);
        for (frame, loss) in clip(&camera, seed, &script).iter().zip(losses) {
            let outcome = engine.step(frame).unwrap();
            let values = outcome.actions.iter().copied().zip(outcome.temporal_count.iter().copied());
            prop_assert_eq!(values.collect::<Vec<_>>(), expected.step(frame));
            for region in lost_regions(outcome, loss) {
                engine.forget_region(region);
                expected.forget(region);
            }
        }
    }
}

/// In a clip that does not change, a region that is lost is sent again once, although the engine
/// skips regions whose pixels are the same.
#[test]
fn a_still_region_that_was_lost_is_sent_once_more() {
    let mut config = foveate_camera::CameraConfig::default();
    (config.frame.width, config.frame.height) = (Some(64), Some(32));
    config.temporal.reference = ReferencePolicy::LastSent;
    let camera = config.validate().unwrap();
    let frame = &clip(&camera, 5, &[])[0];
    let mut engine = Engine::new(&camera);
    let mut skipped = 0;
    for number in 0..60 {
        let outcome = engine.step(frame).unwrap();
        let active: Vec<usize> = (0..32).filter(|&region| outcome.active[region]).collect();
        skipped += outcome.skipped;
        match number {
            0 => assert_eq!(active.len(), 32),
            40 => {
                assert_eq!(active, [13]);
                assert_eq!(outcome.skipped, 31);
            }
            _ => assert_eq!(active, [0; 0], "frame {number}"),
        }
        if number == 39 {
            engine.forget_region(13);
        }
    }
    assert!(skipped > 1000, "{skipped} regions were skipped");
}
