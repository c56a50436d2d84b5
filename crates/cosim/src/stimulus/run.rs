// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the driver of an organization is given.

use super::turns::Extent;
use crate::level::Level;
use crate::recording::Recorder;
use foveate_design::Design;
use foveate_frame::Frame;
use std::sync::atomic::AtomicBool;

/// One recording to make; the first four follow from the stimulus.
pub(super) struct Run<'a> {
    pub(super) level: Level,
    pub(super) seed: u64,
    pub(super) extent: Extent,
    pub(super) frames: &'a [Frame],
    /// The design of the caller's frames.
    pub(super) design: &'a Design,
    pub(super) recorder: &'a mut Recorder,
    pub(super) cancel: &'a AtomicBool,
    /// Hears how many sequences of how many are done.
    pub(super) progress: &'a mut dyn FnMut(u64, u64),
}
