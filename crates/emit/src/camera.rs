// SPDX-License-Identifier: MIT OR Apache-2.0
//! The camera's choices as the Verilog knows them: flags. A new reference, or something else to show of irrelevant
//! regions, has to be decided here before anything is generated.

use foveate_camera::{Camera, Irrelevant, Reference};

/// `LAST_SENT`, and whether a pipelined RPU has a store of what was sent last: the Verilog knows two references, and the
/// flag has no third value. What else follows from the reference asks it, and not this.
pub(crate) fn last_sent(camera: &Camera) -> bool {
    match camera.temporal().reference {
        Reference::Previous => false,
        Reference::LastSent => true,
    }
}

/// `BLANKS`: an irrelevant region becomes black or shows its means, and so has no reference.
pub(crate) fn blanks(camera: &Camera) -> bool {
    match camera.irrelevant() {
        Irrelevant::Zero | Irrelevant::Mean => true,
        Irrelevant::Hold => false,
    }
}
