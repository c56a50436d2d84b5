// SPDX-License-Identifier: MIT OR Apache-2.0
//! The agreement of a network with itself when whole frames get noise: an upper bound for the
//! agreement behind a camera.

use super::interval::ConfidenceIntervals;
use super::noise::GaussianNoise;
use foveate_network::vision::{
    AgreementSums, DetectionCounts, FrameFindings, VisionNetwork, VisionRun,
};
use serde::Serialize;

/// The standard deviations of the noise in grey levels of 8 bits, if the user gives no others.
pub const NOISE_LEVELS: [f64; 3] = [1.0, 2.0, 4.0];
/// The largest number of frames that get noise. It bounds the time that the comparison takes.
const MAX_NOISY_FRAMES: usize = 48;

/// The agreement of the network's outputs for whole frames with noise with those for the same
/// frames without noise.
#[derive(Clone, Debug, Serialize)]
pub struct NoiseAgreement {
    /// The standard deviation of the noise in grey levels of 8 bits.
    pub levels: f64,
    /// The number of frames with noise, which are spread evenly over the run.
    pub frames: u64,
    /// The agreement in one number from 0 to 1, defined as behind a camera.
    pub agreement: f64,
    /// The root mean squared difference of the outputs, as a share of the root mean square of their
    /// values.
    pub relative_rms: f64,
    /// The detections of all sizes, if they are read.
    pub detections: Option<DetectionCounts>,
    /// The share of the detections in whole frames that are also found under noise.
    pub kept_share: Option<f64>,
    /// The share of the detections under noise that are also in whole frames.
    pub precision: Option<f64>,
    /// The intervals in which the agreement and the shares of detections lie for other frames of
    /// this kind.
    pub intervals: ConfidenceIntervals,
}

/// Adds noise to some of the frames that it gets, and runs the network on them.
#[derive(Clone, Debug)]
pub struct NoiseComparison {
    levels: Vec<(f64, GaussianNoise)>,
    /// The number of frames so far; the network runs on one of `every`.
    frames_seen: u64,
    every: u64,
    /// The sums of every level for the frames with noise, each with the number of the frame among
    /// all frames.
    samples: Vec<(u64, Vec<AgreementSums>)>,
    noisy_frame: Vec<u16>,
}

impl NoiseComparison {
    /// Creates the state for standard deviations in grey levels of 8 bits, each above 0, and frames
    /// with pixels up to `pixel_max`.
    #[must_use]
    pub fn new(levels: &[f64], pixel_max: u32) -> Self {
        let level = |&level: &f64| (level, GaussianNoise::new(level, pixel_max));
        let levels = levels.iter().map(level).collect();
        Self { levels, frames_seen: 0, every: 1, samples: Vec::new(), noisy_frame: Vec::new() }
    }

    /// Takes a whole frame, number `number` of clip number `clip`, with the findings of the network
    /// in it. Every frame gets its own noise, which is larger at larger levels.
    pub fn add_frame(
        &mut self,
        (vision_network, looking): (&VisionNetwork, &mut VisionRun<'_>),
        (frame, whole): (&[u16], &FrameFindings),
        (clip, number): (u64, u64),
    ) {
        let place = self.frames_seen;
        self.frames_seen += 1;
        if self.levels.is_empty() || !place.is_multiple_of(self.every) {
            return;
        }
        let seed = (clip << 40) ^ number;
        let mut sums = Vec::new();
        for (_, noise) in &self.levels {
            noise.add(frame, seed, &mut self.noisy_frame);
            looking.run(foveate_pixels::FramePixels::Words(&self.noisy_frame));
            let found = looking.findings();
            sums.push(AgreementSums::from_frame(
                whole,
                &found,
                vision_network.match_detections(whole, &found).as_ref(),
            ));
        }
        self.samples.push((place, sums));
        if self.samples.len() > MAX_NOISY_FRAMES {
            self.every *= 2;
            self.samples.retain(|(place, _)| place.is_multiple_of(self.every));
        }
    }

    /// Returns the results, level by level; empty if no frame got noise.
    #[must_use]
    pub fn results(&self) -> Vec<NoiseAgreement> {
        let level = |(at, &(levels, _)): (usize, &(f64, GaussianNoise))| {
            let mut all = AgreementSums::default();
            self.samples.iter().for_each(|(_, sums)| all.add(&sums[at]));
            noise_agreement(levels, &all)
        };
        if self.samples.is_empty() {
            return Vec::new();
        }
        self.levels.iter().enumerate().map(level).collect()
    }
}

fn noise_agreement(levels: f64, sums: &AgreementSums) -> NoiseAgreement {
    let (agreement, detections) = (sums.agreement(), sums.total_counts());
    NoiseAgreement {
        levels,
        frames: sums.frames,
        agreement,
        relative_rms: sums.distance.relative_rms(),
        detections,
        kept_share: detections.map(|found| found.kept_share()),
        precision: detections.map(|found| found.precision()),
        intervals: ConfidenceIntervals::from_sums(sums),
    }
}
