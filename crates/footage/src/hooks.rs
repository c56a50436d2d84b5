// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a run over the frames of a source reports what is done, and hears that it is to stop.

use foveate_toolchain::Interrupt;

/// Progress of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Frames that are done.
    pub done: u64,
    /// Frames in all, if that is known.
    pub total: Option<u64>,
}

/// Callbacks of a run, called once per frame.
pub trait Hooks {
    /// Reports that another frame is done.
    fn progress(&mut self, progress: Progress);

    /// Returns whether to stop. The result is then what was done so far, marked as incomplete.
    fn cancelled(&self) -> bool;

    /// The same as a request that waits look at; hooks without one let a wait last as long as it does.
    fn interrupt(&self) -> Interrupt {
        Interrupt::default()
    }
}

/// Hooks that report nothing and never stop.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Hooks for Silent {
    fn progress(&mut self, _progress: Progress) {}

    fn cancelled(&self) -> bool {
        false
    }
}
