// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outputs of a network for a frame, and the detections in them.

use super::detection::Detection;
use super::detection_format::OutputTensor;
use super::detector::Detector;
use super::framing::FrameScaling;
use super::network_defaults::{NetworkDefaults, guess_defaults};
use crate::executor::Executor;
use crate::network::Network;
use foveate_pixels::Rect;

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
