// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network that is not to tell what the receiver sees from whole frames.
//!
//! What it says of whole frames is found once, of some frames of every half, spread evenly. A camera is dropped as soon as it cannot reach the wanted
//! agreement any more, even if it agreed on all other frames.

use std::ops::Range;
use std::path::Path;

use foveate_camera::{Camera, CameraConfig};
use foveate_engine::Engine;
use foveate_footage::Kind;
use foveate_frame::Raster;
use foveate_inference::{Agreement, Found, Testimony, Viewing, Witness};
use rayon::prelude::*;
use serde::Serialize;

use super::held_out::Halves;
use super::looks::Look;
use crate::footage::Footage;
use crate::measure::{at_depth, at_depths};
use crate::row::real;
use crate::{ExploreError, Progress};

/// A network that is not to tell what the receiver sees from whole frames.
#[derive(Clone, Copy, Debug)]
pub struct NetworkGoal<'a> {
    /// Its file.
    pub path: &'a Path,
    /// How it is read and shown frames.
    pub viewing: &'a Viewing,
    /// The least agreement, 0..=1, as of `foveate infer --whole-frames`.
    pub min_agreement: f64,
    /// What the design is to be cheapest in.
    pub cheapest: Cheapest,
    /// The most frames of each half of all clips that the network looks at.
    pub frames: u64,
}

/// What designs are compared by that a network cannot tell from whole frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Cheapest {
    /// Bytes that leave the camera; of cameras with as many, area.
    Bytes,
    /// Area.
    Area,
}

/// How much of what the network says of whole frames it says behind a camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Agreed {
    /// Frames that it looked at.
    pub frames: u64,
    /// The agreement, 0..=1.
    pub share: f64,
    /// Whether the agreement is at most this: the rest was not looked at.
    #[serde(skip)]
    pub at_most: bool,
    /// Detections, if they are read.
    pub detections: Option<Found>,
}

/// What a network says of the design, beside what it says of whole frames.
#[derive(Clone, Debug, Serialize)]
pub struct FittedNetwork {
    /// Its file.
    pub network: String,
    /// How detections are read, if they are.
    pub detector: Option<String>,
    /// The least agreement that was wanted, 0..=1.
    pub min_agreement: f64,
    /// What the design was to be cheapest in.
    pub cheapest: Cheapest,
    /// On the first half, on which it was fitted.
    pub fitted: Agreed,
    /// On the second half, which influenced no choice.
    pub held_out: Agreed,
    /// Bytes of a whole frame.
    pub bytes_per_whole_frame: f64,
}

/// A half of every clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Half {
    First,
    Second,
}

/// A frame that the network looks at, and what it says of it.
struct Sample {
    number: u64,
    whole: Testimony,
    /// That of a camera which shows whole frames.
    best: Agreement,
}

/// The network, and what it says of whole frames.
pub(super) struct Jury<'a> {
    witness: Witness,
    pub(super) goal: NetworkGoal<'a>,
    footage: &'a Footage<'a>,
    halves: &'a Halves,
    /// Of every clip, by halves.
    samples: [Vec<Vec<Sample>>; 2],
}

impl<'a> Jury<'a> {
    /// Shows the network whole frames of the depth of the task.
    pub(super) fn new(
        goal: NetworkGoal<'a>,
        footage: &'a Footage<'a>,
        halves: &'a Halves,
        task: &CameraConfig,
    ) -> Result<Self, ExploreError> {
        let witness = Witness::read(goal.path, footage.size, goal.viewing)?;
        let camera = task.validate()?;
        let clips = halves.frames.len() as u64;
        let most = (goal.frames / clips).max(1);
        let mut samples = [Vec::new(), Vec::new()];
        for (clip, &(half, all)) in halves.frames.iter().enumerate() {
            // The first frame of a clip is one that every camera sends whole.
            let wanted = [spread(1..half, most), spread(half..all, most)];
            let mut looking = witness.look_at(&camera);
            let mut source = footage.open(&footage.subjects[clip])?;
            let mut found = [Vec::new(), Vec::new()];
            for number in 0..all {
                footage.go_on(Progress::Asking { cameras: 0 })?;
                let Some(current) = source.next_frame()? else { break };
                for (found, wanted) in found.iter_mut().zip(&wanted) {
                    if wanted.contains(&number) {
                        let whole = looking.look(current.frame.plane());
                        let best = witness.compare(&whole, &whole);
                        found.push(Sample { number, whole, best });
                    }
                }
                source.give_back(current);
            }
            let [first, second] = found;
            samples[0].push(first);
            samples[1].push(second);
        }
        Ok(Self { witness, goal, footage, halves, samples })
    }

