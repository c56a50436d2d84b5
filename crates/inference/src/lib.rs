// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a network behind a region-based event camera, and counts what the camera saves the network.
//!
//! The network sees the rendered frames of the receiver. A region whose rendered pixels equal those
//! of the frame before has not changed, so values that depend only on such regions need not be
//! computed again. An [`Inference`] runs a camera and a network over a clip or a data set, and
//! writes how much was needed, layer by layer and frame by frame.

mod album;
mod arrays;
mod camera;
mod charts;
mod checked;
mod choices;
mod clips;
mod closeness;
mod cost;
mod details;
mod error;
mod facts;
mod frame;
mod inference;
mod macs;
mod page;
mod player;
mod positions;
mod recording;
mod reference;
mod run;
mod sight;
mod summary;
mod sums;
mod tally;
mod traffic;
mod tune;

pub use arrays::{ArrayFile, ArraySummary, infer_arrays, is_array};
pub use camera::frames_of;
pub use checked::{NetworkFacts, NetworkReport, OPEN_SIZE, check_network};
pub use choices::{parse_goal, parse_mode, parse_noise, read_accelerator};
pub use closeness::Goal;
pub use cost::{Accelerated, FrameCost};
pub use error::InferenceError;
// Types that appear in the interface of this crate.
pub use foveate_network::sight::{
    Agreement, ClassKept, Detection, DetectionsKept, Detector, Found, Framing, Head, Looking,
    Mapping, Output, SightError, Testimony, Viewing, Witness, parse_detector, parse_framing,
    parse_mean, parse_scale,
};
pub use inference::{Computed, INFERENCE, Inference, Options};
pub use macs::Macs;
pub use recording::{Record, Recorded};
pub use sight::{
    ConfidenceIntervals, NOISE_LEVELS, NoiseAgreement, NoiseCeiling, Sight, Truth, has_places,
    wilson,
};
pub use summary::{Clip, Error, Layer, Outputs, Summary, Tried, Tuning};
pub use traffic::FrameTraffic;
