// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network that must agree, behind the camera, with its outputs for whole frames.
//!
//! The network first runs on some whole frames of every part of the clips, spread evenly. A camera
//! is dropped as soon as it cannot reach the wanted agreement, even if it agreed on all other
//! frames.

use std::ops::Range;
use std::path::Path;

use foveate_camera::{Camera, CameraConfig};
use foveate_engine::Engine;
use foveate_inference::{
    ConfidenceIntervals, FrameOutcome, InferenceError, NOISE_LEVELS, NoiseAgreement,
    NoiseComparison, OutputAgreement, VisionNetwork, VisionOptions, frame_format_of, has_class_map,
};
use foveate_playback::{ClipHalves, FrameDepths, RunMonitor};
use rayon::prelude::*;
use serde::Serialize;

use super::agreement::AgreementEstimate;
use crate::ExploreError;
use crate::footage::ExplorationFootage;
use crate::progress::network_progress;
use crate::row::count_to_f64;

/// The goal of a fit with a network: the network must agree, behind the camera, with its outputs
/// for whole frames.
#[derive(Clone, Copy, Debug)]
pub struct NetworkGoal<'a> {
    /// The network's file.
    pub path: &'a Path,
    /// The options for reading the network and for showing it frames.
    pub viewing: &'a VisionOptions,
    /// The least agreement, 0..=1, defined as by `foveate infer --whole-frames`.
    pub min_agreement: f64,
    /// The cost that is minimized.
    pub cheapest: CostObjective,
    /// The most frames of each part of all clips that the network sees: of the part that cameras
    /// are searched by, of the part that confirms a camera, and of the second halves.
    pub frames: u64,
}

/// The cost of designs behind which a network agrees enough.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum CostObjective {
    /// The bytes that leave the camera; area decides between cameras with equal bytes.
    Bytes,
    /// The area.
    Area,
}

/// The agreement of a network behind the chosen design with the network on whole frames.
#[derive(Clone, Debug, Serialize)]
pub struct FittedNetwork {
    /// The network's file.
    pub network: String,
    /// The format of the detections, if they are read.
    pub detector: Option<String>,
    /// The least agreement that was wanted, 0..=1.
    pub min_agreement: f64,
    /// The cost that was minimized.
    pub cheapest: CostObjective,
    /// The agreement on the frames of the search: the first two thirds of the first half.
    pub fitted: AgreementEstimate,
    /// The agreement on the rest of the first half, which had no part in the search and confirmed
    /// its result.
    pub confirmed: AgreementEstimate,
    /// The agreement on the second half, which influenced no choice.
    pub held_out: AgreementEstimate,
    /// The agreement with whole frames of the second half under noise, level by level.
    pub noise: Vec<NoiseAgreement>,
    /// The size of a whole frame in bytes.
    pub bytes_per_whole_frame: f64,
}

/// A part of every clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ClipPart {
    /// The first two thirds of the first half, which cameras are searched by.
    Search,
    /// The rest of the first half, which comes later, has no part in the search, and confirms its
    /// result.
    Confirmation,
    /// The second half.
    HeldOut,
}

impl ClipPart {
    /// The fewest frames of a clip with which each part has a frame.
    pub(super) const MIN_FRAMES: u64 = 6;

    /// Returns the frames of this part of a clip with `all` frames, of which `half` are the first
    /// half. The first frame belongs to no part, because every camera sends it whole.
    fn frames(self, (half, all): (u64, u64)) -> Range<u64> {
        let searched = (2 * half).div_ceil(3);
        match self {
            Self::Search => 1..searched,
            Self::Confirmation => searched..half,
            Self::HeldOut => half..all,
        }
    }
}

/// A frame that the network sees, and its findings.
struct WholeFrameSample {
    number: u64,
    findings: FrameOutcome,
    /// The agreement behind a camera that shows whole frames.
    best_agreement: OutputAgreement,
}

