// SPDX-License-Identifier: MIT OR Apache-2.0
//! The output ports of the core.

use foveate_camera::{FeatureKind, RegionAction};
use foveate_design::{FRAME_NUMBERS, PortRole};

use super::decisions::DecidedRasterRegion;
use super::external_store::StoreWord;
use super::readout::{ForwardWord, LostRegion};

/// The outputs of the core after an edge. A port whose value has no meaning, or that the core does
/// not have, is 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RasterOutput {
    /// Value of `ready_o`.
    pub ready: bool,
    /// Value of `sync_error_o`.
    pub sync_error: bool,
    /// Value of `zone_pending_o`.
    pub zone_pending: bool,
    /// Value of `reference_ready_o`.
    pub reference_ready: bool,
    /// Value of `store_valid_o`.
    pub store_valid: bool,
    /// Value of `store_pixel_o`: a word of K pixels, the left one first.
    pub store_pixels: Vec<u16>,
    /// Value of `store_last_o`.
    pub store_last: bool,
    /// Value of `underrun_o`.
    pub underrun: bool,
    /// Value of `decision_valid_o`.
    pub decision_valid: bool,
    /// Value of `region_o`.
    pub region: u32,
    /// Value of `srs_o`.
    pub srs: bool,
    /// Value of `trs_o`.
    pub trs: bool,
    /// Value of `active_o`.
    pub active: bool,
    /// Value of `summary_o`.
    pub summary: bool,
    /// Scores of the features, in the order of the design.
    pub scores: [u64; FeatureKind::COUNT],
    /// Value of `temporal_count_o`.
    pub temporal_count: u32,
    /// Value of `forward_valid_o`.
    pub forward_valid: bool,
    /// Value of `forward_region_o`.
    pub forward_region: u32,
    /// Value of `forward_position_o`.
    pub forward_position: u32,
    /// Value of `forward_pixel_o`: a word of K pixels, the left one first.
    pub forward_pixels: Vec<u16>,
    /// Value of `forward_first_o`.
    pub forward_first: bool,
    /// Value of `forward_last_o`.
    pub forward_last: bool,
    /// Value of `forward_abort_o`.
    pub forward_abort: bool,
    /// Value of `forward_frame_o`.
    pub forward_frame: u32,
    /// Value of `forward_summary_o`.
    pub forward_summary: bool,
    /// Value of `lost_o`.
    pub lost: bool,
    /// Value of `lost_count_o`.
    pub lost_count: u16,
    /// Value of `lost_valid_o`.
    pub lost_valid: bool,
    /// Value of `lost_region_o`.
    pub lost_region: u32,
    /// Value of `lost_frame_o`.
    pub lost_frame: u32,
}

impl RasterOutput {
    /// Makes the outputs after a reset, for words of `word_pixels` pixels.
    pub(super) fn after_reset(word_pixels: usize) -> Self {
        Self {
            ready: true,
            sync_error: false,
            zone_pending: false,
            reference_ready: false,
            store_valid: false,
            store_pixels: vec![0; word_pixels],
            store_last: false,
            underrun: false,
            decision_valid: false,
            region: 0,
            srs: false,
            trs: false,
            active: false,
            summary: false,
            scores: [0; FeatureKind::COUNT],
            temporal_count: 0,
            forward_valid: false,
            forward_region: 0,
            forward_position: 0,
            forward_pixels: vec![0; word_pixels],
            forward_first: false,
            forward_last: false,
            forward_abort: false,
            forward_frame: 0,
            forward_summary: false,
            lost: false,
            lost_count: 0,
            lost_valid: false,
            lost_region: 0,
            lost_frame: 0,
        }
    }

    pub(super) fn set_store_ports(&mut self, word: Option<&StoreWord>) {
        self.store_valid = word.is_some();
        self.store_last = word.is_some_and(|word| word.is_last);
        match word {
            Some(word) => self.store_pixels.copy_from_slice(word.pixels.as_slice()),
            None => self.store_pixels.fill(0),
        }
    }

    pub(super) fn set_decision_ports(&mut self, decided: Option<&DecidedRasterRegion>) {
        let scored_region = decided.map(|decided| &decided.scored_region);
        let decision =
            scored_region.map(|scored_region| scored_region.decision).unwrap_or_default();
        self.decision_valid = scored_region.is_some();
        self.region = scored_region.map_or(0, |scored_region| scored_region.region);
        (self.srs, self.trs, self.active) = (decision.srs, decision.trs, decision.is_active());
        self.summary = decided.is_some_and(|decided| decided.action == RegionAction::Summarize);
        (self.scores, self.temporal_count) = (decision.scores, decision.temporal_count);
    }

