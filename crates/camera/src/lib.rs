// SPDX-License-Identifier: MIT OR Apache-2.0
//! The region-based event camera as one validated value: which frames it takes, by which scores,
//! thresholds and reference it decides, and what the screen shows. The value does not depend on the
//! hardware that computes it.
//!
//! A [`CameraConfig`] holds the keys that a user writes. [`CameraConfig::validate`] turns it into a
//! [`Camera`], which is immutable and gives the grid, the thresholds and the widths of scores. No
//! other crate validates a configuration or derives a width again. This crate does no I/O.

mod base_classes;
mod bounds;
mod camera;
mod choice;
mod class_areas;
mod class_thresholds;
mod config;
mod decimal;
mod depth;
mod derived_numbers;
mod displacement;
mod error;
mod feature;
mod feature_spec;
mod keys;
mod periphery;
mod ranges;
mod reciprocal;
mod reference;
mod region_class;
mod sent_values;
mod temporal_thresholds;
pub mod toml_text;
mod validation;
mod width;
mod zones;
mod zones_config;

pub use bounds::KeyBound;
pub use camera::{Camera, TemporalParameters};
pub use choice::{
    DenoiseFilter, IrrelevantRendering, Neighborhood, Payload, ReferencePolicy, VoteCombination,
};
pub use class_thresholds::ClassThresholds;
pub use config::{
    CameraConfig, DecisionConfig, DenoiseConfig, FrameConfig, PeripheryConfig, RegionConfig,
    RenderConfig, SpatialConfig, TemporalConfig,
};
pub use decimal::Decimal;
pub use displacement::Displacement;
pub use error::ConfigError;
pub use feature::{MeanDivision, SpatialFeature, VarianceWidths};
pub use feature_spec::{FeatureKind, FeatureSpec, LevelSpec, ScoreSource, ScoreUnit};
pub use keys::{AcceptedValues, CAMERA_KEYS, ConfigKey};
pub use periphery::Periphery;
pub use ranges::{
    FLOW_RADII, MAX_SIDE, MEAN_FRACTION_BITS, PIXEL_BITS, REGION_SIZES, SUMMARY_BLOCKS, check_range,
};
pub use reciprocal::Reciprocal;
pub use reference::ReferenceWriteTime;
pub use region_class::{ClassMapError, RegionClass};
pub use sent_values::RegionAction;
pub use width::{bits_for, index_bits};
pub use zones::Zones;
pub use zones_config::{
    AreaConfig, KeenConfig, KeenPeripheryConfig, KeenSpatialConfig, KeenTemporalConfig, ZonesConfig,
};
