// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the benches and diagrams ask of the cycle-level model of any organization.

use crate::layout::Layout;
use crate::stimulus::Applied;
use foveate_design::Port;
use foveate_frame::Frame;

/// A cycle-level model with its values in records.
pub(crate) trait Model {
    /// Pixels that the port takes at once.
    fn width(&self) -> usize;
    /// What the pixel port takes of a frame, one after the other.
    fn beats(&self, frame: &Frame) -> Vec<Vec<u16>>;
    /// One edge.
    fn clock(&mut self, applied: &Applied<'_>, record: &mut Record);
    /// As many edges without a pixel as [`Model::quiet_clocks`] says, at once. Where something may be seen
    /// at every clock, that is one edge.
    fn skip(&mut self, applied: &Applied<'_>, record: &mut Record) {
        self.clock(applied, record);
    }
    /// For how many clocks without a pixel the outputs stay as they are.
    fn quiet_clocks(&self) -> u64;
    /// Whether a pixel is taken.
    fn is_ready(&self) -> bool;
    /// Clocks after the last pixel of a frame until everything has been decided that does not wait for
    /// another frame; more where the model is ready again before.
    fn settling_clocks(&self) -> u64;
    /// Whether a sink that stalls is ready at the next edge: at some, where that tells more of what is lost.
    fn takes_while_stalling(&mut self) -> bool {
        false
    }
    /// Frames that must follow before the pixels of a frame have left.
    fn frames_behind(&self) -> u32;
}

/// What goes in and what comes out at one clock, as bytes.
pub(crate) struct Record {
    pub(crate) inputs: Layout,
    pub(crate) outputs: Layout,
    pub(crate) input: Vec<u8>,
    pub(crate) expected: Vec<u8>,
}

impl Record {
    pub(crate) fn of(ports: &[Port]) -> Self {
        let (inputs, outputs) = (Layout::inputs(ports), Layout::outputs(ports));
        Self { input: inputs.record(), expected: outputs.record(), inputs, outputs }
    }
}
