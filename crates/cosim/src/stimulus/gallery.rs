// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whole frames from motifs: an artist for every region.

use super::motif::{Artist, Motif};
use super::random::Random;
use crate::error::CosimError;
use foveate_design::Design;
use foveate_frame::Frame;

/// The artists of a frame.
pub(super) struct Gallery {
    design: Design,
    /// One per region.
    artists: Vec<Artist>,
}

impl Gallery {
    pub(super) fn new(design: &Design, random: &mut Random) -> Self {
        let artist = |_| Artist::new(design, design.region_size(), random.fork());
        let artists = (0..design.regions()).map(artist).collect();
        Self { design: design.clone(), artists }
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
            if configured && random.one_in(2) {
                artist.draw_near_minimum(motif);
            } else {
                artist.draw(motif);
            }
        }
    }

    /// What the artists have drawn.
    pub(super) fn frame(&self) -> Result<Frame, CosimError> {
        let design = &self.design;
        let (side, columns) = (design.region_size(), design.columns());
        let pixel = |x: u32, y: u32| {
            let artist = &self.artists[(y / side * columns + x / side) as usize];
            artist.pixels[(y % side * side + x % side) as usize]
        };
        Frame::from_fn(design.width(), design.height(), design.pixel_bits(), pixel)
            .map_err(|error| CosimError::Model { reason: error.to_string() })
    }
}
