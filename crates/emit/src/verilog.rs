// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog of a design, in compile order.

use crate::organization::Emitter;
use crate::text::file;
use crate::{SourceFile, Top, branch, leaf};
use foveate_design::Design;

/// The modules that `top` elaborates, each after those it instantiates. Smaller grids need no others.
#[must_use]
pub fn verilog(design: &Design, top: Top) -> Vec<SourceFile> {
    let emitter = Emitter::of(design);
    let lone = design.lone_unit();
    let whole = match top {
        Top::Rpu => &lone,
        Top::Rcm => design,
    };
    let leaves = leaf::with_parts(whole, (emitter.leaves)(design)).map(|leaf| {
        // The same for both tops: what the smaller of them elaborates both have.
        file(leaf.name, branch::text(&lone, leaf, &(emitter.values)(&lone, leaf.name)))
    });
    leaves.chain((emitter.modules)(design, top)).collect()
}
