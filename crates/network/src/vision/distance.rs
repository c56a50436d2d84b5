// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outputs of a network for a frame: what is found in them ([`FrameFindings`]), and their
//! distance from the right values ([`OutputDistance`]).

use super::detection::Detection;
use super::detection_format::OutputTensor;
use super::detector::Detector;
use super::framing::FrameScaling;
use super::network_defaults::{NetworkDefaults, guess_defaults};
use crate::executor::Executor;
use crate::network::Network;
use foveate_pixels::Rect;

/// Sums over values and over the right values, which are those of a reference computation.
#[derive(Clone, Copy, Debug)]
pub struct OutputDistance {
    /// The largest difference.
    pub largest: f64,
    /// The sum of the squared differences.
    squared_difference: f64,
    /// The sum of the squares of the right values.
    right_squares: f64,
    /// The sum of the squares of the found values.
    found_squares: f64,
    /// The sum of the products of the right and the found values.
    products: f64,
    /// The lowest of the right values.
    lowest: f64,
    /// The highest of the right values.
    highest: f64,
    values: u64,
}

impl Default for OutputDistance {
    fn default() -> Self {
        let [largest, difference, right, found, product] = [0.0; 5];
        let (lowest, highest) = (f64::INFINITY, f64::NEG_INFINITY);
        Self {
            largest,
            squared_difference: difference,
            right_squares: right,
            found_squares: found,
            products: product,
            lowest,
            highest,
            values: 0,
        }
    }
}

impl OutputDistance {
    /// Returns the distance of two lists of values, with true if any value differs in a bit.
    #[must_use]
    pub fn between(right: &[f32], found: &[f32]) -> (Self, bool) {
        let (mut sum, mut differs) = (Self::default(), false);
        sum.values = right.len() as u64;
        for (right, found) in right.iter().zip(found) {
            differs |= right.to_bits() != found.to_bits();
            let (right, found) = (f64::from(*right), f64::from(*found));
            let difference = (right - found).abs();
            sum.largest = sum.largest.max(difference);
            sum.squared_difference += difference * difference;
            sum.right_squares += right * right;
            sum.found_squares += found * found;
            sum.products += right * found;
            sum.lowest = sum.lowest.min(right);
            sum.highest = sum.highest.max(right);
        }
        (sum, differs)
    }

    /// Adds the distance of other values.
    pub fn add(&mut self, other: Self) {
        self.largest = self.largest.max(other.largest);
        self.squared_difference += other.squared_difference;
        self.right_squares += other.right_squares;
        self.found_squares += other.found_squares;
        self.products += other.products;
        self.lowest = self.lowest.min(other.lowest);
        self.highest = self.highest.max(other.highest);
        self.values += other.values;
    }

    /// The sum of the squared differences.
    #[must_use]
    pub fn squared_difference(&self) -> f64 {
        self.squared_difference
    }

    /// The sum of the squares of the right values.
    #[must_use]
    pub fn right_squares(&self) -> f64 {
        self.right_squares
    }

    /// The RMS of the differences as a share of the RMS of the right values; 0 if there is no
    /// difference.
    #[must_use]
    pub fn relative_rms(&self) -> f64 {
        if self.squared_difference == 0.0 {
            0.0
        } else {
            (self.squared_difference / self.right_squares).sqrt()
        }
    }

    /// The cosine of the angle between the right and the found values as vectors; 1 if there is no
    /// difference.
    #[must_use]
    pub fn cosine(&self) -> f64 {
        if self.squared_difference == 0.0 {
            1.0
        } else {
            self.products / (self.right_squares * self.found_squares).sqrt()
        }
    }

    /// The peak signal-to-noise ratio in decibels, with the range of the right values as the peak;
    /// `None` if there is no difference.
    #[must_use]
    pub fn psnr(&self) -> Option<f64> {
        #[allow(clippy::cast_precision_loss, reason = "a mean")]
        let mean = self.squared_difference / self.values.max(1) as f64;
        psnr((self.highest - self.lowest).powi(2), mean)
    }
}

/// Returns the peak signal-to-noise ratio in decibels, from the squares of the peak and of the
/// error. Both must be means, or both sums over the same values. Returns `None` if there is no
/// error.
#[must_use]
pub fn psnr(peak: f64, error: f64) -> Option<f64> {
    (error != 0.0).then(|| 10.0 * (peak / error).log10())
}

/// Returns the index of the largest value, or of the first of several equal ones.
#[must_use]
pub fn index_of_largest(values: &[f32]) -> usize {
    let mut best = 0;
    for (at, value) in values.iter().enumerate() {
        if *value > values[best] {
            best = at;
        }
    }
    best
}

