// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files of a core beside its Verilog.

use crate::{SourceFile, Top, verilog};
use foveate_spec::Design;

/// Every file of the core of `design`.
#[must_use]
pub fn core(design: &Design) -> Vec<SourceFile> {
    verilog(design, Top::Rcm)
}
