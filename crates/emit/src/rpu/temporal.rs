// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a pipelined RPU compares pixels with, and what it keeps for that: it follows from the reference.

use foveate_design::{PipelinedDesign, Reference, Written};

/// Something that the temporal score may have to compare with.
pub(super) struct Candidate {
    pub(super) name: &'static str,
    /// Whether a pixel counts as changed.
    pub(super) hit: &'static str,
}

/// Whether the frame decided last is kept when another has come since: with a second pass, if its scored pixels leave
/// or become references.
pub(super) fn keeps_second(design: PipelinedDesign<'_>) -> bool {
    let become_references = match design.temporal().reference.written() {
        Written::WithEveryFrame => false,
        Written::WhenSent => true,
    };
    design.has_second_pass() && (become_references || !design.keeps_raw())
}

/// With a second pass the decision of the previous frame comes too late to choose between the
/// previous frame and what was sent before, so both are counted.
pub(super) fn candidates(reference: Reference, second_pass: bool, deep: bool) -> Vec<Candidate> {
    let previous = |hit| Candidate { name: "previous", hit };
    let sent = |hit| Candidate { name: "sent", hit };
    match (reference, second_pass, deep) {
        (Reference::Previous, _, _) => vec![previous("!stored || previous_changed")],
        (Reference::LastSent, false, false) => vec![sent("!sent_valid || sent_changed")],
        (Reference::LastSent, false, true) => {
            vec![sent("!sent_valid || (forward ? previous_changed : sent_changed)")]
        }
        (Reference::LastSent, true, false) => {
            vec![previous("previous_changed"), sent("sent_changed")]
        }
        (Reference::LastSent, true, true) => {
            vec![previous("previous_changed"), sent("forward ? second_changed : sent_changed")]
        }
    }
}

/// What a pixel is compared with. A deep RPU compares before it is decided whether the pixel sent last is that
/// of the frame decided last, so it compares with both.
pub(super) fn compared(reference: Reference, second_pass: bool, deep: bool) -> Vec<&'static str> {
    match (reference, second_pass, deep) {
        (Reference::Previous, _, _) => vec!["previous"],
        (Reference::LastSent, false, false) => vec!["sent"],
        (Reference::LastSent, true, false) | (Reference::LastSent, false, true) => {
            vec!["previous", "sent"]
        }
        (Reference::LastSent, true, true) => vec!["previous", "second", "sent"],
    }
}

/// Flags that this design has no use for.
pub(super) fn unused(reference: Reference, second_pass: bool) -> Vec<&'static str> {
    match (reference, second_pass) {
        (Reference::Previous | Reference::LastSent, true) => vec![],
        (Reference::Previous, false) => vec!["second"],
        (Reference::LastSent, false) => vec!["second", "stored"],
    }
}
