// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames that a source delivers, with the clocks at which it offers their beats.

use foveate_pixels::FramePixels;
use std::fmt::Debug;

/// The number of the edge at which an event happens that never happens. It is so far below the
/// largest number that sums of clocks do not overflow.
pub(crate) const NEVER: u64 = 1 << 62;

/// A pause of the source: beat number `beat` of a delivery is offered from edge `clock` on. The
/// source keeps an offered beat on the port until the core takes it. A core without `ready_o` takes
/// it at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BeatOffer {
    /// The number of the beat in its delivery, from 0. It is the word of a raster core, the pixel
    /// of every region of a pipelined array, or the pixel or pixels of a serial array.
    pub beat: u64,
    /// The first edge at which the beat is on the port.
    pub clock: u64,
}

/// A frame as the source delivers it.
#[derive(Clone, Copy, Debug)]
pub struct FrameDelivery<'a> {
    /// The pixels of the frame as the core sees them, without padding. In a damaged frame, the
    /// pixels that the source does not deliver are those that stand on the port while the core
    /// completes the frame. Where a core takes the halo or the padding of a region with its pixels,
    /// such a frame may differ from every whole frame; then only the clocks of its decisions are
    /// those of the core. The pixels of a frame that the core drops have no effect.
    pub pixels: FramePixels<'a>,
    /// The number of beats that the source delivers, or `None` for those of a frame. Other numbers
    /// need a design with `hardware.sync`.
    pub beats: Option<u64>,
    /// True if the first beat has the mark of the start of a frame. It means something only in a
    /// design with `hardware.sync`.
    pub is_marked: bool,
    /// The pauses of the source, in the order of the beats. A beat that is not in the list is
    /// offered as soon as the beat before it has been taken.
    pub offers: &'a [BeatOffer],
    /// The edge of a reset that ends the delivery, or that follows it before the core could take
    /// the next one. Beats that were not taken by then are not delivered at all.
    pub reset: Option<u64>,
}

impl<'a> FrameDelivery<'a> {
    /// Makes a whole frame whose beats the source offers as fast as the core takes them.
    #[must_use]
    pub fn whole(pixels: FramePixels<'a>) -> Self {
        Self { pixels, beats: None, is_marked: true, offers: &[], reset: None }
    }
}
