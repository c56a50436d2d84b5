// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network that measures how far its outputs for two frames agree, for the search for a camera
//! behind which it has the outputs of the input frames.

use std::path::Path;
use std::time::Duration;

use super::agreement::{Found, Pairs, Sums};
use super::detector::Detector;
use super::error::SightError;
use super::findings::{Findings, Reader};
use super::framing::{Framing, Lens};
use super::mapping::Mapping;
use super::picture::{Frames, Picture};
use super::usual::Usual;
use crate::error::NetworkError;
use crate::executor::{Executor, Mode};
use crate::mask::Mask;
use crate::moment::Moment;
use crate::network::Network;
use crate::read::FrameSize;
use foveate_frame::Plane;

/// A network with the conversion of frames of one size to its input.
#[derive(Debug)]
pub struct Witness {
    network: Network,
    lens: Option<Lens>,
    mapping: Mapping,
    reader: Reader,
}

/// The conversion of frames to the input of a network, and the reading of its outputs.
#[derive(Clone, Debug)]
pub struct Viewing {
    /// The way in which frames get the size of the network's input.
    pub framing: Framing,
    /// The conversion of pixels to input values.
    pub mapping: Mapping,
    /// The detector that reads detections. Without one, outputs are compared as classes or as
    /// numbers.
    pub detector: Option<Detector>,
}

/// The outputs of a network for a frame.
#[derive(Clone, Debug)]
pub struct Testimony(Findings);

/// The agreement of a network's outputs over some frames, such as the screen's, with those for the
/// input frames.
#[derive(Clone, Debug, Default)]
pub struct Agreement(Sums);

/// A run of a network over the frames of one camera.
#[derive(Debug)]
pub struct Looking<'a> {
    witness: &'a Witness,
    picture: Picture,
    executor: Executor<'a>,
    full: Mask,
}

impl Witness {
    /// Reads a network for frames of a size.
    ///
    /// # Errors
    /// Fails if the network cannot be read or takes frames of another size, if the mapping is for
    /// another number of channels, or if the outputs do not have the format of the detector.
    pub fn read(path: &Path, frame: (u32, u32), viewing: &Viewing) -> Result<Self, SightError> {
        Self::with(|size| Network::read(path, size), frame, viewing)
    }

    /// Reads a network as [`Witness::read`] does, from the content of the file `path`.
    ///
    /// # Errors
    /// Fails as [`Witness::read`] does.
    pub fn parse(
        bytes: &[u8],
        path: &Path,
        frame: (u32, u32),
        viewing: &Viewing,
    ) -> Result<Self, SightError> {
        Self::with(|size| Network::parse(bytes, path, size), frame, viewing)
    }

    fn with(
        read: impl FnOnce(Option<FrameSize>) -> Result<Network, NetworkError>,
        frame: (u32, u32),
        viewing: &Viewing,
    ) -> Result<Self, SightError> {
        let (network, lens) = viewing.framing.read(read, frame)?;
        let reader = Reader::new(&network, frame, lens.as_ref());
        let mapping = viewing.mapping.clone();
        Self { network, lens, mapping, reader }
            .viewed(viewing.mapping.clone(), viewing.detector.clone())
    }

    /// Replaces the mapping and the detector, which may be `None`.
    ///
    /// # Errors
    /// Fails if the mapping is for another number of channels, or if the outputs do not have the
    /// format of the detector.
    pub fn viewed(self, mapping: Mapping, detector: Option<Detector>) -> Result<Self, SightError> {
        mapping.check(self.network.input().shape()[1])?;
        let reader = self.reader.with(&self.network, detector);
        let reader = reader.map_err(|problem| SightError::Detector { problem })?;
        Ok(Self { mapping, reader, ..self })
    }

    /// The number of classes of the detector, if there is one.
    #[must_use]
    pub fn classes(&self) -> Option<usize> {
        self.reader.classes(&self.network)
    }

    /// Guesses the formats and the pixel mapping of the network.
    #[must_use]
    pub fn usual(&self) -> Usual {
        self.reader.usual(&self.network)
    }

    /// The network.
    #[must_use]
    pub fn network(&self) -> &Network {
        &self.network
    }

    /// Starts a run over frames of the size for which the network was read.
    #[must_use]
    pub fn look_at(&self, frames: Frames) -> Looking<'_> {
        let input = self.network.input();
        Looking {
            witness: self,
            picture: self.picture(frames),
            executor: Executor::new(&self.network, Mode::Dense),
            full: Mask::full(input.height(), input.width()),
        }
    }

    /// Returns the input for a black frame of this format.
    #[must_use]
    pub fn picture(&self, frames: Frames) -> Picture {
        Picture::new(frames, self.network.input(), &self.mapping, self.lens.as_ref())
    }

    /// The detector, if there is one.
    #[must_use]
    pub fn detector(&self) -> Option<&Detector> {
        self.reader.detector.as_ref()
    }

    /// Reads the outputs that an executor of the network has computed.
    #[must_use]
    pub fn findings(&self, executor: &Executor<'_>) -> Findings {
        self.reader.read(&self.network, executor)
    }

    /// Matches the detections of two frames, if detections are read.
    #[must_use]
    pub fn pairs(&self, whole: &Findings, other: &Findings) -> Option<Pairs> {
        let both = whole.detections.as_ref().zip(other.detections.as_ref());
        let (detector, (whole, other)) = self.detector().zip(both)?;
        Some(Pairs::of(detector, whole, other))
    }

    /// Returns the agreement of the outputs for another frame with those for the input frame.
    #[must_use]
    pub fn compare(&self, whole: &Testimony, other: &Testimony) -> Agreement {
        let (whole, other) = (&whole.0, &other.0);
        Agreement(Sums::of(whole, other, self.pairs(whole, other).as_ref()))
    }
}

impl Looking<'_> {
    /// Runs the network on a frame, and returns its outputs.
    pub fn look(&mut self, frame: Plane<'_>) -> Testimony {
        self.run(frame);
        Testimony(self.findings())
    }

    /// Runs the network on a frame, and returns the time that the computation took.
    pub fn run(&mut self, frame: Plane<'_>) -> Duration {
        self.picture.show(frame);
        let start = Moment::now();
        self.executor.step(&self.picture.values, &self.full);
        start.elapsed()
    }

    /// The outputs for the last frame.
    #[must_use]
    pub fn findings(&self) -> Findings {
        self.witness.findings(&self.executor)
    }
}

impl<'a> std::iter::Sum<&'a Agreement> for Agreement {
    fn sum<I: Iterator<Item = &'a Self>>(frames: I) -> Self {
        let mut sum = Self::default();
        frames.for_each(|frame| sum.0.add(&frame.0));
        sum
    }
}

impl Agreement {
    /// The agreement as one number from 0 to 1, as [`Sums::agreement`] defines it.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.0.agreement()
    }

    /// The number of detections, frames or positions that can agree; `None` if outputs are compared
    /// as numbers.
    #[must_use]
    pub fn counted(&self) -> Option<u64> {
        self.0.counted()
    }

    /// The counts of detections of all sizes, if detections are read.
    #[must_use]
    pub fn found(&self) -> Option<Found> {
        self.0.found()
    }
}
