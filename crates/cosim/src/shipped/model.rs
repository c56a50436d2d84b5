// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the benches and diagrams ask of the cycle-level model of any organization.

use crate::layout::Layout;
use foveate_design::Design;
use foveate_frame::Frame;
use foveate_model::Thresholds;

/// A cycle-level model with its values in records.
pub(crate) trait Model {
    /// Pixels that the port takes at once.
    fn width(&self) -> usize;
    /// What the pixel port takes of a frame, one after the other.
    fn beats(&self, part: &Design, frame: &Frame) -> Vec<Vec<u16>>;
    /// One edge.
    fn clock(
        &mut self,
        applied: &Applied<'_>,
        inputs: &Layout,
        outputs: &Layout,
        record: &mut Record,
    );
    /// As many edges without a pixel as [`Model::quiet_clocks`] says, at once.
    fn skip(
        &mut self,
        applied: &Applied<'_>,
        inputs: &Layout,
        outputs: &Layout,
        record: &mut Record,
    );
    /// For how many clocks without a pixel the outputs stay as they are.
    fn quiet_clocks(&self) -> u64;
    /// Whether a pixel is taken.
    fn is_ready(&self) -> bool;
    /// Clocks after the last pixel of a frame until everything has been decided that does not wait for
    /// another frame; more where the model is ready again before.
    fn settling_clocks(&self) -> u64;
    /// Frames that must follow before the pixels of a frame have left.
    fn frames_behind(&self) -> u32;
}

/// What is applied for a clock.
pub(crate) struct Applied<'a> {
    pub(crate) reset: bool,
    pub(crate) valid: bool,
    pub(crate) pixels: &'a [u16],
    pub(crate) thresholds: &'a Thresholds,
}

/// What goes in and what comes out, as bytes.
pub(crate) struct Record {
    pub(crate) input: Vec<u8>,
    pub(crate) expected: Vec<u8>,
}
