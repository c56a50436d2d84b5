// SPDX-License-Identifier: MIT OR Apache-2.0
//! Configuration, validation and every derived number of a Foveate design.
//!
//! A [`Config`] is what a user writes; [`Config::validate`] turns it into a [`Design`], which is
//! immutable and answers every question about itself: grid, score widths, latencies, port lists,
//! fingerprint. Nothing downstream validates again or derives a width again. This crate does no
//! I/O.

mod action;
mod choice;
mod config;
mod decimal;
mod depth;
mod derived;
mod design;
mod error;
mod feature;
mod fingerprint;
mod keys;
mod kind;
mod organization;
mod parse;
mod pipelined;
mod port;
mod preset;
mod raster;
mod reciprocal;
mod rules;
mod serial;
mod timing;
mod validate;
mod width;

pub use action::Action;
pub use choice::{
    Combine, FeatureKind, Feed, Filter, Irrelevant, MemoryKind, Neighborhood, Organization,
    Payload, Pipelining, Reference, Store, Thresholds,
};
pub use config::{
    Config, DecisionConfig, DenoiseConfig, FrameConfig, HardwareConfig, RegionConfig, RenderConfig,
    SpatialConfig, TemporalConfig,
};
pub use decimal::Decimal;
pub use design::{Design, Temporal};
pub use error::DesignError;
pub use feature::{Mean, SpatialFeature, Variance};
pub use kind::Measure;
pub use pipelined::PipelinedTiming;
pub use port::{Direction, Port, PortRole, Qualifier};
pub use preset::{PRESETS, Preset};
pub use raster::{
    FRAME_NUMBERS, RasterMemory, RasterStream, RasterTiming, RowDeparture, SecondPass,
};
pub use reciprocal::Reciprocal;
pub use rules::Unit;
pub use serial::{Area, AreaKind, LaneMemory, LaneWidths, MemoryChoice, Phase, SerialTiming};
pub use timing::{Departure, Timing};
pub use width::{bits_for, index_bits, mad_score_max};
