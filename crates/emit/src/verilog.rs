// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog of a design, in compile order.

use crate::organization::Emitter;
use crate::text::file;
use crate::{SourceFile, Top, leaf};
use foveate_design::Design;

/// The modules that `top` is made of, each after those it instantiates.
#[must_use]
pub fn verilog(design: &Design, top: Top) -> Vec<SourceFile> {
    let emitter = Emitter::of(design);
    let leaves = leaf::with_parts((emitter.leaves)(design))
        .map(|leaf| file(leaf.name, leaf.contents.to_owned()));
    leaves.chain((emitter.modules)(design, top)).collect()
}
