// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a network behind a region-based event camera, and counts what the camera saves the network.
//!
//! The network sees the rendered frames of the receiver. A region whose rendered pixels equal those
//! of the frame before has not changed, so values that depend only on such regions need not be
//! computed again. An [`Inference`] runs a camera and a network over a clip or a data set, and
//! writes how much was needed, layer by layer and frame by frame.

mod arrays;
mod camera;
mod charts;
mod clip_playback;
mod closeness;
mod computation;
mod cost;
mod error;
mod frame;
mod inference;
mod layer_frame_table;
mod network_check;
mod option_parsers;
mod page;
mod recording;
mod run;
mod summary;
mod table_columns;
mod tuning;
mod whole_frames;

pub use arrays::{ArrayFile, ArraySummary, infer_arrays, is_array};
pub use camera::frame_format_of;
pub use closeness::TuningGoal;
pub use computation::Computation;
pub use cost::{AcceleratorSummary, FrameCost};
pub use error::InferenceError;
pub use network_check::{NetworkFacts, NetworkReport, OPEN_SIZE, check_network};
pub use option_parsers::{parse_goal, parse_mode, parse_noise, read_accelerator};
// Types that appear in the interface of this crate.
pub use computation::Macs;
pub use cost::FrameTraffic;
pub use foveate_network::vision::{
    ClassAgreement, Detection, DetectionAgreement, DetectionCounts, DetectionFormat, Detector,
    FrameOutcome, Framing, OutputAgreement, OutputTensor, PixelMapping, VisionError, VisionNetwork,
    VisionOptions, VisionRun, parse_detector, parse_framing, parse_mean, parse_scale,
};
pub use inference::{INFERENCE_FOLDER, Inference, InferenceOptions};
pub use recording::{RecordOptions, RecordedOutput};
pub use summary::{
    ClipSummary, InferenceSummary, LayerSummary, OutputCloseness, TuningSummary, TuningTrial,
    WholeComputationError,
};
pub use whole_frames::{
    ConfidenceIntervals, GaussianNoise, GroundTruthFigures, NOISE_LEVELS, NoiseAgreement,
    NoiseComparison, WholeFrameAgreement, has_class_map, wilson_interval,
};
