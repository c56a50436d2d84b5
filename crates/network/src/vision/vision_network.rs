// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network that measures how far its outputs for two frames agree. The search for a camera uses
//! it to find one whose screen gives the outputs of the input frames.

use std::path::Path;
use std::time::Duration;

use super::agreement::{AgreementSums, DetectionCounts, DetectionPairs};
use super::detector::Detector;
use super::error::VisionError;
use super::frame_findings::{FindingsReader, FrameFindings};
use super::frame_input::{FrameFormat, FrameInput, PixelMapping};
use super::framing::{FrameScaling, Framing};
use super::network_defaults::NetworkDefaults;
use crate::error::NetworkError;
use crate::executor::{ExecutionMode, Executor};
use crate::mask::Mask;
use crate::network::Network;
use crate::optional_instant::OptionalInstant;
use crate::reader::{FrameSize, OpenFile};
use foveate_pixels::FramePixels;

/// A network with the conversion of frames of one size to its input.
#[derive(Debug)]
pub struct VisionNetwork {
    network: Network,
    scaling: Option<FrameScaling>,
    mapping: PixelMapping,
    reader: FindingsReader,
}

/// The conversion of frames to the input of a network, and the reading of its outputs.
#[derive(Clone, Debug)]
pub struct VisionOptions {
    /// The way in which frames get the size of the network's input.
    pub framing: Framing,
    /// The conversion of pixels to input values.
    pub mapping: PixelMapping,
    /// The detector that reads detections. Without one, outputs are compared as classes or as
    /// numbers.
    pub detector: Option<Detector>,
}

/// The outputs of a network for a frame.
#[derive(Clone, Debug)]
pub struct FrameOutcome(FrameFindings);

/// The agreement of a network's outputs over some frames, such as the screen's, with those for the
/// input frames.
#[derive(Clone, Debug, Default)]
pub struct OutputAgreement(AgreementSums);

/// A run of a network over the frames of one camera.
#[derive(Debug)]
pub struct VisionRun<'a> {
    vision_network: &'a VisionNetwork,
    picture: FrameInput,
    executor: Executor<'a>,
    full: Mask,
}

impl VisionNetwork {
    /// Reads a network for frames of a size.
    ///
    /// # Errors
    /// Fails if the network cannot be read or takes frames of another size, if the mapping is for
    /// another number of channels, or if the outputs do not have the format of the detector.
    pub fn read(
        path: &Path,
        open: OpenFile,
        frame: (u32, u32),
        vision_options: &VisionOptions,
    ) -> Result<Self, VisionError> {
        Self::read_with(|size| Network::read(path, open, size), frame, vision_options)
    }

    /// Reads a network as [`VisionNetwork::read`] does, from the content of the file `path`.
    ///
    /// # Errors
    /// Fails as [`VisionNetwork::read`] does.
    pub fn parse(
        bytes: &[u8],
        path: &Path,
        frame: (u32, u32),
        vision_options: &VisionOptions,
    ) -> Result<Self, VisionError> {
        Self::read_with(|size| Network::parse(bytes, path, size), frame, vision_options)
    }

    fn read_with(
        read: impl FnOnce(Option<FrameSize>) -> Result<Network, NetworkError>,
        frame: (u32, u32),
        vision_options: &VisionOptions,
    ) -> Result<Self, VisionError> {
        let (network, scaling) = vision_options.framing.read_network(read, frame)?;
        let reader = FindingsReader::new(&network, frame, scaling.as_ref());
        let mapping = vision_options.mapping.clone();
        Self { network, scaling, mapping, reader }.with_mapping_and_detector(
            vision_options.mapping.clone(),
            vision_options.detector.clone(),
        )
    }

    /// Replaces the mapping and the detector, which may be `None`.
    ///
    /// # Errors
    /// Fails if the mapping is for another number of channels, or if the outputs do not have the
    /// format of the detector.
    pub fn with_mapping_and_detector(
        self,
        mapping: PixelMapping,
        detector: Option<Detector>,
    ) -> Result<Self, VisionError> {
        mapping.check(self.network.input().shape()[1])?;
        let reader = self.reader.with_detector(&self.network, detector);
        let reader = reader.map_err(|problem| VisionError::DetectorFormat { problem })?;
        Ok(Self { mapping, reader, ..self })
    }

