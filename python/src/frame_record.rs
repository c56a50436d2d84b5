// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame and its results as numbers, and everything that follows from them alone.

use std::sync::Arc;

use foveate_camera::RegionClass;
use foveate_engine::FrameOutcome;
use foveate_simulator::{
    DecidedRegion, DecisionExplanation, FrameStart, PacketContent, SentCounts, SentValues,
    SimulatorError, packet_bytes, packet_layout, wrapped_number, write_kept_packets,
};

use crate::region_arrays::RegionResults;

/// A frame and its results.
pub(crate) struct FrameRecord {
    pub(crate) design: Arc<foveate_design::Design>,
    pub(crate) result: FrameOutcome,
    pub(crate) number: u64,
    pub(crate) time_us: u64,
    /// True if the frame has no frame before it.
    pub(crate) is_first: bool,
    pub(crate) name: Option<String>,
    pub(crate) label: Option<String>,
    /// The classes of the regions in this frame, of a design with zones.
    pub(crate) classes: Option<RegionClasses>,
}

/// The map of classes that a frame used.
pub(crate) struct RegionClasses {
    pub(crate) map: Vec<RegionClass>,
    /// The number of maps that were set since the camera had that of its configuration.
    pub(crate) maps_set: u64,
}

impl FrameRecord {
    pub(crate) fn results(&self) -> RegionResults<'_> {
        RegionResults { design: &self.design, result: &self.result }
    }

    /// Returns true if the frame used the map of classes of the configuration, or if there are no classes.
    pub(crate) fn has_own_map(&self) -> bool {
        self.maps_set() == 0
    }

    fn maps_set(&self) -> u64 {
        self.classes.as_ref().map_or(0, |classes| classes.maps_set)
    }

    /// Returns what the frame sends, as `frames.csv` counts it.
    pub(crate) fn sent_counts(&self) -> SentCounts {
        SentCounts::of_actions(&self.design, &self.result.actions)
    }

    /// Returns the number of bytes of the packets of the frame, without scores.
    pub(crate) fn sent_bytes(&self) -> Result<u64, SimulatorError> {
        let layout = packet_layout(&self.design, PacketContent::Plain)?;
        Ok(packet_bytes(&layout, &self.result.actions))
    }

    /// Makes the packets of the frame of the values that its regions send.
    pub(crate) fn packets(
        &self,
        values: &SentValues,
        content: PacketContent,
    ) -> Result<Vec<u8>, SimulatorError> {
        let layout = packet_layout(&self.design, content)?;
        let start = FrameStart {
            number: wrapped_number(self.number),
            time: self.time_us,
            is_first: self.is_first,
            // Versions of maps wrap around, see the page on packets.
            map_version: u16::try_from(self.maps_set() & u64::from(u16::MAX)).unwrap_or_default(),
        };
        let mut bytes = Vec::new();
        write_kept_packets(&mut bytes, &layout, &self.result, values, start)?;
        Ok(bytes)
    }

    /// Explains the decision for the region at this column and row from its scores.
    pub(crate) fn explain(
        &self,
        (x, y): (u32, u32),
    ) -> Result<DecisionExplanation, SimulatorError> {
        let (columns, rows) = (self.design.columns(), self.design.rows());
        if x >= columns || y >= rows {
            return Err(SimulatorError::NoSuchRegion { x, y, columns, rows });
        }
        let region = y * columns + x;
        let (at, result) = (region as usize, &self.result);
        let decided = DecidedRegion {
            class: self.classes.as_ref().map_or(RegionClass::Normal, |classes| classes.map[at]),
            scores: result.scores.iter().map(|scores| scores[at]).collect(),
            displacement: result.displacements.get(at).copied(),
            changed: result.temporal_count[at],
            srs: result.srs[at],
            trs: result.trs[at],
            action: result.actions[at],
        };
        let moment = (self.number, self.name.as_deref(), self.time_us);
        Ok(DecisionExplanation::from_scores(&self.design, moment, region, &decided))
    }
}
