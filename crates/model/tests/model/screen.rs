// SPDX-License-Identifier: MIT OR Apache-2.0
//! The screen behind an array or core: what leaves it is shown at once.

use foveate_design::{Action, Design};

pub(crate) struct Screen {
    pub(crate) design: Design,
    /// The padded frame, row by row.
    pub(crate) pixels: Vec<u16>,
}

impl Screen {
    pub(crate) fn black(design: &Design) -> Self {
        let pixels = vec![0; (design.regions() * design.region_pixels()) as usize];
        Self { design: design.clone(), pixels }
    }

    pub(crate) fn place(&self, region: u32, position: u32) -> usize {
        let (side, columns) = (self.design.region_size(), self.design.columns());
        let x = region % columns * side + position % side;
        let y = region / columns * side + position / side;
        (y * columns * side + x) as usize
    }

    /// What a decision does.
    pub(crate) fn act(&mut self, region: u32, srs: bool, trs: bool) {
        // A pixel that the array does not send must not look like the one before.
        let value = match foveate_model::action(self.design.irrelevant(), srs, trs, || {
            unreachable!("no means are sent")
        }) {
            Action::Hold => return,
            Action::Blank => 0,
            Action::Forward | Action::Summarize => u16::MAX,
        };
        for position in 0..self.design.region_pixels() {
            let place = self.place(region, position);
            self.pixels[place] = value;
        }
    }
}