    /// The number of classes of the detector, if there is one.
    #[must_use]
    pub fn class_count(&self) -> Option<usize> {
        self.reader.class_count(&self.network)
    }

    /// Guesses the formats and the pixel mapping of the network.
    #[must_use]
    pub fn guess_defaults(&self) -> NetworkDefaults {
        self.reader.guess_defaults(&self.network)
    }

    /// The network.
    #[must_use]
    pub fn network(&self) -> &Network {
        &self.network
    }

    /// Starts a run over frames of the size for which the network was read.
    #[must_use]
    pub fn start_run(&self, frames: FrameFormat) -> VisionRun<'_> {
        let input = self.network.input();
        VisionRun {
            vision_network: self,
            picture: self.black_input(frames),
            executor: Executor::new(&self.network, ExecutionMode::Dense),
            full: Mask::full(input.height(), input.width()),
        }
    }

    /// Returns the input for a black frame of this format.
    #[must_use]
    pub fn black_input(&self, frames: FrameFormat) -> FrameInput {
        FrameInput::new(frames, self.network.input(), &self.mapping, self.scaling.as_ref())
    }

    /// The detector, if there is one.
    #[must_use]
    pub fn detector(&self) -> Option<&Detector> {
        self.reader.detector.as_ref()
    }

    /// Reads the outputs that an executor of the network has computed.
    #[must_use]
    pub fn findings(&self, executor: &Executor<'_>) -> FrameFindings {
        self.reader.read_findings(&self.network, executor)
    }

    /// Matches the detections of two frames, if detections are read.
    #[must_use]
    pub fn match_detections(
        &self,
        whole: &FrameFindings,
        other: &FrameFindings,
    ) -> Option<DetectionPairs> {
        let both = whole.detections.as_ref().zip(other.detections.as_ref());
        let (detector, (whole, other)) = self.detector().zip(both)?;
        Some(DetectionPairs::from_detections(detector, whole, other))
    }

    /// Returns the agreement of the outputs for another frame with those for the input frame.
    #[must_use]
    pub fn compare(&self, whole: &FrameOutcome, other: &FrameOutcome) -> OutputAgreement {
        let (whole, other) = (&whole.0, &other.0);
        OutputAgreement(AgreementSums::from_frame(
            whole,
            other,
            self.match_detections(whole, other).as_ref(),
        ))
    }
}

impl VisionRun<'_> {
    /// Runs the network on a frame, and returns its outputs.
    pub fn outcome(&mut self, frame: FramePixels<'_>) -> FrameOutcome {
        self.run(frame);
        FrameOutcome(self.findings())
    }

    /// Runs the network on a frame, and returns the time that the computation took.
    pub fn run(&mut self, frame: FramePixels<'_>) -> Duration {
        self.picture.set_frame(frame);
        let start = OptionalInstant::now();
        self.executor.step(&self.picture.values, &self.full);
        start.elapsed()
    }

    /// The outputs for the last frame.
    #[must_use]
    pub fn findings(&self) -> FrameFindings {
        self.vision_network.findings(&self.executor)
    }
}

impl<'a> std::iter::Sum<&'a OutputAgreement> for OutputAgreement {
    fn sum<I: Iterator<Item = &'a Self>>(frames: I) -> Self {
        let mut sum = Self::default();
        frames.for_each(|frame| sum.0.add(&frame.0));
        sum
    }
}

impl OutputAgreement {
    /// The agreement as one number from 0 to 1, as [`AgreementSums::agreement`] defines it.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.0.agreement()
    }

    /// The number of detections, frames or positions that can agree; `None` if outputs are compared
    /// as numbers.
    #[must_use]
    pub fn agreement_count(&self) -> Option<u64> {
        self.0.agreement_count()
    }

    /// The counts of detections of all sizes, if detections are read.
    #[must_use]
    pub fn detection_counts(&self) -> Option<DetectionCounts> {
        self.0.total_counts()
    }
}
