// SPDX-License-Identifier: MIT OR Apache-2.0
//! A camera and the hardware that computes it as one validated value, with every number that
//! follows from both.
//!
//! A [`DesignConfig`] holds the keys that a user writes. [`DesignConfig::validate`] turns it into a
//! [`Design`], which is immutable and gives latencies, memories, lists of ports and its
//! fingerprint. It dereferences to its [`Camera`](foveate_camera::Camera), which is defined in the
//! crate of that name. No other crate validates a configuration or derives a width again. This
//! crate does no I/O.

mod choice;
mod class_memory;
mod config;
mod design;
mod feature;
mod hardware;
mod hardware_config;
mod hardware_view;
mod interface;
mod keys;
mod organization;
mod pipelined;
mod port;
mod preset;
mod raster;
mod serial;
mod thresholds;
mod timing;
mod validation;

pub use choice::{
    FrameStoreKind, InterfaceKind, LaneMemoryKind, Organization, Pipelining, PixelFeed,
    ThresholdSource,
};
pub use class_memory::{CLASS_BITS, CLASS_WORD_BITS, CLASSES_PER_WORD, class_word};
pub use config::DesignConfig;
pub use design::Design;
pub use feature::{
    FeatureDescription, FeatureHardware, FlowSearch, PipelinedFeature, RasterFeature, SerialFeature,
};
pub use hardware::Hardware;
pub use hardware_config::{HardwareConfig, OrganizationConfig, RasterConfig, SerialConfig};
pub use hardware_view::{DesignWithHardware, PipelinedDesign, RasterDesign, SerialDesign};
pub use interface::{BeatRegion, CoreInterface, CoreStream, StreamRole};
pub use organization::{ArrayStructure, ArrayUnit};
pub use pipelined::{PipelinedHardware, PipelinedTiming};
pub use port::{OutputQualifier, Port, PortDirection, PortRole};
pub use preset::{PRESETS, Preset};
pub use raster::{FRAME_NUMBERS, RasterHardware, RasterMemory, RasterTiming, SecondPassTiming};
pub use serial::{
    BlockMeanDivision, LaneMemory, LaneWidths, MemoryChoice, SerialHardware, SerialPhase,
    SerialTiming, SlotArea, SlotAreaKind,
};
pub use thresholds::{DesignThreshold, keen_role};
pub use timing::{DepartureTiming, DesignTiming};
