// SPDX-License-Identifier: MIT OR Apache-2.0
//! The playback of clips: frames of footage are shown to cameras, one after the other.
//!
//! [`RunClips`] are the clips and data sets of a run. A [`ClipPlayer`] plays one of them: it reads
//! ahead on a thread of its own, and returns a [`PlayedFrame`] at a time, which gives its memory
//! back when it is dropped. A [`RunMonitor`] counts the frames of all players of a run, reports
//! [`RunProgress`] to the caller's [`RunHooks`], and ends the playback on request. Memory does not
//! grow with the number of frames. This crate does not know what is done with the frames.

mod clips;
mod depths;
mod error;
mod halves;
mod hooks;
mod monitor;
mod parallel;
mod played_frame;
mod player;
mod progress;
mod reader;
pub mod testing;

pub use clips::{ClipReading, CommonFormat, RunClips};
pub use depths::FrameDepths;
pub use error::{InputError, PlaybackError};
pub use halves::ClipHalves;
pub use hooks::{RunHooks, SilentHooks};
pub use monitor::{MonitoredFrames, RunMonitor};
pub use parallel::run_in_parallel;
pub use played_frame::PlayedFrame;
pub use player::ClipPlayer;
pub use progress::{ProgressStage, ProgressUnit, RemainingTime, RunProgress, StageAmount};