/// The outputs of a network for a frame, and the detections in them.
#[derive(Clone, Debug)]
pub struct FrameFindings {
    /// The outputs of the network.
    pub outputs: Vec<OutputTensor>,
    /// The detections with at least the score that average precision needs, in descending order of
    /// score and in pixels of the frame; `None` without a detector.
    pub detections: Option<Vec<Detection>>,
}

/// Reads the outputs of a network.
#[derive(Clone, Debug)]
pub(super) struct FindingsReader {
    pub(super) detector: Option<Detector>,
    input: (usize, usize),
    frame: (u32, u32),
    /// The pixels of the frame per pixel of the input, along x and y.
    scale: (f64, f64),
}

impl FindingsReader {
    /// Returns a reader of the outputs of a network, without a detector. `lens` is the scaling from
    /// the frame to the input, if there is one.
    pub(super) fn new(
        network: &Network,
        frame: (u32, u32),
        scaling: Option<&FrameScaling>,
    ) -> Self {
        let input = (network.input().width(), network.input().height());
        Self {
            detector: None,
            input,
            frame,
            scale: scaling.map_or((1.0, 1.0), FrameScaling::scale),
        }
    }

    /// Replaces the detector, which may be `None`.
    ///
    /// # Errors
    /// Fails if the outputs do not have the format of the detector.
    pub(super) fn with_detector(
        self,
        network: &Network,
        detector: Option<Detector>,
    ) -> Result<Self, String> {
        if let Some(detector) = &detector {
            detector.format.check(&outputs_without_values(network), self.input)?;
        }
        Ok(Self { detector, ..self })
    }

    /// The number of classes of the detector, if there is one.
    pub(super) fn class_count(&self, network: &Network) -> Option<usize> {
        self.detector
            .as_ref()
            .map(|detector| detector.format.class_count(&outputs_without_values(network)))
    }

    /// Guesses the formats and the pixel mapping of the network.
    pub(super) fn guess_defaults(&self, network: &Network) -> NetworkDefaults {
        guess_defaults(&outputs_without_values(network), self.input)
    }

    /// Reads the outputs that an executor has computed.
    pub(super) fn read_findings(
        &self,
        network: &Network,
        executor: &Executor<'_>,
    ) -> FrameFindings {
        let outputs = outputs(network, |value| executor.tensor(value).real_values().into_owned());
        let in_frame = |detection: Detection| Detection {
            rect: self.rect_in_frame(&detection.rect),
            ..detection
        };
        let detections = self.detector.as_ref().map(|detector| {
            detector.read_detections(&outputs, self.input).into_iter().map(in_frame).collect()
        });
        FrameFindings { outputs, detections }
    }

    /// Scales a rectangle from the input to the frame, and clips it to the frame.
    fn rect_in_frame(&self, rect: &Rect) -> Rect {
        let ((x, y), Rect { x0, y0, x1, y1 }) = (self.scale, *rect);
        Rect { x0: x0 * x, y0: y0 * y, x1: x1 * x, y1: y1 * y }.cropped_to_frame(self.frame)
    }
}

/// Returns the outputs of a network with their shapes, but without values.
fn outputs_without_values(network: &Network) -> Vec<OutputTensor> {
    outputs(network, |_| Vec::new())
}

fn outputs(network: &Network, values: impl Fn(usize) -> Vec<f32>) -> Vec<OutputTensor> {
    let all = network.outputs().iter().zip(network.output_names());
    let output = |(&value, name): (&usize, &String)| OutputTensor {
        name: name.clone(),
        shape: network.form(value).shape().to_vec(),
        values: values(value),
    };
    all.map(output).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_are_those_of_the_books() {
        let (mut sum, differs) = OutputDistance::between(&[3.0, 0.0], &[3.0, 4.0]);
        assert!(differs);
        assert_eq!((sum.largest, sum.relative_rms()), (4.0, 4.0 / 3.0));
        assert_eq!(sum.cosine(), 9.0 / 15.0);
        assert!((sum.psnr().unwrap() - 10.0 * (9.0f64 / 8.0).log10()).abs() < 1e-12);
        // The added values lengthen the vectors and widen the range.
        sum.add(OutputDistance::between(&[-1.0], &[-1.0]).0);
        assert_eq!(sum.cosine(), 10.0 / (10.0f64 * 26.0).sqrt());
        assert!((sum.psnr().unwrap() - 10.0 * (16.0f64 * 3.0 / 16.0).log10()).abs() < 1e-12);
    }

    #[test]
    fn equal_values_are_as_close_as_can_be() {
        for values in [&[0.0, 0.0][..], &[1.0, -2.0]] {
            let (same, differs) = OutputDistance::between(values, values);
            assert!(!differs);
            assert_eq!((same.relative_rms(), same.cosine(), same.psnr()), (0.0, 1.0, None));
        }
    }
}
