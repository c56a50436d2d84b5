// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network that says whether two pictures show the same, for whoever looks for a camera that it cannot tell from whole frames.

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

/// A network, and how frames of one size are shown to it.
#[derive(Debug)]
pub struct Witness {
    network: Network,
    lens: Option<Lens>,
    mapping: Mapping,
    reader: Reader,
}

/// How a network is shown frames, and how what it says is read.
#[derive(Clone, Debug)]
pub struct Viewing {
    /// How frames get the size of the network's input.
    pub framing: Framing,
    /// How pixels become inputs.
    pub mapping: Mapping,
    /// How detections are read; without it, outputs are compared as classes or as numbers.
    pub detector: Option<Detector>,
}

/// What a network said of a frame.
#[derive(Clone, Debug)]
pub struct Testimony(Findings);

/// How much of what a network says of whole frames it says of others, too, over some frames.
#[derive(Clone, Debug, Default)]
pub struct Agreement(Sums);

/// A witness at work: it looks at the frames of one camera.
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
    /// When it cannot be read, takes frames of another size, or its outputs are not those of the detector.
    pub fn read(path: &Path, frame: (u32, u32), viewing: &Viewing) -> Result<Self, SightError> {
        Self::with(|size| Network::read(path, size), frame, viewing)
    }

    /// The same with what the file `path` holds.
    ///
    /// # Errors
    /// As [`Witness::read`].
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

    /// The same with another mapping and another detector, or none.
    ///
    /// # Errors
    /// When the mapping is for other channels, or the outputs are not those of the detector.
    pub fn viewed(self, mapping: Mapping, detector: Option<Detector>) -> Result<Self, SightError> {
        mapping.check(self.network.input().shape()[1])?;
        let reader = self.reader.with(&self.network, detector);
        let reader = reader.map_err(|problem| SightError::Detector { problem })?;
        Ok(Self { mapping, reader, ..self })
    }

    /// How many classes the detector tells apart, if there is one.
    #[must_use]
    pub fn classes(&self) -> Option<usize> {
        self.reader.classes(&self.network)
    }

    /// What the network probably wants.
    #[must_use]
    pub fn usual(&self) -> Usual {
        self.reader.usual(&self.network)
    }

    /// The network.
    #[must_use]
    pub fn network(&self) -> &Network {
        &self.network
    }

    /// Looks at frames of the size that it was read for.
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

    /// A black picture of such frames.
    #[must_use]
    pub fn picture(&self, frames: Frames) -> Picture {
        Picture::new(frames, self.network.input(), &self.mapping, self.lens.as_ref())
    }

    /// How detections are read, if they are.
    #[must_use]
    pub fn detector(&self) -> Option<&Detector> {
        self.reader.detector.as_ref()
    }

    /// What an executor of the network says.
    #[must_use]
    pub fn findings(&self, executor: &Executor<'_>) -> Findings {
        self.reader.read(&self.network, executor)
    }

    /// Which detections are the same, if they are read.
    #[must_use]
    pub fn pairs(&self, whole: &Findings, other: &Findings) -> Option<Pairs> {
        let both = whole.detections.as_ref().zip(other.detections.as_ref());
        let (detector, (whole, other)) = self.detector().zip(both)?;
        Some(Pairs::of(detector, whole, other))
    }

    /// How much of what was said of a whole frame is said of another.
    #[must_use]
    pub fn compare(&self, whole: &Testimony, other: &Testimony) -> Agreement {
        let (whole, other) = (&whole.0, &other.0);
        Agreement(Sums::of(whole, other, self.pairs(whole, other).as_ref()))
    }
}

impl Looking<'_> {
    /// What the network says of a frame.
    pub fn look(&mut self, frame: Plane<'_>) -> Testimony {
        self.run(frame);
        Testimony(self.findings())
    }

    /// Runs the network on a frame, and says how long that took.
    pub fn run(&mut self, frame: Plane<'_>) -> Duration {
        self.picture.show(frame);
        let start = Moment::now();
        self.executor.step(&self.picture.values, &self.full);
        start.elapsed()
    }

    /// What it says of the frame before.
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
    /// The agreement in one number, 0 to 1, as that of [`Sums`].
    #[must_use]
    pub fn share(&self) -> f64 {
        self.0.agreement()
    }

    /// How many things agree or do not: detections, frames or places with a class; none where outputs are compared as numbers.
    #[must_use]
    pub fn counted(&self) -> Option<u64> {
        self.0.counted()
    }

    /// Detections of all sizes, if they are read.
    #[must_use]
    pub fn found(&self) -> Option<Found> {
        self.0.found()
    }
}
