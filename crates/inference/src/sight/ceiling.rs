// SPDX-License-Identifier: MIT OR Apache-2.0
//! The agreement of a network with itself when whole frames have noise on them: no camera can be asked for more.

use super::interval::ConfidenceIntervals;
use super::noise::GaussianNoise;
use foveate_network::sight::{Findings, Found, Looking, Sums, Witness};
use serde::Serialize;

/// Standard deviations of the noise in grey levels of 8 bits, where nobody says others.
pub const NOISE_LEVELS: [f64; 3] = [1.0, 2.0, 4.0];
/// The most frames that noise is put on, which bounds what it costs.
const MOST: usize = 48;

/// The findings of the network on whole frames with noise, compared with those on the same frames without.
#[derive(Clone, Debug, Serialize)]
pub struct NoiseAgreement {
    /// Standard deviation of the noise, in grey levels of 8 bits.
    pub levels: f64,
    /// Frames that were looked at, spread evenly.
    pub frames: u64,
    /// The agreement in one number, 0 to 1, as that behind a camera.
    pub agreement: f64,
    /// Root of the mean squared difference of the outputs, as a share of that of their values.
    pub relative_rms: f64,
    /// Detections of all sizes, if they are read.
    pub detections: Option<Found>,
    /// Share of the detections in whole frames that are found under noise, too.
    pub kept_share: Option<f64>,
    /// Share of the detections under noise that are in whole frames, too.
    pub precision: Option<f64>,
    /// Intervals in which these shares lie for other frames of this kind.
    pub intervals: ConfidenceIntervals,
}

/// Puts noise on some of the frames that it is shown, and has the network look at these.
#[derive(Clone, Debug)]
pub struct NoiseCeiling {
    levels: Vec<(f64, GaussianNoise)>,
    /// Frames that it was shown, of which one of so many is looked at.
    shown: u64,
    every: u64,
    /// The frames that were looked at, by their place among those shown: the sums of every level.
    looked: Vec<(u64, Vec<Sums>)>,
    noisy: Vec<u16>,
}

impl NoiseCeiling {
    /// For standard deviations in grey levels of 8 bits, each above 0, and frames of any depth.
    #[must_use]
    pub fn new(levels: &[f64], pixel_max: u32) -> Self {
        let level = |&level: &f64| (level, GaussianNoise::new(level, pixel_max));
        let levels = levels.iter().map(level).collect();
        Self { levels, shown: 0, every: 1, looked: Vec::new(), noisy: Vec::new() }
    }

    /// Shows it a whole frame, the `number`th of the `clip`th clip, which the network has looked at with these findings. Every frame has a noise of
    /// its own, larger at larger levels.
    pub fn look(
        &mut self,
        (witness, looking): (&Witness, &mut Looking<'_>),
        (frame, whole): (&[u16], &Findings),
        (clip, number): (u64, u64),
    ) {
        let place = self.shown;
        self.shown += 1;
        if self.levels.is_empty() || !place.is_multiple_of(self.every) {
            return;
        }
        let seed = (clip << 40) ^ number;
        let mut sums = Vec::new();
        for (_, noise) in &self.levels {
            noise.add(frame, seed, &mut self.noisy);
            looking.run(foveate_frame::Plane::Words(&self.noisy));
            let found = looking.findings();
            sums.push(Sums::of(whole, &found, witness.pairs(whole, &found).as_ref()));
        }
        self.looked.push((place, sums));
        if self.looked.len() > MOST {
            self.every *= 2;
            self.looked.retain(|(place, _)| place.is_multiple_of(self.every));
        }
    }

    /// The results, level by level; none if no frame was looked at.
    #[must_use]
    pub fn found(&self) -> Vec<NoiseAgreement> {
        let level = |(at, &(levels, _)): (usize, &(f64, GaussianNoise))| {
            let mut all = Sums::default();
            self.looked.iter().for_each(|(_, sums)| all.add(&sums[at]));
            noisy(levels, &all)
        };
        if self.looked.is_empty() {
            return Vec::new();
        }
        self.levels.iter().enumerate().map(level).collect()
    }
}

fn noisy(levels: f64, sums: &Sums) -> NoiseAgreement {
    let (agreement, detections) = (sums.agreement(), sums.found());
    NoiseAgreement {
        levels,
        frames: sums.frames,
        agreement,
        relative_rms: sums.distance.relative(),
        detections,
        kept_share: detections.map(|found| found.kept_share()),
        precision: detections.map(|found| found.precision()),
        intervals: ConfidenceIntervals::of(sums),
    }
}
