// SPDX-License-Identifier: MIT OR Apache-2.0
//! The callbacks of a run: progress and cancellation.

use foveate_tools::Interrupt;

use crate::playback::RunProgress;

/// The callbacks of a run. Several threads call them.
pub trait RunHooks: Sync {
    /// Reports that another frame or step is done.
    fn progress(&self, progress: &RunProgress<'_>);

    /// Returns true if the run is to stop. Each run says which of its results are kept then.
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
    fn progress(&self, _progress: &RunProgress<'_>) {}

    fn is_cancelled(&self) -> bool {
        false
    }
}
