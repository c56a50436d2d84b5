// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summaries of irrelevant regions: the means of their blocks, and the frames in which they are
//! sent.

use foveate_camera::{Camera, IrrelevantRendering, Periphery, RegionAction};

use super::region::region_action;
use crate::conversions::index;
use crate::region::RegionArea;
use foveate_pixels::Frame;

/// Returns the means of the blocks of a region in row-major order, each
/// `floor((sum + floor(b*b / 2)) / (b*b))`. `pixels` are those of the region in row-major order.
#[must_use]
pub fn block_means(periphery: &Periphery, pixels: impl Iterator<Item = u16>) -> Vec<u16> {
    let (blocks, block_side) = (index(periphery.blocks), index(periphery.block_side));
    let side = blocks * block_side;
    let mut sums = vec![u64::from(periphery.block_pixels() / 2); blocks * blocks];
    for (position, pixel) in pixels.enumerate() {
        let (x, y) = (position % side, position / side);
        sums[y / block_side * blocks + x / block_side] += u64::from(pixel);
    }
    let mean = |sum| sum / u64::from(periphery.block_pixels());
    let pixel = |sum| u16::try_from(mean(sum)).expect("a mean is within the range of pixels");
    sums.into_iter().map(pixel).collect()
}

/// Returns the number, in its region, of the upper left pixel of a block.
pub(crate) fn first_position_of_block(periphery: &Periphery, block: u32) -> u32 {
    let (blocks, side) = (periphery.blocks, periphery.block_side);
    let (left, top) = (block % blocks * side, block / blocks * side);
    top * blocks * side + left
}

/// Returns the number, in its region, of the lower right pixel of a block.
pub(crate) fn last_position_of_block(periphery: &Periphery, block: u32) -> u32 {
    let (blocks, side) = (periphery.blocks, periphery.block_side);
    first_position_of_block(periphery, block) + (side - 1) * blocks * side + side - 1
}

/// The summary of a region that was sent last, as long as the screen shows it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ShownSummary {
    shown: Option<Vec<u16>>,
}

impl ShownSummary {
    /// Makes the state of a region of which the screen shows these means, or no means.
    pub(crate) fn from_means(shown: Option<Vec<u16>>) -> Self {
        Self { shown }
    }

    /// Returns the action on the region for its SRS, TRS and means. The state does not change.
    pub(crate) fn action(
        &self,
        irrelevant: IrrelevantRendering,
        srs: bool,
        trs: bool,
        means: &[u16],
        level: u32,
    ) -> RegionAction {
        region_action(irrelevant, srs, trs, || self.is_due(means, level))
    }

    /// Returns the action on the region, and records the means that the screen shows after it.
    pub(crate) fn decide(
        &mut self,
        irrelevant: IrrelevantRendering,
        srs: bool,
        trs: bool,
        means: &[u16],
        level: u32,
    ) -> RegionAction {
        let action = self.action(irrelevant, srs, trs, means, level);
        self.record_action(action, means);
        action
    }

    /// Returns true if an irrelevant region with these means must send them: the screen shows no
    /// summary, or a mean differs from the shown one by more than `level`.
    fn is_due(&self, means: &[u16], level: u32) -> bool {
        self.shown.as_ref().is_none_or(|shown| {
            let mut pairs = shown.iter().zip(means);
            pairs.any(|(shown, &mean)| u32::from(shown.abs_diff(mean)) > level)
        })
    }

    /// Returns the means that the screen shows, or `None` if it shows no summary.
    pub(crate) fn shown(&self) -> Option<&[u16]> {
        self.shown.as_deref()
    }

    /// Discards the shown means, because the contents of the screen are not known.
    pub(crate) fn forget(&mut self) {
        self.shown = None;
    }

    /// Records the means that the screen shows after an action.
    fn record_action(&mut self, action: RegionAction, means: &[u16]) {
        match action {
            RegionAction::Forward => self.shown = None,
            RegionAction::Summarize => self.shown = Some(means.to_vec()),
            RegionAction::Hold | RegionAction::Blank => {}
        }
    }
}

/// Returns the state of every region of a camera before the first frame: the screen shows no
/// summary.
pub(crate) fn no_summaries(camera: &Camera) -> Vec<ShownSummary> {
    vec![ShownSummary::default(); index(camera.regions())]
}

impl RegionArea {
    /// Writes the means of the blocks of a region to a frame. Every pixel of a block gets its mean.
    pub(crate) fn fill_blocks(self, periphery: &Periphery, means: &[u16], frame: &mut Frame) {
        let side = index(periphery.block_side);
        for (y, row) in self.rows().zip(0..) {
            let means = &means[row / side * index(periphery.blocks)..][..index(periphery.blocks)];
            let line: Vec<u16> = means.iter().flat_map(|&mean| vec![mean; side]).collect();
            frame.write_row(self.left, y, &line);
        }
    }
}
