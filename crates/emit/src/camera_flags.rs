// SPDX-License-Identifier: MIT OR Apache-2.0
//! The camera's choices as flags of the Verilog. A new kind of reference, or a new content of
//! irrelevant regions, must be mapped to these flags before it can be generated.

use foveate_camera::{Camera, IrrelevantRendering, ReferencePolicy};

/// Returns `LAST_SENT`, which is also whether a pipelined RPU stores the pixels sent last. The
/// Verilog knows two references, so the flag has two values. Code that needs another property of
/// the reference asks the reference itself.
pub(crate) fn last_sent_flag(camera: &Camera) -> bool {
    match camera.temporal().reference {
        ReferencePolicy::Previous => false,
        ReferencePolicy::LastSent => true,
    }
}

/// Returns `BLANKS`: whether an irrelevant region becomes black or shows its means, and so loses
/// its reference.
pub(crate) fn blanks_flag(camera: &Camera) -> bool {
    match camera.irrelevant() {
        IrrelevantRendering::Zero | IrrelevantRendering::Mean => true,
        IrrelevantRendering::Hold => false,
    }
}