/// The network, and its findings in whole frames.
pub(super) struct NetworkAgreement<'a> {
    vision_network: VisionNetwork,
    pub(super) goal: NetworkGoal<'a>,
    footage: &'a ExplorationFootage<'a>,
    halves: &'a ClipHalves,
    /// The frames that the network saw, by part and by clip.
    samples: [Vec<Vec<WholeFrameSample>>; 3],
    /// The agreement under noise on the whole frames of the second halves.
    noise: NoiseComparison,
}

impl<'a> NetworkAgreement<'a> {
    /// Runs the network on whole frames in the depth of the task.
    pub(super) fn new(
        goal: NetworkGoal<'a>,
        footage: &'a ExplorationFootage<'a>,
        halves: &'a ClipHalves,
        task: &CameraConfig,
    ) -> Result<Self, ExploreError> {
        let vision_network = VisionNetwork::read(goal.path, footage.size, goal.viewing)
            .map_err(InferenceError::from)?;
        let camera = task.validate()?;
        let clips = halves.frames.len() as u64;
        let most = (goal.frames / clips).max(1);
        let mut samples = [const { Vec::new() }; 3];
        let mut noise = NoiseComparison::new(&NOISE_LEVELS, camera.pixel_max());
        let stage = |_| network_progress(0);
        let monitor = RunMonitor::of_stage(footage.hooks, &stage);
        monitor.report();
        for (clip, &frames) in halves.frames.iter().enumerate() {
            let parts = [ClipPart::Search, ClipPart::Confirmation, ClipPart::HeldOut];
            let wanted = parts.map(|part| (part, spread_evenly(part.frames(frames), most)));
            let mut looking = vision_network.start_run(frame_format_of(&camera));
            let mut player = footage.clips.open(clip)?.limited_to(frames.1);
            let mut found = [const { Vec::new() }; 3];
            for current in monitor.watch(&mut player) {
                let current = current?;
                let number = current.number;
                for (found, (part, wanted)) in found.iter_mut().zip(&wanted) {
                    if wanted.contains(&number) {
                        let whole = looking.outcome(current.frame.borrowed_pixels());
                        if *part == ClipPart::HeldOut {
                            let frame = current.frame.borrowed_pixels().to_words();
                            let at = (clip as u64, number);
                            let findings = looking.findings();
                            noise.add_frame(
                                (&vision_network, &mut looking),
                                (&frame, &findings),
                                at,
                            );
                        }
                        let best = vision_network.compare(&whole, &whole);
                        found.push(WholeFrameSample {
                            number,
                            findings: whole,
                            best_agreement: best,
                        });
                    }
                }
            }
            samples.iter_mut().zip(found).for_each(|(part, found)| part.push(found));
        }
        Ok(Self { vision_network, goal, footage, halves, samples, noise })
    }

    /// Returns the bytes per frame that cameras send on the first halves. `asked` is the number of
    /// cameras that the network was run behind so far, for progress.
    pub(super) fn bytes_per_frame_of(
        &self,
        cameras: &[Camera],
        asked: usize,
    ) -> Result<Vec<f64>, ExploreError> {
        let (mut values, mut frames) = (vec![0; cameras.len()], 0);
        let stage = |_| network_progress(asked);
        let monitor = RunMonitor::of_stage(self.footage.hooks, &stage);
        for (clip, &(half, _)) in self.halves.frames.iter().enumerate() {
            let mut engines: Vec<Engine> = cameras.iter().map(Engine::new).collect();
            let mut player = self.footage.clips.open(clip)?.limited_to(half);
            for current in monitor.watch(&mut player) {
                let current = current?;
                let depths = cameras.iter().map(|camera| camera.pixel_bits());
                let shown = FrameDepths::from_frame(&current, depths)?;
                engines.par_iter_mut().zip(&mut values).try_for_each(|(engine, values)| {
                    shown.show_to(engine)?;
                    *values += engine.camera().values_sent_per_frame(&engine.outcome().actions);
                    Ok::<_, ExploreError>(())
                })?;
                frames += 1;
            }
        }
        let bytes = |(camera, values): (&Camera, &u64)| {
            count_to_f64(camera.bits_sent(frames, *values)) / 8.0 / count_to_f64(frames.max(1))
        };
        Ok(cameras.iter().zip(&values).map(bytes).collect())
    }

