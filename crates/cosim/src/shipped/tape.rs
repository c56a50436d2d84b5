// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors under way: packed into text, and counted.

use super::tally::{Counter, Tally};
use crate::error::CosimError;
use crate::layout::Layout;
use crate::packer::Packer;
use foveate_design::{Design, Port};
use std::path::Path;

/// Takes clocks; what it makes of them stays in memory.
pub(super) struct Tape {
    pub(super) inputs: Layout,
    pub(super) outputs: Layout,
    packer: Packer<Vec<u8>>,
    counter: Counter,
    clocks: u64,
}

impl Tape {
    pub(super) fn new(part: &Design, ports: &[Port]) -> Self {
        let (inputs, outputs) = (Layout::inputs(ports), Layout::outputs(ports));
        Self {
            packer: Packer::new(&inputs, &outputs, Vec::new()),
            counter: Counter::new(part, &outputs),
            inputs,
            outputs,
            clocks: 0,
        }
    }

    /// So many clocks with the same inputs and outputs.
    pub(super) fn push(
        &mut self,
        input: &[u8],
        expected: &[u8],
        clocks: u64,
    ) -> Result<(), CosimError> {
        self.counter.see(&self.outputs, expected);
        self.clocks += clocks;
        let pushed = self.packer.push(input, expected, clocks);
        pushed.map_err(CosimError::io("write", Path::new("vectors")))
    }

    /// What the vectors show, their clocks, and the vectors.
    pub(super) fn finish(self) -> Result<(Tally, u64, String), CosimError> {
        let bytes = self.packer.finish();
        let bytes = bytes.map_err(CosimError::io("write", Path::new("vectors")))?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        Ok((self.counter.finish(&self.outputs), self.clocks, text))
    }
}
