// SPDX-License-Identifier: MIT OR Apache-2.0
//! The core behind the search for frames, of any organization.

use std::fmt::Debug;

use foveate_engine::Engine;
use foveate_pixels::FramePixels;

use crate::{BeatOffer, Sink, Transaction};

/// The parts of the model that a core uses while it takes a frame.
pub(crate) struct CoreContext<'a> {
    pub(crate) engine: &'a mut Engine,
    pub(crate) sink: &'a mut dyn Sink,
    pub(crate) visit: &'a mut dyn FnMut(&Transaction<'_>),
}

/// A whole frame as the core takes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoreFrame<'a> {
    pub(crate) pixels: FramePixels<'a>,
    /// The pauses before its beats.
    pub(crate) offers: &'a [BeatOffer],
    /// The first edge at which another beat or a reset can come. It is before the last beat of a
    /// frame that the core completes by itself.
    pub(crate) next: u64,
}

/// A core between two frames.
pub(crate) trait TimedCore: Debug + Send {
    /// Returns the first edge at which the core can take the first beat of a frame. It is 0 for a
    /// core without `ready_o`, whose source never waits.
    fn open_from(&self) -> u64;

    /// Returns true if the source waits while the core is not ready.
    fn has_ready_output(&self) -> bool;

    /// Returns the edge at which beat number `beat` of a frame with these pauses is taken.
    fn take_edge(&self, offers: &[BeatOffer], beat: u64) -> u64;

    /// Takes a frame, and yields the transactions that are then certain: those before edge `end`,
    /// the next reset, and before the edge at which another frame could begin.
    fn take_frame(&mut self, frame: CoreFrame<'_>, end: u64, context: &mut CoreContext<'_>);

    /// Yields all transactions before edge `end` if no other frame follows.
    fn finish(&mut self, end: u64, context: &mut CoreContext<'_>);

    /// Applies a reset at edge `edge`.
    fn reset(&mut self, edge: u64);
}
