// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a network is shown frames, what it says of them, and how much of what it says of whole frames it says of others, too.
//!
//! A [`Witness`] is a network with its [`Viewing`]: the [`Framing`] brings frames to the size of its input, a [`Mapping`] makes values of pixels, and
//! a [`Detector`] reads what was found in one of the formats of [`Head`]. Nothing here reads files but the network's, and nothing knows a camera.

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