    /// Reports the agreement of the network behind the chosen camera. The agreement on the frames
    /// of the search is known; the one on the frames that confirm may be known.
    pub(super) fn fitted_network(
        &self,
        chosen: &CameraConfig,
        (fitted, confirmed): (AgreementEstimate, Option<AgreementEstimate>),
    ) -> Result<FittedNetwork, ExploreError> {
        let camera = chosen.validate()?;
        let of_pixels = f64::from(camera.width()) * f64::from(camera.height());
        Ok(FittedNetwork {
            network: self.goal.path.display().to_string(),
            detector: self.goal.viewing.detector.as_ref().map(ToString::to_string),
            min_agreement: self.goal.min_agreement,
            cheapest: self.goal.cheapest,
            fitted,
            confirmed: match confirmed {
                Some(confirmed) => confirmed,
                None => self.measure_agreement(&camera, ClipPart::Confirmation, None, 0)?,
            },
            held_out: self.measure_agreement(&camera, ClipPart::HeldOut, None, 0)?,
            noise: self.noise.results(),
            bytes_per_whole_frame: of_pixels * f64::from(self.footage.pixel_bits()) / 8.0,
        })
    }

    /// Returns the agreement behind a camera on a part. `asked` is the number of cameras so far,
    /// for progress. With `least` it stops as soon as `least` cannot be reached.
    pub(super) fn measure_agreement(
        &self,
        camera: &Camera,
        part: ClipPart,
        least: Option<f64>,
        asked: usize,
    ) -> Result<AgreementEstimate, ExploreError> {
        let samples = &self.samples[part as usize];
        let mut seen: Vec<OutputAgreement> = Vec::new();
        let stage = |_| network_progress(asked);
        let monitor = RunMonitor::of_stage(self.footage.hooks, &stage);
        for (clip, own) in samples.iter().enumerate() {
            let Some(last) = own.last() else { continue };
            let mut looking = self.vision_network.start_run(frame_format_of(camera));
            let mut engine = Engine::new(camera);
            let mut player = self.footage.clips.open(clip)?.limited_to(last.number + 1);
            let mut unseen = own.iter().peekable();
            for current in monitor.watch(&mut player) {
                let current = current?;
                FrameDepths::from_frame(&current, [camera.pixel_bits()])?.show_to(&mut engine)?;
                let sample = unseen.next_if(|sample| sample.number == current.number);
                let Some(sample) = sample else { continue };
                let screen = looking.outcome(engine.rendered());
                seen.push(self.vision_network.compare(&sample.findings, &screen));
                // Frames that the network has not seen yet count with their best possible
                // agreement. A clip that ended early has no such frames.
                let unseen = unseen.clone().chain(samples[clip + 1..].iter().flatten());
                let best = unseen.map(|sample| &sample.best_agreement);
                let share = seen.iter().chain(best).sum::<OutputAgreement>().share();
                if least.is_some_and(|least| share < least) {
                    return Ok(AgreementEstimate::upper_bound(share, seen.len() as u64));
                }
            }
        }
        let agreed = AgreementEstimate::from_frames(&seen);
        let no_interval =
            agreed.detections.is_none() && has_class_map(self.vision_network.network());
        Ok(if no_interval {
            AgreementEstimate { intervals: ConfidenceIntervals::default(), ..agreed }
        } else {
            agreed
        })
    }
}

