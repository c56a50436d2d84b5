// SPDX-License-Identifier: MIT OR Apache-2.0
//! The playback of clips: frames of footage are shown to cameras, one after the other.
//!
//! [`RunClips`] are the clips and data sets of a run. A [`ClipPlayer`] plays one of them: it reads
//! ahead on a thread of its own, and returns a [`PlayedFrame`] at a time, which gives its memory
//! back when it is dropped. A [`RunMonitor`] counts the frames of all players of a run, reports
//! [`RunProgress`] to the caller's [`RunHooks`], and ends the playback on request. Memory does not
//! grow with the number of frames. This crate does not know what is done with the frames.

mod clips;
mod error;
mod halves;
mod monitor;
mod parallel;
mod player;
mod progress;
pub mod testing;

pub use clips::{ClipReading, CommonFormat, RunClips};
pub use error::{InputError, PlaybackError};
pub use halves::ClipHalves;
pub use monitor::{MonitoredFrames, RunMonitor};
pub use parallel::run_in_parallel;
pub use player::{ClipPlayer, FrameDepths, PlayedFrame};
pub use progress::{
    ProgressStage, ProgressUnit, RemainingTime, RunHooks, RunProgress, SilentHooks, StageAmount,
};
