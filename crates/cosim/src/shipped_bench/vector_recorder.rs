// SPDX-License-Identifier: MIT OR Apache-2.0
//! The vectors of a bench while they are recorded: packed into text, and counted.

use super::tally::{TallyCounter, VectorTally};
use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::situations::SituationMonitor;
use crate::stimulus::ClockReceiver;
use crate::vector_packer::VectorPacker;
use foveate_design::{Design, Port};
use foveate_emit::Top;
use std::path::Path;

/// A recorder of clocks, which keeps the vectors in memory.
pub(super) struct VectorRecorder {
    inputs: RecordLayout,
    outputs: RecordLayout,
    packer: VectorPacker<Vec<u8>>,
    counter: TallyCounter,
    watch: SituationMonitor,
    clocks: u64,
}

impl VectorRecorder {
    pub(super) fn new(part: &Design, top: Top, ports: &[Port]) -> Self {
        let (inputs, outputs) = (RecordLayout::inputs(ports), RecordLayout::outputs(ports));
        Self {
            packer: VectorPacker::new(&inputs, &outputs, Vec::new()),
            counter: TallyCounter::new(part, &outputs),
            watch: SituationMonitor::new(part, top, &inputs, &outputs),
            inputs,
            outputs,
            clocks: 0,
        }
    }

    /// Returns the counts of what the vectors contain, the number of clocks, and the vectors as
    /// text.
    pub(super) fn finish(self) -> Result<(VectorTally, u64, String), CosimError> {
        let bytes = self.packer.finish();
        let bytes = bytes.map_err(CosimError::io("write", Path::new("vectors")))?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let situations = self.watch.occurrences();
        let tally = self.counter.finish(&self.outputs);
        Ok((VectorTally { situations, ..tally }, self.clocks, text))
    }
}

impl ClockReceiver for VectorRecorder {
    fn inputs(&self) -> &RecordLayout {
        &self.inputs
    }

    fn outputs(&self) -> &RecordLayout {
        &self.outputs
    }

    fn add_clocks(&mut self, input: &[u8], output: &[u8], clocks: u64) -> Result<(), CosimError> {
        self.counter.count_clock(&self.outputs, output);
        self.watch.add_clocks(input, output, clocks);
        self.clocks += clocks;
        let pushed = self.packer.push(input, output, clocks);
        pushed.map_err(CosimError::io("write", Path::new("vectors")))
    }
}
