// SPDX-License-Identifier: MIT OR Apache-2.0
//! Video and image sets in, arrays and rendered frames out.
//!
//! [`open`] turns what a user names (video, files, folders, globs, `scene:NAME`) into a [`Source`] of
//! frames, one at a time. A [`Simulation`] runs a design over a source and writes a folder of NumPy
//! arrays, PNGs and a summary, which appears at the end and says whether it is complete; [`plan`] and
//! [`run_batch`] do that for many clips. Memory does not grow with the number of frames. The library
//! never prints: progress and cancellation go through [`Hooks`].

mod batch;
mod error;
mod explain;
mod input;
mod natural;
mod output;
mod picture;
mod samples;
mod sets;
mod simulation;
mod source;
mod subject;
mod video;
mod y4m;

pub use batch::{
    BatchHooks, BatchProgress, BatchSummary, Clip, ClipSummary, Plan, plan, run_batch,
};
pub use error::SimulatorError;
pub use explain::{Change, Explanation, Place, Rows, Spatial, explain};
pub use input::{ImagesAs, InputOptions, is_read_once, open};
pub use natural::natural_order;
pub use output::{
    Bandwidth, DataSet, EventTables, Grid, Medium, PIXEL_EVENT_BYTES, PixelCamera, PixelEvent,
    PixelEvents, Range, RunOptions, Summary, Traffic, csv_field,
};
pub use picture::{MAX_SIDE, decode, luma, read};
pub use simulation::{Hooks, Progress, Silent, Simulation};
pub use source::form::{IdxFile, Labels, SetFiles, SetForm};
pub use source::resize::Crop;
pub use source::select::{Selection, parse_time};
pub use source::{FrameRate, Kind, Source, SourceFrame};
pub use subject::{Subject, subjects};
