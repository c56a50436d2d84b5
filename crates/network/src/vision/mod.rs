// SPDX-License-Identifier: MIT OR Apache-2.0
//! Feeds frames to networks, reads detections from their outputs, and measures how far the outputs
//! for different frames agree.
//!
//! A [`VisionNetwork`] is a network with its [`VisionOptions`]: the [`Framing`] brings frames to
//! the size of the input, a [`PixelMapping`] converts pixels to values, and a [`Detector`] reads
//! detections in a format of [`DetectionFormat`]. This module reads only the file of the network,
//! and does not depend on a camera.

mod agreement;
mod detection;
mod detection_format;
mod detector;
mod distance;
mod error;
mod frame_findings;
mod frame_input;
mod framing;
mod network_defaults;
mod vision_network;

pub use agreement::{
    AgreementSums, ClassAgreement, DetectionAgreement, DetectionCounts, DetectionPairs,
    SAME_OBJECT_OVERLAP,
};
pub use detection::{Detection, match_detections};
pub use detection_format::{DetectionFormat, OutputTensor};
pub use detector::{Detector, parse_detector};
pub use distance::{OutputDistance, index_of_largest, psnr};
pub use error::VisionError;
pub use frame_findings::FrameFindings;
pub use frame_input::{FrameFormat, FrameInput, PixelMapping, parse_mean, parse_scale};
pub use framing::{Framing, parse_framing};
pub use network_defaults::{NetworkDefaults, guess_defaults};
pub use vision_network::{FrameOutcome, OutputAgreement, VisionNetwork, VisionOptions, VisionRun};
