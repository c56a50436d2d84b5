// SPDX-License-Identifier: MIT OR Apache-2.0
//! The receiver of the clocks that a driver simulates.

use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::recording::Recorder;
use foveate_design::PortRole;

/// A receiver of clocks: a recording on disk, the vectors of a bench, or a diagram.
pub(crate) trait ClockReceiver {
    fn inputs(&self) -> &RecordLayout;

    fn outputs(&self) -> &RecordLayout;

    /// Takes `clocks` clocks with the same inputs and outputs.
    ///
    /// # Errors
    /// Fails if a file cannot be written.
    fn add_clocks(&mut self, input: &[u8], output: &[u8], clocks: u64) -> Result<(), CosimError>;

    /// Returns true if the module has an input or output of this role.
    fn has_port(&self, role: PortRole) -> bool {
        let mut fields = self.inputs().fields().iter().chain(self.outputs().fields());
        fields.any(|field| field.port.role == role)
    }
}

impl ClockReceiver for Recorder {
    fn inputs(&self) -> &RecordLayout {
        self.inputs()
    }

    fn outputs(&self) -> &RecordLayout {
        self.outputs()
    }

    fn add_clocks(&mut self, input: &[u8], output: &[u8], clocks: u64) -> Result<(), CosimError> {
        (0..clocks).try_for_each(|_| self.push(input, output))
    }
}
