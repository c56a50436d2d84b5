// SPDX-License-Identifier: MIT OR Apache-2.0
//! A network that says whether two pictures show the same, for whoever looks for a camera that it cannot tell from whole frames.

use std::path::Path;

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
    network: Network,
    lens: Option<Lens>,
    mapping: Mapping,
    reader: Reader,
}

/// How a network is read and shown frames.
#[derive(Clone, Debug)]
pub struct Viewing {
    /// How frames get the size of the network's input.
    pub framing: Framing,
    /// How pixels become inputs.
    pub mapping: Mapping,
    /// How detections are read, if it makes some.
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
            picture: Picture::new(camera, input, &self.mapping, self.lens.as_ref()),
            executor: Executor::new(&self.network, Mode::Dense),
            full: Mask::full(input.height(), input.width()),
        }
    }

    /// How much of what was said of a whole frame is said of another.
    #[must_use]
    pub fn compare(&self, whole: &Testimony, other: &Testimony) -> Agreement {
        let (whole, other) = (&whole.0, &other.0);
        let detector = self.reader.detector.as_ref();
        let pairs = detector.zip(whole.detections.as_ref().zip(other.detections.as_ref()));
        let pairs = pairs.map(|(detector, (whole, other))| Pairs::of(detector, whole, other));
        Agreement(Sums::of(whole, other, pairs.as_ref()))
    }
}

impl Looking<'_> {
    /// What the network says of a frame.
    pub fn look(&mut self, frame: Plane<'_>) -> Testimony {
        self.picture.show(frame);
        self.executor.step(&self.picture.values, &self.full);
        Testimony(self.witness.reader.read(&self.witness.network, &self.executor))
    }
}

impl Agreement {
    /// Adds that of other frames.
    pub fn add(&mut self, other: &Self) {
        self.0.add(&other.0);
    }

    /// The agreement in one number, 0 to 1, as [`Sight::agreement`](crate::Sight::agreement).
    #[must_use]
    pub fn share(&self) -> f64 {
        self.0.agreement()
    }

    /// Detections of all sizes, if they are read.
    #[must_use]
    pub fn found(&self) -> Option<Found> {
        self.0.found()
    }
}