    /// Bytes per frame that cameras send on the first halves; `asked` cameras were shown to the network so far.
    pub(super) fn bytes_sent(
        &self,
        cameras: &[Camera],
        asked: usize,
    ) -> Result<Vec<f64>, ExploreError> {
        let (mut values, mut frames) = (vec![0; cameras.len()], 0);
        for (subject, &(half, _)) in self.footage.subjects.iter().zip(&self.halves.frames) {
            let mut engines: Vec<Engine> = cameras.iter().map(Engine::new).collect();
            let mut source = self.footage.open(subject)?;
            for _ in 0..half {
                self.footage.go_on(Progress::Asking { cameras: asked })?;
                let Some(current) = source.next_frame()? else { break };
                let is_set = source.kind() == Kind::Set;
                let depths = at_depths(&current.frame, cameras.iter().map(|one| one.pixel_bits()))?;
                engines.par_iter_mut().zip(&mut values).try_for_each(|(engine, values)| {
                    if is_set {
                        engine.reset();
                    }
                    let bits = engine.camera().pixel_bits();
                    engine.step_raster(depths.get(&bits).unwrap_or(&current.frame))?;
                    *values += engine.camera().values_of(&engine.outcome().actions);
                    Ok::<_, ExploreError>(())
                })?;
                frames += 1;
                source.give_back(current);
            }
        }
        let bytes = |(camera, values): (&Camera, &u64)| {
            real(camera.bits_sent(frames, *values)) / 8.0 / real(frames.max(1))
        };
        Ok(cameras.iter().zip(&values).map(bytes).collect())
    }

    /// What the network says of the camera that was chosen, on both halves.
    pub(super) fn report(&self, look: &Look) -> Result<FittedNetwork, ExploreError> {
        let camera = look.config.validate()?;
        let ask = |half| self.ask(&camera, half, None, 0);
        let of_pixels = f64::from(camera.width()) * f64::from(camera.height());
        let whole = of_pixels * f64::from(self.footage.bits()) / 8.0;
        Ok(FittedNetwork {
            network: self.goal.path.display().to_string(),
            detector: self.goal.viewing.detector.as_ref().map(ToString::to_string),
            min_agreement: self.goal.min_agreement,
            cheapest: self.goal.cheapest,
            fitted: ask(Half::First)?,
            held_out: ask(Half::Second)?,
            bytes_per_whole_frame: whole,
        })
    }

    /// The agreement on a half; `asked` cameras were looked at before. With `least` it looks no further than to know that it is missed.
    pub(super) fn ask(
        &self,
        camera: &Camera,
        half: Half,
        least: Option<f64>,
        asked: usize,
    ) -> Result<Agreed, ExploreError> {
        let samples = &self.samples[half as usize];
        let (mut sum, mut frames) = (Agreement::default(), 0);
        for (clip, own) in samples.iter().enumerate() {
            let Some(last) = own.last().map(|sample| sample.number) else { continue };
            let mut looking = self.witness.look_at(camera);
            let mut engine = Engine::new(camera);
            let mut source = self.footage.open(&self.footage.subjects[clip])?;
            for number in 0..=last {
                self.footage.go_on(Progress::Asking { cameras: asked })?;
                let Some(current) = source.next_frame()? else { break };
                if source.kind() == Kind::Set {
                    engine.reset();
                }
                let deep: Option<Raster> = at_depth(&current.frame, camera.pixel_bits())?;
                engine.step_raster(deep.as_ref().unwrap_or(&current.frame))?;
                if let Some(sample) = own.iter().find(|sample| sample.number == number) {
                    let seen = looking.look(engine.rendered());
                    sum.add(&self.witness.compare(&sample.whole, &seen));
                    frames += 1;
                    let rest = samples[clip + 1..].iter().flatten();
                    let rest = own.iter().filter(|other| other.number > number).chain(rest);
                    let mut at_most = sum.clone();
                    rest.for_each(|sample| at_most.add(&sample.best));
                    if least.is_some_and(|least| at_most.share() < least) {
                        let (share, detections) = (at_most.share(), None);
                        return Ok(Agreed { frames, share, at_most: true, detections });
                    }
                }
                source.give_back(current);
            }
        }
        let (share, detections) = (sum.share(), sum.found());
        Ok(Agreed { frames, share, at_most: false, detections })
    }
}

/// At most so many numbers of a range, spread evenly.
fn spread(range: Range<u64>, most: u64) -> Vec<u64> {
    let length = range.end.saturating_sub(range.start);
    let count = most.min(length);
    (0..count).map(|index| range.start + (2 * index + 1) * length / (2 * count)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_spread_evenly() {
        assert_eq!(spread(1..5, 10), [1, 2, 3, 4]);
        assert_eq!(spread(0..100, 4), [12, 37, 62, 87]);
        assert_eq!(spread(50..60, 1), [55]);
        assert!(spread(1..1, 4).is_empty());
    }
}
