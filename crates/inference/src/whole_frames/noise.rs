// SPDX-License-Identifier: MIT OR Apache-2.0
//! The agreement of a network with itself when whole frames get noise ([`NoiseComparison`]): an
//! upper bound for the agreement behind a camera.
//!
//! The noise is Gaussian ([`GaussianNoise`]), and the same on every machine and with any number
//! of threads. A pixel becomes the nearest grey level to itself plus a normal variable, clamped
//! to black and white. The step of a pixel is drawn from the exact probabilities of all steps
//! with the bits of `fastrand` (wyrand), seeded by the number of the frame.

use super::precision::ConfidenceIntervals;
use fastrand::Rng;
use foveate_network::vision::{
    AgreementSums, DetectionCounts, FrameFindings, VisionNetwork, VisionRun,
};
use serde::Serialize;
use std::f64::consts::SQRT_2;

/// The number of standard deviations beyond which a normal variable lies with a probability below
/// 2^-32.
const MAX_DEVIATIONS: f64 = 6.4;
/// The number of possible draws.
const DRAW_COUNT: f64 = 4_294_967_296.0;
/// The largest pixel of 8 bits; the deviation of noise is given in levels of 8 bits.
const LARGEST_OF_8_BITS: f64 = 255.0;

/// Noise of one standard deviation on frames of one depth.
#[derive(Clone, Debug)]
pub struct GaussianNoise {
    /// The largest step down of a pixel, in grey levels.
    largest_step_down: i64,
    /// The end of the range of draws of every step but the last, from the largest step down.
    step_ends: Vec<u32>,
    max: u16,
}

impl GaussianNoise {
    /// Creates noise with a standard deviation in grey levels of 8 bits, above 0.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "draws are below 2^32, and steps no larger than pixels of 16 bits"
    )]
    #[must_use]
    pub fn new(deviation: f64, pixel_max: u32) -> Self {
        let max = u16::try_from(pixel_max).unwrap_or(u16::MAX);
        let deviation = deviation * f64::from(max) / LARGEST_OF_8_BITS;
        let reach = (MAX_DEVIATIONS * deviation).ceil().min(f64::from(max)) as i32;
        let below = |step: i32| {
            let end = (f64::from(step) + 0.5) / deviation;
            (DRAW_COUNT * 0.5 * libm::erfc(-end / SQRT_2)) as u32
        };
        Self {
            largest_step_down: reach.into(),
            step_ends: (-reach..reach).map(below).collect(),
            max,
        }
    }

    /// Writes the frame with noise to `noisy`, in place of its content. A seed gives one noise.
    pub fn add(&self, frame: &[u16], seed: u64, noisy: &mut Vec<u16>) {
        let mut chance = Rng::with_seed(seed);
        noisy.clear();
        noisy.extend(frame.iter().map(|&pixel| self.noisy_pixel(pixel, chance.u32(..))));
    }

    fn noisy_pixel(&self, pixel: u16, draw: u32) -> u16 {
        #[allow(clippy::cast_possible_wrap, reason = "a place among the steps of pixels")]
        let step =
            self.step_ends.partition_point(|&end| end <= draw) as i64 - self.largest_step_down;
        let level = (i64::from(pixel) + step).clamp(0, i64::from(self.max));
        u16::try_from(level).expect("a level between black and white is a pixel")
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    fn noisy(deviation: f64, max: u32, frame: &[u16], seed: u64) -> Vec<u16> {
        let mut noisy = Vec::new();
        GaussianNoise::new(deviation, max).add(frame, seed, &mut noisy);
        noisy
    }

    /// Returns the mean and the standard deviation of the noise on a grey frame.
    fn measured(deviation: f64, max: u16) -> (f64, f64) {
        let grey = vec![max / 2; 1 << 20];
        let noisy = noisy(deviation, max.into(), &grey, 7);
        let added: Vec<f64> =
            noisy.iter().map(|&pixel| f64::from(pixel) - f64::from(max / 2)).collect();
        #[allow(clippy::cast_precision_loss, reason = "a mean")]
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let squares: Vec<f64> = added.iter().map(|value| value * value).collect();
        (mean(&added), (mean(&squares) - mean(&added).powi(2)).sqrt())
    }

    /// Rounding to whole levels adds 1/12, the variance of a uniform distribution over one level.
    #[test]
    fn noise_has_the_deviation_that_was_asked_at_every_depth() {
        for (deviation, max) in
            [(1.0, 255), (2.0, 255), (4.0, 255), (4.0, 127), (2.0, 1023), (1.0, 65535)]
        {
            let levels = deviation * f64::from(max) / 255.0;
            let (mean, found) = measured(deviation, max);
            let wanted = (levels * levels + 1.0 / 12.0).sqrt();
            assert!(mean.abs() < 0.005 * levels, "{deviation} of {max}: mean {mean}");
            assert!((found / wanted - 1.0).abs() < 0.005, "{deviation} of {max}: {found}");
        }
    }

    /// The expected shares are those of a normal variable between halves of levels: 0.382925,
    /// 0.241730, 0.060598 and 0.005977 for 0, 1, 2 and 3 at a deviation of 1 (differences of
    /// scipy.stats.norm.cdf).
    #[test]
    fn steps_are_as_frequent_as_those_of_a_normal_variable() {
        let noisy = noisy(1.0, 255, &vec![100; 1 << 20], 3);
        for (step, share) in [(0_i32, 0.382_925), (1, 0.241_730), (-2, 0.060_598), (3, 0.005_977)] {
            let found = noisy.iter().filter(|&&pixel| i32::from(pixel) == 100 + step).count();
            let wanted = share * f64::from(1 << 20);
            #[allow(clippy::cast_precision_loss, reason = "a count")]
            let away = (found as f64 - wanted) / wanted.sqrt();
            assert!(away.abs() < 4.0, "{step}: {found}, not {wanted}");
        }
    }

    /// A seed gives the same noise on all machines, and other seeds give other noise. The expected
    /// pixels are computed from wyrand's bits with `scipy.stats.norm.ppf`.
    #[test]
    fn a_seed_is_one_noise() {
        let grey = [100; 12];
        assert_ne!(noisy(4.0, 255, &grey, 1), noisy(4.0, 255, &grey, 2));
        assert_eq!(
            noisy(4.0, 255, &grey, 1),
            [102, 102, 107, 98, 96, 98, 105, 99, 103, 100, 98, 102]
        );
    }

    #[test]
    fn noise_stays_between_black_and_white() {
        for max in [1, 255, 65535_u16] {
            for deviation in [1e-300, 0.01, 4.0, 255.0] {
                let frame: Vec<u16> = [0, max].repeat(500);
                let noisy = noisy(deviation, max.into(), &frame, 5);
                assert!(noisy.iter().all(|&pixel| pixel <= max));
                let is_seen = deviation * f64::from(max) > 0.1 * 255.0;
                assert_eq!(noisy != frame, is_seen, "{deviation} of {max}");
            }
        }
    }
}
