// SPDX-License-Identifier: MIT OR Apache-2.0
//! The callbacks of a run over the frames of a source: progress and cancellation.

use foveate_toolchain::Interrupt;

/// The progress of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunProgress {
    /// The number of frames that are done.
    pub done: u64,
    /// The number of all frames, if it is known.
    pub total: Option<u64>,
}

/// The callbacks of a run, called once per frame.
pub trait RunHooks {
    /// Reports that another frame is done.
    fn progress(&mut self, progress: RunProgress);

    /// Returns true if the run is to stop. The result is then incomplete, and is marked so.
    fn is_cancelled(&self) -> bool;

    /// Returns the request to stop in a form that also ends waits. Hooks without one cannot end a
    /// wait.
    fn interrupt(&self) -> Interrupt {
        Interrupt::default()
    }
}

/// Hooks that report nothing and never stop.
#[derive(Clone, Copy, Debug, Default)]
pub struct SilentHooks;

impl RunHooks for SilentHooks {
    fn progress(&mut self, _progress: RunProgress) {}

    fn is_cancelled(&self) -> bool {
        false
    }
}
