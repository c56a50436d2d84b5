// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network that says whether two pictures show the same, for whoever looks for a camera that it cannot tell from whole frames.

use std::path::Path;
use std::time::{Duration, Instant};

use crate::framing::Lens;
use crate::picture::Picture;
use crate::sight::{Detector, Findings, Found, Pairs, Reader, Sums};
use crate::{Framing, InferenceError, Mapping};
use foveate_design::Camera;
use foveate_frame::Plane;
use foveate_network::{Executor, Mask, Mode, Network};

/// A network, and how frames of one size are shown to it.
#[derive(Debug)]
pub struct Witness {
    pub(crate) network: Network,
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
    pub fn read(path: &Path, frame: (u32, u32), viewing: &Viewing) -> Result<Self, InferenceError> {
        let (network, lens) = viewing.framing.read(path, frame)?;
        viewing.mapping.check(network.input().shape()[1])?;
        let reader = Reader::new(&network, frame, lens.as_ref(), viewing.detector.clone())
            .map_err(|problem| InferenceError::Choice { problem })?;
        Ok(Self { network, lens, mapping: viewing.mapping.clone(), reader })
    }

    /// Looks at frames of the size and depth of a camera.
    #[must_use]
    pub fn look_at(&self, camera: &Camera) -> Looking<'_> {
        let input = self.network.input();
        Looking {
            witness: self,
            picture: self.picture(camera),
            executor: Executor::new(&self.network, Mode::Dense),
            full: Mask::full(input.height(), input.width()),
        }
    }

    /// A black picture for a camera.
    pub(crate) fn picture(&self, camera: &Camera) -> Picture {
        Picture::new(camera, self.network.input(), &self.mapping, self.lens.as_ref())
    }

    /// How detections are read, if they are.
    pub(crate) fn detector(&self) -> Option<&Detector> {
        self.reader.detector.as_ref()
    }

    /// What an executor of the network says.
    pub(crate) fn findings(&self, executor: &Executor<'_>) -> Findings {
        self.reader.read(&self.network, executor)
    }

    /// Which detections are the same, if they are read.
    pub(crate) fn pairs(&self, whole: &Findings, other: &Findings) -> Option<Pairs> {
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
    pub(crate) fn run(&mut self, frame: Plane<'_>) -> Duration {
        self.picture.show(frame);
        let start = Instant::now();
        self.executor.step(&self.picture.values, &self.full);
        start.elapsed()
    }

    /// What it says of the frame before.
    pub(crate) fn findings(&self) -> Findings {
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
    /// The agreement in one number, 0 to 1, as [`Sight::agreement`](crate::Sight::agreement).
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
