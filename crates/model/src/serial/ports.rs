// SPDX-License-Identifier: MIT OR Apache-2.0
//! The output ports of the array.

use foveate_design::PortRole;

/// The outputs of the array after an edge. A port whose value has no meaning is 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SerialOutput {
    /// Value of `ready_o`.
    pub ready: bool,
    /// Value of `sync_error_o`.
    pub sync_error: bool,
    /// Value of `zone_pending_o`. It is 0 if the design has no such port.
    pub zone_pending: bool,
    /// Value of `score_valid_o`.
    pub score_valid: bool,
    /// Value of `score_index_o`: 0 for the temporal count, 1.. for the features in the order of the
    /// design.
    pub score_index: u32,
    /// Value of `region_o`.
    pub region: u32,
    /// Value of `score_o`.
    pub score: u64,
    /// Value of `displacement_x_o`, in two's complement of the port's width. It is 0 if the design
    /// has no such port.
    pub displacement_x: u64,
    /// Value of `displacement_y_o`, like that of `displacement_x_o`.
    pub displacement_y: u64,
    /// Value of `decision_valid_o`.
    pub decision_valid: bool,
    /// Value of `srs_o`.
    pub srs: bool,
    /// Value of `trs_o`.
    pub trs: bool,
    /// Value of `active_o`.
    pub active: bool,
    /// Value of `summary_o`. It is 0 if the design has no such port.
    pub summary: bool,
    /// Values of `forward_valid_o`: one per lane, or one in all with `feed = "raster"`.
    pub forward_valid: Vec<bool>,
    /// Values of `forward_pixel_o`: one per lane, or one in all with `feed = "raster"`.
    pub forward_pixel: Vec<u16>,
    /// Value of `forward_position_o`.
    pub forward_position: u32,
    /// Value of `forward_slot_o`. It is 0 if the design has no such port.
    pub forward_slot: u32,
    /// Value of `forward_region_o`. It is 0 if the design has no such port.
    pub forward_region: u32,
}

impl SerialOutput {
    /// Makes outputs without a valid bit, for `width` forwarded pixels at a time.
    pub(super) fn without_valid_bits(width: usize) -> Self {
        Self { forward_valid: vec![false; width], forward_pixel: vec![0; width], ..Self::default() }
    }

    /// Clears the ports of forwarded pixels.
    pub(super) fn clear_forward_ports(&mut self) {
        self.forward_valid.fill(false);
        self.forward_pixel.fill(0);
    }

    /// Clears all ports except those of forwarded pixels, which may be as many as there are lanes.
    pub(super) fn clear_other_ports(&mut self) {
        let forward_valid = std::mem::take(&mut self.forward_valid);
        let forward_pixel = std::mem::take(&mut self.forward_pixel);
        *self = Self { forward_valid, forward_pixel, ..Self::default() };
    }

    pub(super) fn append_port(&self, role: PortRole, values: &mut Vec<u64>) {
        let value = match role {
            PortRole::Ready => self.ready.into(),
            PortRole::SyncError => self.sync_error.into(),
            PortRole::ClassPending => self.zone_pending.into(),
            PortRole::ScoreValid => self.score_valid.into(),
            PortRole::ScoreIndex => self.score_index.into(),
            PortRole::Region => self.region.into(),
            PortRole::AnyScore => self.score,
            PortRole::DisplacementX => self.displacement_x,
            PortRole::DisplacementY => self.displacement_y,
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
            // The other roles are inputs, or outputs that an array does not have.
            _ => return,
        };
        values.push(value);
    }
}
