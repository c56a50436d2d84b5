// SPDX-License-Identifier: MIT OR Apache-2.0
//! A model of when things happen: the clocks at which a design decides, sends and loses regions.
//!
//! The clocks of a core depend on pixels only through its decisions, and its decisions depend on
//! clocks only through lost regions. So [`TimedModel`] takes the values of whole frames from the
//! [engine](foveate_engine), tells the engine which regions were lost, and computes the clocks by
//! the formulas of `docs/timing.md`, `docs/serial.md`, `docs/raster.md` and `docs/sync.md`, with
//! the latencies of `foveate-design`. It yields [`Transaction`]s and no ports: a run of decisions,
//! a run of words at consecutive clocks, a lost region. The time and the memory that it takes
//! depend on the number of regions and not on the number of clocks. A [`TimedClip`] takes the
//! frames of a clip at their times, and yields transactions as the [rows](ClockRow) of a table.
//!
//! Edges are numbered from 0 through the whole run, resets included. The *clock* of a transaction
//! is the number of the edge after which it is on the ports.
//!
//! The crate shares no code with the cycle models of `foveate-model`. Tests compare every
//! transaction with what the ports of those models show.

mod clock_row;
mod clocks;
mod core_timing;
mod delivery;
mod error;
mod frame_traffic;
mod model;
mod pipelined;
mod raster;
mod sensor;
mod sent_kind;
mod serial;
mod sink;
mod timed_clip;
mod timed_core;
mod transaction;

pub use clock_row::{ClockEvent, ClockRow};
pub use core_timing::CoreTiming;
pub use delivery::{BeatOffer, FrameDelivery};
#[doc(hidden)]
pub use error::TimedError;
pub use frame_traffic::{FrameTraffic, TrafficMeter};
pub use model::TimedModel;
pub use sensor::RowSensor;
pub use sent_kind::SentKind;
pub use sink::{RateSink, ReadySink, Sink, SinkPattern, StallList};
pub use timed_clip::TimedClip;
pub use transaction::{
    DecisionRun, RegionLoss, RegionRun, ScoreRun, SentValues, Transaction, WordRun,
};
