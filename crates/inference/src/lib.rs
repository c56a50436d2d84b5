// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a network behind a region-based event camera, and counts what the camera saves the network.
//!
//! The network sees the rendered frames of the receiver. A region whose rendered pixels equal those
//! of the frame before has not changed, so values that depend only on such regions need not be
//! computed again. An [`Inference`] runs a camera and a network over a clip or a data set, and
//! writes how much was needed, layer by layer and frame by frame.

mod kept_clips;
mod arrays;
mod camera;
mod charts;
mod network_check;
mod option_parsers;
mod clips;
mod closeness;
mod cost;
mod layer_frame_table;
mod error;
mod table_columns;
mod frame;
mod inference;
mod macs;
mod page;
mod runner;
mod positions;
mod recording;
mod whole_computation;
mod run;
mod whole_frames;
mod summary;
mod sums;
mod tally;
mod traffic;
mod tuning;

pub use arrays::{ArrayFile, ArraySummary, infer_arrays, is_array};
pub use camera::frame_format_of;
pub use network_check::{NetworkFacts, NetworkReport, OPEN_SIZE, check_network};
pub use option_parsers::{parse_goal, parse_mode, parse_noise, read_accelerator};
pub use closeness::TuningGoal;
pub use cost::{AcceleratorSummary, FrameCost};
pub use error::InferenceError;
// Types that appear in the interface of this crate.
pub use foveate_network::vision::{
    OutputAgreement, ClassAgreement, Detection, DetectionAgreement, Detector, DetectionCounts, Framing, DetectionFormat, VisionRun,
    PixelMapping, OutputTensor, VisionError, FrameOutcome, VisionOptions, VisionNetwork, parse_detector, parse_framing,
    parse_mean, parse_scale,
};
pub use inference::{Computation, INFERENCE_FOLDER, Inference, InferenceOptions};
pub use macs::Macs;
pub use recording::{RecordOptions, RecordedOutput};
pub use whole_frames::{
    ConfidenceIntervals, NOISE_LEVELS, NoiseAgreement, NoiseComparison, WholeFrameAgreement, GroundTruthFigures, has_class_map,
    wilson_interval,
};
pub use summary::{ClipSummary, WholeComputationError, LayerSummary, OutputCloseness, InferenceSummary, TuningTrial, TuningSummary};
pub use traffic::FrameTraffic;
