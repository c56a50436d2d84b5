// SPDX-License-Identifier: MIT OR Apache-2.0
//! Simulations: a design runs over frames, and arrays, tables, events and rendered frames are
//! written.
//!
//! A [`Simulation`] runs a design over a source of footage and writes a folder of NumPy arrays,
//! PNGs and a summary. The folder appears at the end, and states whether it is complete.
//! [`run_batch`] does so for many clips. A [`Recording`] is a stream of packets that becomes such a
//! folder. A [`Stream`] is a stream of packets whose frames are used as they arrive. Memory does
//! not grow with the number of frames. The library never prints: progress and cancellation go
//! through [`Hooks`].

mod batch;
mod decode;
mod error;
mod explain;
mod losses;
mod output;
mod simulation;
mod stream;

pub use batch::{BatchHooks, BatchProgress, BatchSummary, ClipSummary, run_batch};
pub use decode::{Decoded, Recording};
pub use error::SimulatorError;
pub use explain::explain;
pub use foveate_engine::MAX_THREADS;
pub use foveate_footage::{Hooks, Progress, Silent};
pub use foveate_model::explain::Explanation;
pub use foveate_packets::{Command, Loss, Register};
pub use output::{
    Bandwidth, DataSet, EventTables, Grid, Medium, PIXEL_EVENT_BYTES, Packets, PixelCamera,
    PixelEvent, PixelEvents, Range, RunOptions, Summary, Traffic, write_packets,
};
pub use simulation::{SIMULATION, Simulation};
pub use stream::{CLAIMED_PIXELS, Received, ShownFrame, Stream};
