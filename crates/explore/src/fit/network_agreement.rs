// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network that must agree, behind the camera, with its outputs for whole frames
//! ([`NetworkGoal`]).
//!
//! The network first runs on some whole frames of every part of the clips, spread evenly. Later
//! it runs on the same frames behind a camera ([`NetworkAgreement`]). If a least agreement is
//! wanted, this ends as soon as the camera could not reach it even if the outputs for all later
//! frames were equal. Each agreement comes with a bound for other frames
//! ([`AgreementEstimate`]), and those that a descent has measured give the reasons for its
//! result ([`KnownAgreements`]).

use super::decision_rates::{frame_group, group_count, group_margin, share_of_others};
use super::search_frames::{ClipPart, spread_evenly};
use crate::ExploreError;
use crate::footage::ExplorationFootage;
use crate::progress::network_progress;
use crate::row::count_to_f64;
use foveate_camera::{Camera, CameraConfig};
use foveate_engine::Engine;
use foveate_inference::{
    ConfidenceIntervals, DetectionCounts, FrameOutcome, InferenceError, NOISE_LEVELS,
    NoiseAgreement, NoiseComparison, OutputAgreement, VisionNetwork, VisionOptions,
    frame_format_of, has_class_map,
};
use foveate_media::{ClipHalves, FrameDepths, RunMonitor};
use foveate_tools::open_file;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

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

/// The goal of a fit with a network: the network must agree, behind the camera, with its outputs
/// for whole frames.
#[derive(Clone, Copy, Debug)]
pub struct NetworkGoal<'a> {
    /// The network's file.
    pub path: &'a Path,
    /// The options for reading the network and for showing it frames.
    pub vision_options: &'a VisionOptions,
    /// The least agreement, 0..=1, defined as by `foveate infer --whole-frames`.
    pub min_agreement: f64,
    /// The most frames of each part of all clips that the network sees: of the part that cameras
    /// are searched by, of the part that confirms a camera, and of the second halves.
    pub frames: u64,
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

/// The agreement of a network behind a camera with the network on whole frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AgreementEstimate {
    /// The number of frames that the network saw.
    pub frames: u64,
    /// The agreement, 0..=1.
    pub share: f64,
    /// The agreement that 19 of 20 sets of as many other frames would exceed, 0..=1, if groups of
    /// frames were independent.
    pub expected: f64,
    /// True if the agreement is only an upper bound, because the network did not see the other
    /// frames.
    #[serde(skip)]
    pub is_upper_bound: bool,
    /// The detections, if they are read.
    pub detections: Option<DetectionCounts>,
    /// The intervals in which the agreement and the shares of detections lie for other frames of
    /// this kind.
    pub intervals: ConfidenceIntervals,
}

impl AgreementEstimate {
    /// Returns the agreement over some frames. Without frames there is no agreement.
    pub(super) fn from_frames(frames: &[OutputAgreement]) -> Self {
        if frames.is_empty() {
            return Self { is_upper_bound: false, ..Self::upper_bound(0.0, 0) };
        }
        let all: OutputAgreement = frames.iter().sum();
        let share = all.share();
        let by_groups = (share - shortfall(frames)).max(0.0);
        let by_count = all
            .agreement_count()
            .map_or(1.0, |count| share_of_others(share, count_to_f64(count))[0]);
        let expected = by_groups.min(by_count);
        let (frames, detections) = (frames.len() as u64, all.detection_counts());
        let intervals = ConfidenceIntervals::new(share, detections, all.agreement_count());
        Self { frames, share, expected, is_upper_bound: false, detections, intervals }
    }

    /// Returns an upper bound: after `frames` frames no more than `share` can be reached.
    pub(super) fn upper_bound(share: f64, frames: u64) -> Self {
        let intervals = ConfidenceIntervals::default();
        Self { frames, share, expected: share, is_upper_bound: true, detections: None, intervals }
    }
}

/// Returns by how much the agreement over as many other frames may be lower, from the differences
/// between groups of frames.
fn shortfall(frames: &[OutputAgreement]) -> f64 {
    let without = |left_out: usize| {
        let in_rest = |at: usize| frame_group(at, frames.len()) != left_out;
        let rest = frames.iter().enumerate().filter(|(at, _)| in_rest(*at));
        rest.map(|(_, frame)| frame).sum::<OutputAgreement>().share()
    };
    group_margin(group_count(frames.len()), without)
}

/// The agreement of the network behind cameras, by their configurations.
#[derive(Debug, Default)]
pub(super) struct KnownAgreements {
    /// The agreement on the frames of the search.
    pub(super) searched: BTreeMap<String, AgreementEstimate>,
    /// The agreement on later frames, for cameras that agreed enough before.
    pub(super) confirmed: BTreeMap<String, AgreementEstimate>,
}

