// SPDX-License-Identifier: MIT OR Apache-2.0
//! The screen of a receiver behind an array or core, which shows the output at once.

use foveate_camera::RegionAction;
use foveate_design::Design;

pub(crate) struct ReceiverScreen {
    pub(crate) design: Design,
    /// The padded frame in row-major order.
    pub(crate) pixels: Vec<u16>,
    /// True for every region whose means leave.
    pub(crate) summaries: Vec<bool>,
}

impl ReceiverScreen {
    pub(crate) fn black(design: &Design) -> Self {
        let pixels = vec![0; (design.regions() * design.region_pixels()) as usize];
        Self { design: design.clone(), pixels, summaries: vec![false; design.regions() as usize] }
    }

    pub(crate) fn pixel_index(&self, region: u32, position: u32) -> usize {
        let (side, columns) = (self.design.region_size(), self.design.columns());
        let x = region % columns * side + position % side;
        let y = region / columns * side + position / side;
        (y * columns * side + x) as usize
    }

    /// Applies a decision. `summary` is true if means will leave.
    pub(crate) fn apply_decision(&mut self, region: u32, (srs, trs, summary): (bool, bool, bool)) {
        let action = foveate_model::region_action(self.design.irrelevant(), srs, trs, || summary);
        assert_eq!(
            action == RegionAction::Summarize,
            summary,
            "means leave of irrelevant regions only"
        );
        self.summaries[region as usize] = summary;
        // Pixels that the array fails to send must differ from those that were shown before.
        let value = match action {
            RegionAction::Hold => return,
            RegionAction::Blank => 0,
            RegionAction::Forward | RegionAction::Summarize => u16::MAX,
        };
        for position in 0..self.design.region_pixels() {
            let place = self.pixel_index(region, position);
            self.pixels[place] = value;
        }
    }

    /// Shows a pixel that has left. If it is the mean of a block, the whole block that contains the
    /// position shows it.
    pub(crate) fn show_value(&mut self, region: u32, position: u32, value: u16) {
        let size = self.design.region_size();
        let block = match self.design.periphery() {
            Some(periphery) if self.summaries[region as usize] => periphery.block_side,
            _ => 1,
        };
        let (left, top) = (position % size / block * block, position / size / block * block);
        for (x, y) in (0..block * block).map(|at| (left + at % block, top + at / block)) {
            let place = self.pixel_index(region, y * size + x);
            self.pixels[place] = value;
        }
    }
}
