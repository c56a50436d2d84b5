// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which synthesis a design asks for: its unit, the array around it, and their Verilog.

use foveate_design::Design;
use foveate_emit::{SourceFile, Top};
use foveate_toolchain::{Source, sources_sha256};

use crate::EstimateJob;

impl EstimateJob {
    /// The synthesis of a design's freshly generated Verilog.
    #[must_use]
    pub fn of(design: &Design, top: Top) -> Self {
        Self::with_sources(design, top, sources(foveate_emit::verilog(design, top)))
    }

    /// The synthesis of a design from this Verilog. Where the array is not made of modules
    /// `rpu`, that is an array of its own.
    #[must_use]
    pub fn with_sources(design: &Design, top: Top, verilog: Vec<Source>) -> Self {
        let unit = design.unit();
        let (array, units) = match top {
            Top::Rpu if !unit.rpu_in_rcm => (Top::Rpu, 1),
            Top::Rpu | Top::Rcm => (Top::Rcm, unit.count),
        };
        let parameters = array.parameters(design).into_iter();
        Self {
            sources: verilog,
            unit: unit.module.to_owned(),
            unit_name: unit.name.to_owned(),
            units: units.into(),
            array: array.module().to_owned(),
            parameters: parameters.map(|(name, value)| (name.to_owned(), value)).collect(),
            regions: design.regions().into(),
            clocks_per_frame: design.timing().clocks_per_frame(),
            rpu_sha256: sources_sha256(&sources(foveate_emit::verilog(design, Top::Rpu))),
            leaves_of: None,
        }
    }
}

/// Generated Verilog as the tools take it.
#[must_use]
pub fn sources(files: Vec<SourceFile>) -> Vec<Source> {
    files.into_iter().map(|file| (file.path, file.contents)).collect()
}
