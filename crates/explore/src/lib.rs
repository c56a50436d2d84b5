// SPDX-License-Identifier: MIT OR Apache-2.0
//! Many designs over the same footage: what each gets wrong against the ideal camera, what it costs,
//! how fast it is; and the cheapest that a scene needs.
//!
//! [`explore`] runs a [`Space`] of designs over clips and leaves a folder of tables, Pareto fronts,
//! configurations and one page to look at; it goes on where an interrupted run was. The yardstick is
//! the whole-frame floating-point camera of [`foveate_ideal`], the measures are those of
//! [`foveate_fidelity`]. The library never prints: progress and cancellation go through [`Hooks`].

mod cost;
mod error;
mod exploration;
mod explore;
mod fit;
mod footage;
mod front;
mod measure;
mod method;
mod objective;
mod point;
mod report;
mod row;
mod space;
mod store;
mod table;

pub use cost::{Silicon, Synthesizer};
pub use error::ExploreError;
pub use exploration::{ClipRow, Exploration};
pub use explore::{Request, explore};
pub use fit::{Constraints, Design as FittedDesign, Fit, FitRequest, Held, Target, fit};
pub use foveate_fidelity::{Figures, ScoreError};
pub use method::{Axis, Method};
pub use point::{Point, Refused};
pub use row::{Fronts, Row};
pub use space::{BUILT_IN, BuiltIn, Space};

/// How far an exploration is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Clips are read, to know how long they are.
    Reading {
        /// Frames that are read.
        frames: u64,
    },
    /// Designs over clips.
    Measuring {
        /// Pairs of a clip and a design that are done.
        done: usize,
        /// Of so many.
        all: usize,
    },
    /// Yosys is at work.
    Synthesizing {
        /// Distinct RTL that is done.
        done: usize,
        /// Of so many.
        all: usize,
    },
}

/// What an exploration asks and tells its caller, from several threads.
pub trait Hooks: Sync {
    /// Something is done.
    fn progress(&self, progress: Progress);

    /// Whether to stop; what is finished is kept.
    fn cancelled(&self) -> bool;
}
