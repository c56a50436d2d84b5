// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog of a design, in compile order.

use crate::leaf_files::leaf_files;
use crate::organization::emitter;
use crate::{SourceFile, Top};
use foveate_design::Design;

/// Returns the modules that `top` can elaborate, each after those it instantiates. Smaller grids
/// need no other modules.
#[must_use]
pub fn verilog(design: &Design, top: Top) -> Vec<SourceFile> {
    let own = emitter(design);
    leaf_files(own.direct_leaves()).chain(own.modules(top)).collect()
}