    /// Sets the forward ports to a word that leaves, or to no word.
    pub(super) fn set_forward_ports(&mut self, word: Option<&ForwardWord>) {
        self.forward_valid = word.is_some();
        self.forward_region = word.map_or(0, |word| word.region);
        self.forward_position = word.map_or(0, |word| word.position);
        self.forward_first = word.is_some_and(|word| word.position == 0);
        self.forward_last = word.is_some_and(|word| word.is_last);
        self.forward_abort = word.is_some_and(|word| word.is_aborted);
        self.forward_frame = word.map_or(0, |word| frame_number_on_port(word.frame));
        self.forward_summary = word.is_some_and(|word| word.is_mean);
        match word {
            Some(word) => self.forward_pixels.copy_from_slice(word.pixels.as_slice()),
            None => self.forward_pixels.fill(0),
        }
    }

    /// Sets the number of regions that were lost. The port stays at its largest value.
    pub(super) fn set_lost_count(&mut self, lost: u64) {
        self.lost = lost > 0;
        self.lost_count = u16::try_from(lost).unwrap_or(u16::MAX);
    }

    /// Sets the loss ports to the region that was lost at this edge, or to no region.
    pub(super) fn set_loss_ports(&mut self, loss: Option<LostRegion>) {
        self.lost_valid = loss.is_some();
        self.lost_region = loss.map_or(0, |loss| loss.region);
        self.lost_frame = loss.map_or(0, |loss| frame_number_on_port(loss.frame));
    }

    /// Appends the value of the port of a role. `kinds` are the features of the design in order.
    pub(super) fn append_port(&self, role: PortRole, kinds: &[FeatureKind], values: &mut Vec<u64>) {
        let value = match role {
            PortRole::Ready => self.ready.into(),
            PortRole::SyncError => self.sync_error.into(),
            PortRole::ClassPending => self.zone_pending.into(),
            PortRole::ReferenceReady => self.reference_ready.into(),
            PortRole::StoreValid => self.store_valid.into(),
            PortRole::StorePixel => return append_pixels(values, &self.store_pixels),
            PortRole::StoreLast => self.store_last.into(),
            PortRole::Underrun => self.underrun.into(),
            PortRole::DecisionValid => self.decision_valid.into(),
            PortRole::Region => self.region.into(),
            PortRole::Srs => self.srs.into(),
            PortRole::Trs => self.trs.into(),
            PortRole::Active => self.active.into(),
            PortRole::Summary => self.summary.into(),
            PortRole::Score(kind) => {
                match kinds.iter().position(|&feature_kind| feature_kind == kind) {
                    Some(place) => self.scores[place],
                    None => return,
                }
            }
            PortRole::TemporalCount => self.temporal_count.into(),
            PortRole::ForwardValid => self.forward_valid.into(),
            PortRole::ForwardRegion => self.forward_region.into(),
            PortRole::ForwardPosition => self.forward_position.into(),
            PortRole::ForwardPixel => return append_pixels(values, &self.forward_pixels),
            PortRole::ForwardFirst => self.forward_first.into(),
            PortRole::ForwardLast => self.forward_last.into(),
            PortRole::ForwardAbort => self.forward_abort.into(),
            PortRole::ForwardFrame => self.forward_frame.into(),
            PortRole::ForwardSummary => self.forward_summary.into(),
            PortRole::Lost => self.lost.into(),
            PortRole::LostCount => self.lost_count.into(),
            PortRole::LostValid => self.lost_valid.into(),
            PortRole::LostRegion => self.lost_region.into(),
            PortRole::LostFrame => self.lost_frame.into(),
            // The other roles are inputs, or outputs that a core does not have.
            _ => return,
        };
        values.push(value);
    }
}

fn append_pixels(values: &mut Vec<u64>, word: &[u16]) {
    values.extend(word.iter().map(|&pixel| u64::from(pixel)));
}

/// Returns the number of a frame as the ports show it.
fn frame_number_on_port(frame: u64) -> u32 {
    u32::try_from(frame % u64::from(FRAME_NUMBERS)).expect("a remainder of 32 bits")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_count_of_lost_regions_stays_at_its_largest() {
        let mut output = RasterOutput::after_reset(1);
        for (lost, shown) in [(0, 0), (1, 1), (65_535, 65_535), (65_536, 65_535)] {
            output.set_lost_count(lost);
            assert_eq!((output.lost, output.lost_count), (lost > 0, shown));
        }
    }
}
