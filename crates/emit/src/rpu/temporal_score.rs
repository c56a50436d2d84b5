// SPDX-License-Identifier: MIT OR Apache-2.0
//! The values that a pipelined RPU compares pixels with, and those that it stores for that purpose.
//! Both follow from the reference.

use foveate_camera::{ReferencePolicy, ReferenceWriteTime};
use foveate_design::PipelinedDesign;

/// A stored frame that the temporal score may be computed against.
pub(super) struct ReferenceCandidate {
    pub(super) name: &'static str,
    /// The Verilog condition under which a pixel counts as changed.
    pub(super) hit: &'static str,
}

/// Returns whether the frame decided last is kept after the next frame has arrived. It is kept with
/// a second pass, if its scored pixels leave or become references.
pub(super) fn keeps_second_frame(design: PipelinedDesign<'_>) -> bool {
    let become_references = match design.temporal().reference.write_time() {
        ReferenceWriteTime::EveryFrame => false,
        ReferenceWriteTime::WhenSent => true,
    };
    design.has_second_pass() && (become_references || !design.has_separate_raw_pixels())
}

/// Returns the stored frames for which changed pixels are counted. With a second pass the decision
/// of the previous frame comes too late to choose between the previous frame and the pixels sent
/// before it, so changes against both are counted.
pub(super) fn reference_candidates(
    reference: ReferencePolicy,
    second_pass: bool,
    deep: bool,
) -> Vec<ReferenceCandidate> {
    let previous = |hit| ReferenceCandidate { name: "previous", hit };
    let sent = |hit| ReferenceCandidate { name: "sent", hit };
    match (reference, second_pass, deep) {
        (ReferencePolicy::Previous, _, _) => vec![previous("!stored || previous_changed")],
        (ReferencePolicy::LastSent, false, false) => vec![sent("!sent_valid || sent_changed")],
        (ReferencePolicy::LastSent, false, true) => {
            vec![sent("!sent_valid || (forward ? previous_changed : sent_changed)")]
        }
        (ReferencePolicy::LastSent, true, false) => {
            vec![previous("previous_changed"), sent("sent_changed")]
        }
        (ReferencePolicy::LastSent, true, true) => {
            vec![previous("previous_changed"), sent("forward ? second_changed : sent_changed")]
        }
    }
}

/// Returns the values that a pixel is compared with. A deep RPU compares before it is decided
/// whether the pixel sent last is that of the frame decided last, so it compares with both.
pub(super) fn compared_values(
    reference: ReferencePolicy,
    second_pass: bool,
    deep: bool,
) -> Vec<&'static str> {
    match (reference, second_pass, deep) {
        (ReferencePolicy::Previous, _, _) => vec!["previous"],
        (ReferencePolicy::LastSent, false, false) => vec!["sent"],
        (ReferencePolicy::LastSent, true, false) | (ReferencePolicy::LastSent, false, true) => {
            vec!["previous", "sent"]
        }
        (ReferencePolicy::LastSent, true, true) => vec!["previous", "second", "sent"],
    }
}

/// Returns the flags that this design does not use.
pub(super) fn unused_flags(reference: ReferencePolicy, second_pass: bool) -> Vec<&'static str> {
    match (reference, second_pass) {
        (ReferencePolicy::Previous | ReferencePolicy::LastSent, true) => vec![],
        (ReferencePolicy::Previous, false) => vec!["second"],
        (ReferencePolicy::LastSent, false) => vec!["second", "stored"],
    }
}
