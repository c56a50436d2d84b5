// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog of a design, in compile order.

use crate::organization::emitter;
use crate::verilog_text::module_file;
use crate::{SourceFile, Top, leaf, leaf_parts};
use foveate_design::Design;

/// Returns the modules that `top` elaborates, each after those it instantiates. Smaller grids need
/// no other modules.
#[must_use]
pub fn verilog(design: &Design, top: Top) -> Vec<SourceFile> {
    let own = emitter(design);
    let lone = design.lone_unit();
    let of_lone = emitter(&lone);
    let whole = match top {
        Top::Rpu => &lone,
        Top::Rcm => design,
    };
    let of_whole = emitter(whole);
    let is_taken = |leaf: &str, part: &str| of_whole.has_part(leaf, part);
    let leaves = leaf::leaves_with_parts(own.direct_leaves(), is_taken).map(|leaf| {
        // Both tops get the same text of a leaf: the text fits the smaller top, whose parts both
        // tops elaborate.
        let is_whole = leaf.uses.iter().all(|part| of_lone.has_part(leaf.name, part));
        module_file(
            leaf.name,
            leaf_parts::shipped_text(leaf, &of_lone.leaf_parameters(leaf.name), is_whole),
        )
    });
    leaves.chain(own.modules(top)).collect()
}
