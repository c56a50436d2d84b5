// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network that must agree, behind the camera, with its outputs for whole frames.
//!
//! The network first runs on some whole frames of every part of the clips, spread evenly. Later it
//! runs on the same frames behind a camera. If a least agreement is wanted, this ends as soon as
//! the camera could not reach it even if the outputs for all later frames were equal.

use foveate_camera::{Camera, CameraConfig};
use foveate_engine::Engine;
use foveate_inference::{
    ConfidenceIntervals, FrameOutcome, InferenceError, NOISE_LEVELS, NoiseComparison,
    OutputAgreement, VisionNetwork, frame_format_of, has_class_map,
};
use foveate_media::{ClipHalves, FrameDepths, RunMonitor};
use foveate_tools::open_file;
use rayon::prelude::*;

use super::agreement_estimate::AgreementEstimate;
use super::clip_part::{ClipPart, spread_evenly};
use super::network_goal::{FittedNetwork, NetworkGoal};
use crate::ExploreError;
use crate::footage::ExplorationFootage;
use crate::progress::network_progress;
use crate::row::count_to_f64;

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
    /// The frames that the network saw, by the number of their [`ClipPart`] and by clip.
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
        let vision_network =
            VisionNetwork::read(goal.path, open_file, footage.size, goal.vision_options)
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
            let wanted = ClipPart::ALL.map(|part| spread_evenly(part.later_frames(frames), most));
            let mut run = vision_network.start_run(frame_format_of(&camera));
            let mut player = footage.clips.open(clip)?.limited_to(frames.1);
            let mut samples_of_clip = [const { Vec::new() }; 3];
            for current in monitor.watch(&mut player) {
                let current = current?;
                let number = current.number;
                let is_wanted = |part: &ClipPart| wanted[*part as usize].contains(&number);
                let Some(part) = ClipPart::ALL.into_iter().find(is_wanted) else { continue };
                let findings = run.outcome(current.frame.borrowed_pixels());
                match part {
                    ClipPart::Search | ClipPart::Confirmation => {}
                    ClipPart::HeldOut => {
                        let frame = current.frame.borrowed_pixels().to_words();
                        let (whole, at) = (run.findings(), (clip as u64, number));
                        noise.add_frame((&vision_network, &mut run), (&frame, &whole), at);
                    }
                }
                let best_agreement = vision_network.compare(&findings, &findings);
                let sample = WholeFrameSample { number, findings, best_agreement };
                samples_of_clip[part as usize].push(sample);
            }
            samples.iter_mut().zip(samples_of_clip).for_each(|(part, own)| part.push(own));
        }
        Ok(Self { vision_network, goal, footage, halves, samples, noise })
    }

    /// Returns the bytes per frame that cameras send on the first halves. `cameras_before` is the
    /// number of cameras that the network was run behind before, for progress.
    pub(super) fn bytes_per_frame_of(
        &self,
        cameras: &[Camera],
        cameras_before: usize,
    ) -> Result<Vec<f64>, ExploreError> {
        let (mut values, mut frames) = (vec![0; cameras.len()], 0);
        let stage = |_| network_progress(cameras_before);
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
            detector: self.goal.vision_options.detector.as_ref().map(ToString::to_string),
            min_agreement: self.goal.min_agreement,
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

    /// Returns the agreement behind a camera on a part. `cameras_before` is the number of cameras
    /// that the network was run behind before, for progress. With `least` the run ends as soon as
    /// `least` cannot be reached, and the agreement is an upper bound.
    pub(super) fn measure_agreement(
        &self,
        camera: &Camera,
        part: ClipPart,
        least: Option<f64>,
        cameras_before: usize,
    ) -> Result<AgreementEstimate, ExploreError> {
        let samples = &self.samples[part as usize];
        let mut seen: Vec<OutputAgreement> = Vec::new();
        let stage = |_| network_progress(cameras_before);
        let monitor = RunMonitor::of_stage(self.footage.hooks, &stage);
        for (clip, own) in samples.iter().enumerate() {
            let Some(last) = own.last() else { continue };
            let mut run = self.vision_network.start_run(frame_format_of(camera));
            let mut engine = Engine::new(camera);
            let mut player = self.footage.clips.open(clip)?.limited_to(last.number + 1);
            let mut unseen = own.iter().peekable();
            for current in monitor.watch(&mut player) {
                let current = current?;
                FrameDepths::from_frame(&current, [camera.pixel_bits()])?.show_to(&mut engine)?;
                let sample = unseen.next_if(|sample| sample.number == current.number);
                let Some(sample) = sample else { continue };
                let screen = run.outcome(engine.rendered());
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

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};

    use foveate_inference::{Framing, PixelMapping, VisionOptions};
    use foveate_media::{InputOptions, SilentHooks};

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
        let vision_options = VisionOptions { framing: Framing::Same, mapping, detector: None };
        let goal = NetworkGoal {
            path: Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx")),
            vision_options: &vision_options,
            min_agreement: 0.9,
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
}
