// SPDX-License-Identifier: MIT OR Apache-2.0
//! The camera's choices as the Verilog knows them: flags. A new reference, or something else to show of irrelevant
//! regions, has to be decided here before anything is generated.

use foveate_camera::{Camera, Irrelevant, Reference};

/// `LAST_SENT`: a region is compared with what was sent of it last, and not with the frame before.
pub(crate) fn is_last_sent(camera: &Camera) -> bool {
    match camera.temporal().reference {
        Reference::Previous => false,
        Reference::LastSent => true,
    }
}

/// `BLANKS`: an irrelevant region becomes black, and so has no reference.
pub(crate) fn blanks(camera: &Camera) -> bool {
    match camera.irrelevant() {
        Irrelevant::Zero => true,
        Irrelevant::Hold => false,
    }
}
