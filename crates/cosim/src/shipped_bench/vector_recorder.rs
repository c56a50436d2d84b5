// SPDX-License-Identifier: MIT OR Apache-2.0
//! The vectors of a bench while they are recorded: packed into text, and counted.

use super::core_simulation::ClockRecord;
use super::tally::{TallyCounter, VectorTally};
use crate::error::CosimError;
use crate::situations::SituationMonitor;
use crate::vector_packer::VectorPacker;
use foveate_design::{Design, Port, PortRole};
use foveate_emit::Top;
use std::path::Path;

/// A recorder of clocks, which keeps the vectors in memory.
pub(super) struct VectorRecorder {
    /// The inputs and outputs of the next clock.
    pub(super) record: ClockRecord,
    packer: VectorPacker<Vec<u8>>,
    counter: TallyCounter,
    watch: SituationMonitor,
    clocks: u64,
}

impl VectorRecorder {
    pub(super) fn new(part: &Design, top: Top, ports: &[Port]) -> Self {
        let record = ClockRecord::for_ports(ports);
        Self {
            packer: VectorPacker::new(&record.inputs, &record.outputs, Vec::new()),
            counter: TallyCounter::new(part, &record.outputs),
            watch: SituationMonitor::new(part, top, &record.inputs, &record.outputs),
            record,
            clocks: 0,
        }
    }

    /// Returns true if the hardware gets a start-of-frame mark and synchronizes to it.
    pub(super) fn has_frame_sync(&self) -> bool {
        let mut fields = self.record.outputs.fields().iter();
        fields.any(|field| field.port.role == PortRole::SyncError)
    }

    /// Adds `clocks` clocks with the inputs and outputs of the record.
    pub(super) fn push(&mut self, clocks: u64) -> Result<(), CosimError> {
        let ClockRecord { outputs, input, expected, .. } = &self.record;
        self.counter.count_clock(outputs, expected);
        self.watch.add_clocks(input, expected, clocks);
        self.clocks += clocks;
        let pushed = self.packer.push(input, expected, clocks);
        pushed.map_err(CosimError::io("write", Path::new("vectors")))
    }

    /// Returns the counts of what the vectors contain, the number of clocks, and the vectors as
    /// text.
    pub(super) fn finish(self) -> Result<(VectorTally, u64, String), CosimError> {
        let bytes = self.packer.finish();
        let bytes = bytes.map_err(CosimError::io("write", Path::new("vectors")))?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let situations = self.watch.occurrences();
        let tally = self.counter.finish(&self.record.outputs);
        Ok((VectorTally { situations, ..tally }, self.clocks, text))
    }
}
