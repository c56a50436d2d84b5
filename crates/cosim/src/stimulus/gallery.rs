// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whole frames from motifs: an artist for every region.

use super::feed::FrameFeed;
use super::motif::{Artist, Motif};
use super::random::Random;
use crate::error::CosimError;
use foveate_frame::Frame;

/// The artists of what is fed.
pub(super) struct Gallery {
    /// One per square.
    artists: Vec<Artist>,
    /// Side of a square.
    side: u32,
    /// Columns and rows of all squares together, without what is beyond the frame.
    size: (u32, u32),
    /// Bits of a pixel.
    bits: u32,
}

impl Gallery {
    pub(super) fn new(feed: &FrameFeed<'_>, random: &mut Random) -> Self {
        let (design, side, size) = (feed.design(), feed.square_side(), feed.size());
        let squares = size.0.div_ceil(side) * size.1.div_ceil(side);
        let artists = (0..squares).map(|_| Artist::new(design, side, random.fork())).collect();
        Self { artists, side, size, bits: design.pixel_bits() }
    }

    /// Lets every artist draw the next picture, with `mixed` every region another motif, and with
    /// `configured` every other near a minimum of the design.
    pub(super) fn draw(
        &mut self,
        motifs: &[Motif],
        turn: usize,
        mixed: bool,
        configured: bool,
        random: &mut Random,
    ) {
        for (region, artist) in self.artists.iter_mut().enumerate() {
            let shift = if mixed { region } else { 0 };
            let motif = motifs[(turn + shift) % motifs.len()];
            // A step of a mean is a minimum of its own.
            if configured && motif != Motif::MeanStep && random.one_in(2) {
                artist.draw_near_minimum(motif);
            } else {
                artist.draw(motif);
            }
        }
    }

    /// What the artists have drawn.
    pub(super) fn frame(&self) -> Result<Frame, CosimError> {
        let (side, (width, height)) = (self.side, self.size);
        let columns = width.div_ceil(side);
        let pixel = |x: u32, y: u32| {
            let artist = &self.artists[(y / side * columns + x / side) as usize];
            artist.pixels[(y % side * side + x % side) as usize]
        };
        Frame::from_fn(width, height, self.bits, pixel)
            .map_err(|error| CosimError::Model { reason: error.to_string() })
    }
}