/// Returns at most `most` numbers of a range, spread evenly.
fn spread_evenly(range: Range<u64>, most: u64) -> Vec<u64> {
    let length = range.end.saturating_sub(range.start);
    let count = most.min(length);
    (0..count).map(|index| range.start + (2 * index + 1) * length / (2 * count)).collect()
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use foveate_footage::InputOptions;
    use foveate_inference::{Framing, PixelMapping};
    use foveate_playback::SilentHooks;

    use super::super::test_clip::{remove_frames, write_clip};
    use super::*;

    /// Two clips are measured after the first one has lost frames that the network saw in it. Once
    /// that clip has ended, the bounds are those of a network that never saw the lost frames.
    #[test]
    fn frames_that_a_clip_has_lost_are_not_part_of_the_bounds_of_the_next_clip() {
        const LEFT_FRAMES: u32 = 4;
        let dir = tempfile::tempdir().unwrap();
        let inputs: [PathBuf; 2] = ["first", "second"].map(|name| dir.path().join(name));
        inputs.iter().for_each(|folder| write_clip(folder, 24));
        let task = CameraConfig::from_toml("[frame]\nwidth = 48\nheight = 32\n").unwrap();
        let options = InputOptions::default();
        let footage =
            ExplorationFootage::new((&inputs, &[]), &options, &task, &SilentHooks).unwrap();
        let halves = ClipHalves { frames: vec![(12, 24); 2], ..ClipHalves::default() };
        let mapping = PixelMapping { mean: vec![0.0], scale: vec![1.0] };
        let viewing = VisionOptions { framing: Framing::Same, mapping, detector: None };
        let goal = NetworkGoal {
            path: Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx")),
            viewing: &viewing,
            min_agreement: 0.9,
            cheapest: CostObjective::Bytes,
            frames: 48,
        };
        let network = || NetworkAgreement::new(goal, &footage, &halves, &task).unwrap();
        let with_lost_frames = network();
        remove_frames(&inputs[0], LEFT_FRAMES..24);
        let without_lost_frames = network();
        let camera = task.validate().unwrap();
        let bound = |network: &NetworkAgreement<'_>, least: f64| {
            network.measure_agreement(&camera, ClipPart::Search, Some(least), 0).unwrap()
        };
        let mut bounds_of_second_clip = 0;
        for percent in 0..100 {
            let least = f64::from(percent) / 100.0;
            let expected = bound(&without_lost_frames, least);
            if expected.is_upper_bound && expected.frames >= LEFT_FRAMES.into() {
                bounds_of_second_clip += 1;
                assert_eq!(bound(&with_lost_frames, least), expected, "{percent} %");
            }
        }
        assert!(bounds_of_second_clip > 0, "no bound was decided in the second clip");
    }

    /// Every frame but the first is in one part, the confirming frames come after those of the
    /// search, and no part is empty.
    #[test]
    fn parts_follow_each_other() {
        for all in ClipPart::MIN_FRAMES..200 {
            let [searched, confirmed, held_out] =
                [ClipPart::Search, ClipPart::Confirmation, ClipPart::HeldOut]
                    .map(|part| part.frames((all / 2, all)));
            let ends = (searched.start, held_out.end);
            assert_eq!(
                (ends, searched.end, confirmed.end),
                ((1, all), confirmed.start, held_out.start)
            );
            assert!(!searched.is_empty() && !confirmed.is_empty() && !held_out.is_empty(), "{all}");
        }
        assert_eq!(ClipPart::Confirmation.frames((90, 180)), 60..90);
        let one_fewer = ClipPart::MIN_FRAMES - 1;
        assert!(ClipPart::Confirmation.frames((one_fewer / 2, one_fewer)).is_empty());
    }

    #[test]
    fn frames_are_spread_evenly() {
        assert_eq!(spread_evenly(1..5, 10), [1, 2, 3, 4]);
        assert_eq!(spread_evenly(0..100, 4), [12, 37, 62, 87]);
        assert_eq!(spread_evenly(50..60, 1), [55]);
        assert!(spread_evenly(1..1, 4).is_empty());
    }
}
