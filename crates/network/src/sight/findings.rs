// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a network says of a frame.

use super::detection::Detection;
use super::detector::Detector;
use super::framing::Lens;
use super::head::Output;
use super::usual::{Usual, usual};
use crate::executor::Executor;
use crate::network::Network;
use foveate_frame::Rect;

/// What a network says of a frame.
#[derive(Clone, Debug)]
pub struct Findings {
    /// Its outputs.
    pub outputs: Vec<Output>,
    /// What is found with at least the score that average precision needs, the surest first, in pixels of the frame; nothing without a detector.
    pub detections: Option<Vec<Detection>>,
}

/// Reads outputs.
#[derive(Clone, Debug)]
pub(super) struct Reader {
    pub(super) detector: Option<Detector>,
    input: (usize, usize),
    frame: (u32, u32),
    /// Pixels of the frame per pixel of the input.
    scale: (f64, f64),
}

impl Reader {
    /// For the outputs of a network, to which a lens may lead; without a detector.
    pub(super) fn new(network: &Network, frame: (u32, u32), lens: Option<&Lens>) -> Self {
        let input = (network.input().width(), network.input().height());
        Self { detector: None, input, frame, scale: lens.map_or((1.0, 1.0), Lens::scale) }
    }

    /// The same with another detector, or none.
    ///
    /// # Errors
    /// When the outputs have another format than the detector's.
    pub(super) fn with(
        self,
        network: &Network,
        detector: Option<Detector>,
    ) -> Result<Self, String> {
        if let Some(detector) = &detector {
            detector.head.check(&shapes(network), self.input)?;
        }
        Ok(Self { detector, ..self })
    }

    /// How many classes the detector tells apart, if there is one.
    pub(super) fn classes(&self, network: &Network) -> Option<usize> {
        self.detector.as_ref().map(|detector| detector.head.classes(&shapes(network)))
    }

    /// What the network probably wants.
    pub(super) fn usual(&self, network: &Network) -> Usual {
        usual(&shapes(network), self.input)
    }

    /// What the executor has found.
    pub(super) fn read(&self, network: &Network, executor: &Executor<'_>) -> Findings {
        let outputs = outputs(network, |value| executor.value(value).reals().into_owned());
        let placed = |one: Detection| Detection { rect: self.place(&one.rect), ..one };
        let detections = self
            .detector
            .as_ref()
            .map(|detector| detector.read(&outputs, self.input).into_iter().map(placed).collect());
        Findings { outputs, detections }
    }

    /// A rectangle in the frame, without what lies outside of it.
    fn place(&self, rect: &Rect) -> Rect {
        let ((x, y), Rect { x0, y0, x1, y1 }) = (self.scale, *rect);
        Rect { x0: x0 * x, y0: y0 * y, x1: x1 * x, y1: y1 * y }.within(self.frame)
    }
}

/// The outputs of a network without values.
fn shapes(network: &Network) -> Vec<Output> {
    outputs(network, |_| Vec::new())
}

fn outputs(network: &Network, values: impl Fn(usize) -> Vec<f32>) -> Vec<Output> {
    let all = network.outputs().iter().zip(network.output_names());
    let output = |(&value, name): (&usize, &String)| Output {
        name: name.clone(),
        shape: network.form(value).shape().to_vec(),
        values: values(value),
    };
    all.map(output).collect()
}
