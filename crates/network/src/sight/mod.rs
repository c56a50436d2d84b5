// SPDX-License-Identifier: MIT OR Apache-2.0
//! Feeds frames to networks, reads detections from their outputs, and measures how far the outputs
//! for different frames agree.
//!
//! A [`Witness`] is a network with its [`Viewing`]: the [`Framing`] brings frames to the size of
//! the input, a [`Mapping`] converts pixels to values, and a [`Detector`] reads detections in a
//! format of [`Head`]. This module reads no files but that of the network, and knows no camera.

mod agreement;
mod detection;
mod detector;
mod distance;
mod error;
mod findings;
mod framing;
mod head;
mod mapping;
mod picture;
mod usual;
mod witness;

pub use agreement::{ClassKept, DetectionsKept, Found, Pairs, SAME_OBJECT, Sums};
pub use detection::{Detection, matched};
pub use detector::{Detector, parse_detector};
pub use distance::{Distance, largest, psnr};
pub use error::SightError;
pub use findings::Findings;
pub use framing::{Framing, parse_framing};
pub use head::{Head, Output};
pub use mapping::{Mapping, parse_mean, parse_scale};
pub use picture::{Frames, Picture};
pub use usual::{Usual, usual};
pub use witness::{Agreement, Looking, Testimony, Viewing, Witness};
