// SPDX-License-Identifier: MIT OR Apache-2.0
//! Image sets in, arrays and rendered frames out.
//!
//! [`open`] turns what a user names (files, folders, globs, `scene:NAME`) into a [`Source`] of frames,
//! one at a time. A [`Simulation`] runs a design over a source and writes a folder of NumPy arrays,
//! PNGs and a summary, which appears only when it is complete. Memory does not grow with the number
//! of frames. The library never prints: progress and cancellation go through [`Hooks`].

mod depth;
mod error;
mod explain;
mod input;
mod natural;
mod output;
mod picture;
mod simulation;
mod source;

pub use depth::{convert_depth, display_depth};
pub use error::SimulatorError;
pub use explain::{Change, Explanation, Place, Rows, Spatial, explain};
pub use input::{InputOptions, open};
pub use natural::natural_order;
pub use output::{
    Bandwidth, EventTables, Grid, Medium, PIXEL_EVENT_BYTES, PixelCamera, PixelEvent, PixelEvents,
    Range, RunOptions, Summary, Traffic,
};
pub use picture::{MAX_SIDE, decode, luma, read};
pub use simulation::{Hooks, Progress, Silent, Simulation};
pub use source::{FrameRate, Source, SourceFrame};