impl KnownAgreements {
    /// Returns the number of cameras.
    pub(super) fn count(&self) -> usize {
        self.searched.len()
    }

    /// Returns the exact agreement of a camera, and its agreement on later frames if it is known.
    pub(super) fn agreements_of(
        &self,
        config: &CameraConfig,
    ) -> (AgreementEstimate, Option<AgreementEstimate>) {
        let text = config.to_toml();
        (self.searched[&text], self.confirmed.get(&text).copied())
    }

    /// Returns the reasons of the network for choosing this camera; `least` is the agreement that
    /// was to be reached.
    pub(super) fn reasons(&self, chosen: &CameraConfig, least: f64) -> Vec<String> {
        self.not_confirmed(least).into_iter().chain(self.step_lines(chosen)).collect()
    }

    /// Returns a sentence with the number of cameras that later frames did not confirm.
    fn not_confirmed(&self, least: f64) -> Option<String> {
        let failed = |agreed: &&AgreementEstimate| agreed.is_upper_bound || agreed.expected < least;
        let count = self.confirmed.values().filter(failed).count();
        let all = self.confirmed.len();
        (count > 0).then(|| {
            format!(
                "later frames did not confirm {count} of {all} cameras whose agreement was sufficient before"
            )
        })
    }

    /// Returns a line for each camera that differs from the chosen one in one setting, in the order
    /// of the keys.
    fn step_lines(&self, chosen: &CameraConfig) -> Vec<String> {
        let own = settings_of_toml(&chosen.to_toml());
        let step = |(text, agreed): (&String, &AgreementEstimate)| {
            let other = settings_of_toml(text);
            let mut changed = other.iter().filter(|setting| !own.contains(setting));
            let lost = own.iter().filter(|setting| !other.contains(setting)).count();
            let setting = changed.next().filter(|_| lost <= 1 && changed.next().is_none())?;
            let bound = if agreed.is_upper_bound { "at most " } else { "" };
            let share = 100.0 * agreed.share;
            let expected = 100.0 * agreed.expected;
            let elsewhere =
                (!agreed.is_upper_bound).then(|| format!(", {expected:.1} % elsewhere"));
            let elsewhere = elsewhere.unwrap_or_default();
            Some(format!("{setting}: agreement {bound}{share:.1} %{elsewhere}"))
        };
        self.searched.iter().filter_map(step).collect()
    }
}

/// Returns the settings of a configuration, each with the names of its tables.
fn settings_of_toml(toml: &str) -> Vec<String> {
    let table: toml::Table = toml.parse().expect("a configuration is written as TOML");
    let mut found = Vec::new();
    collect_settings("", &toml::Value::Table(table), &mut found);
    found
}

fn collect_settings(name: &str, value: &toml::Value, found: &mut Vec<String>) {
    match value {
        toml::Value::Table(table) => {
            for (key, value) in table {
                let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                collect_settings(&name, value, found);
            }
        }
        toml::Value::Array(entries) => {
            entries.iter().for_each(|entry| collect_settings(name, entry, found));
        }
        value => found.push(format!("{name} = {value}")),
    }
}

/// Returns the known agreement of a camera, or calls `ask`. Without `least`, a known upper bound is
/// not enough.
pub(super) fn known_or_measured(
    known: &mut BTreeMap<String, AgreementEstimate>,
    camera: &Camera,
    least: Option<f64>,
    ask: impl FnOnce() -> Result<AgreementEstimate, ExploreError>,
) -> Result<AgreementEstimate, ExploreError> {
    let key = camera.config().to_toml();
    let enough = |agreed: &&AgreementEstimate| least.is_some() || !agreed.is_upper_bound;
    if let Some(agreed) = known.get(&key).filter(enough) {
        return Ok(*agreed);
    }
    let agreed = ask()?;
    known.insert(key, agreed);
    Ok(agreed)
}

#[cfg(test)]
mod tests {
    use super::super::test_clip::{remove_frames, write_clip};
    use super::*;
    use foveate_inference::{Framing, PixelMapping, VisionOptions};
    use foveate_media::{InputOptions, SilentHooks};
    use std::path::{Path, PathBuf};

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

    #[test]
    fn no_frames_do_not_agree() {
        let found = AgreementEstimate::from_frames(&[]);
        assert_eq!((found.frames, found.share, found.expected), (0, 0.0, 0.0));
        assert!(!found.is_upper_bound);
    }
}
