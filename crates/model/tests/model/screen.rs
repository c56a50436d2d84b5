// SPDX-License-Identifier: MIT OR Apache-2.0
//! The screen behind an array or core: what leaves it is shown at once.

use foveate_design::{Action, Design};

pub(crate) struct Screen {
    pub(crate) design: Design,
    /// The padded frame, row by row.
    pub(crate) pixels: Vec<u16>,
    /// The regions of which means leave.
    pub(crate) summaries: Vec<bool>,
}

impl Screen {
    pub(crate) fn black(design: &Design) -> Self {
        let pixels = vec![0; (design.regions() * design.region_pixels()) as usize];
        Self { design: design.clone(), pixels, summaries: vec![false; design.regions() as usize] }
    }

    pub(crate) fn place(&self, region: u32, position: u32) -> usize {
        let (side, columns) = (self.design.region_size(), self.design.columns());
        let x = region % columns * side + position % side;
        let y = region / columns * side + position / side;
        (y * columns * side + x) as usize
    }

    /// What a decision does; `summary` is whether means will leave.
    pub(crate) fn act(&mut self, region: u32, (srs, trs, summary): (bool, bool, bool)) {
        let action = foveate_model::action(self.design.irrelevant(), srs, trs, || summary);
        assert_eq!(action == Action::Summarize, summary, "means leave of irrelevant regions only");
        self.summaries[region as usize] = summary;
        // What the array does not send must not look like what was there before.
        let value = match action {
            Action::Hold => return,
            Action::Blank => 0,
            Action::Forward | Action::Summarize => u16::MAX,
        };
        for position in 0..self.design.region_pixels() {
            let place = self.place(region, position);
            self.pixels[place] = value;
        }
    }

    /// A pixel has left of a region, or the mean of the block in which the position lies: all of the block shows it.
    pub(crate) fn show(&mut self, region: u32, position: u32, value: u16) {
        let size = self.design.region_size();
        let block = match self.design.periphery() {
            Some(periphery) if self.summaries[region as usize] => periphery.block_side,
            _ => 1,
        };
        let (left, top) = (position % size / block * block, position / size / block * block);
        for (x, y) in (0..block * block).map(|at| (left + at % block, top + at / block)) {
            let place = self.place(region, y * size + x);
            self.pixels[place] = value;
        }
    }
}
