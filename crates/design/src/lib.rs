// SPDX-License-Identifier: MIT OR Apache-2.0
//! A camera and the hardware that computes it as one validated value, with every number that
//! follows from both.
//!
//! A [`Config`] holds the keys that a user writes. [`Config::validate`] turns it into a [`Design`],
//! which is immutable and gives latencies, memories, lists of ports and its fingerprint. It
//! dereferences to its [`Camera`], which is defined in the crate of that name. No other crate
//! validates a configuration or derives a width again. This crate does no I/O.

mod choice;
mod config;
mod design;
mod fingerprint;
mod hardware;
mod interface;
mod keys;
mod organization;
mod pipelined;
mod port;
mod preset;
mod raster;
mod rules;
mod serial;
mod takes;
mod timing;
mod validate;
mod view;

pub use choice::{Bus, Feed, MemoryKind, Organization, Pipelining, Store, Thresholds};
pub use config::{Config, HardwareConfig};
pub use design::Design;
pub use foveate_camera::{
    Action, Camera, CameraConfig, Combine, ConfigError, DECISION_BITS, Decimal, DecisionConfig,
    DenoiseConfig, FeatureKind, Filter, FrameConfig, Irrelevant, Mean, Measure, Neighborhood,
    Payload, Periphery, PeripheryConfig, Reciprocal, Reference, RegionConfig, RenderConfig,
    SUMMARY_BLOCKS, SpatialConfig, SpatialFeature, Temporal, TemporalConfig, Variance, Written,
    bits_for, index_bits, mad_score_max,
};
pub use hardware::Hardware;
pub use interface::{BeatRegion, Interface, Stream, StreamRole};
pub use organization::is_taken;
pub use pipelined::{Pipelined, PipelinedTiming};
pub use port::{Direction, Port, PortRole, Qualifier};
pub use preset::{PRESETS, Preset};
pub use raster::{
    FRAME_NUMBERS, Raster, RasterMemory, RasterStream, RasterTiming, RowDeparture, SecondPass,
};
pub use rules::{Array, Unit};
pub use serial::{
    Area, AreaKind, BlockSums, LaneMemory, LaneWidths, MemoryChoice, Phase, Serial, SerialTiming,
};
pub use timing::{Departure, Timing};
pub use view::{DesignOn, PipelinedDesign, RasterDesign, SerialDesign};
