// SPDX-License-Identifier: MIT OR Apache-2.0
//! The output ports of the array.

use foveate_design::PortRole;

/// What the outputs of the array show after an edge. A port that means nothing shows 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SerialOutput {
    /// `ready_o`.
    pub ready: bool,
    /// `sync_error_o`.
    pub sync_error: bool,
    /// `score_valid_o`.
    pub score_valid: bool,
    /// `score_index_o`: 0 for the temporal count, 1.. for the features in the order of the design.
    pub score_index: u32,
    /// `region_o`.
    pub region: u32,
    /// `score_o`.
    pub score: u64,
    /// `decision_valid_o`.
    pub decision_valid: bool,
    /// `srs_o`.
    pub srs: bool,
    /// `trs_o`.
    pub trs: bool,
    /// `active_o`.
    pub active: bool,
    /// `summary_o`; 0 where the design has no such port.
    pub summary: bool,
    /// `forward_valid_o`: one per lane, or one with `feed = "raster"`.
    pub forward_valid: Vec<bool>,
    /// `forward_pixel_o`, likewise.
    pub forward_pixel: Vec<u16>,
    /// `forward_position_o`.
    pub forward_position: u32,
    /// `forward_slot_o`; 0 where the design has no such port.
    pub forward_slot: u32,
    /// `forward_region_o`; 0 where the design has no such port.
    pub forward_region: u32,
}

impl SerialOutput {
    /// Nothing is seen; `width` forwarded pixels at a time.
    pub(super) fn silent(width: usize) -> Self {
        Self { forward_valid: vec![false; width], forward_pixel: vec![0; width], ..Self::default() }
    }

    /// Forwards nothing any more.
    pub(super) fn stop_forwarding(&mut self) {
        self.forward_valid.fill(false);
        self.forward_pixel.fill(0);
    }

    /// Says nothing any more, but for the ports that may be as many as lanes.
    pub(super) fn stop_saying(&mut self) {
        let forward_valid = std::mem::take(&mut self.forward_valid);
        let forward_pixel = std::mem::take(&mut self.forward_pixel);
        *self = Self { forward_valid, forward_pixel, ..Self::default() };
    }

    /// Appends what the port of a role shows.
    pub(super) fn show(&self, role: PortRole, values: &mut Vec<u64>) {
        let value = match role {
            PortRole::Ready => self.ready.into(),
            PortRole::SyncError => self.sync_error.into(),
            PortRole::ScoreValid => self.score_valid.into(),
            PortRole::ScoreIndex => self.score_index.into(),
            PortRole::Region => self.region.into(),
            PortRole::AnyScore => self.score,
            PortRole::DecisionValid => self.decision_valid.into(),
            PortRole::Srs => self.srs.into(),
            PortRole::Trs => self.trs.into(),
            PortRole::Active => self.active.into(),
            PortRole::Summary => self.summary.into(),
            PortRole::ForwardPosition => self.forward_position.into(),
            PortRole::ForwardSlot => self.forward_slot.into(),
            PortRole::ForwardRegion => self.forward_region.into(),
            PortRole::ForwardValid => {
                return values.extend(self.forward_valid.iter().map(|&valid| u64::from(valid)));
            }
            PortRole::ForwardPixel => {
                return values.extend(self.forward_pixel.iter().map(|&pixel| u64::from(pixel)));
            }
            // Inputs, and what an array does not have.
            _ => return,
        };
        values.push(value);
    }
}
