// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which synthesis a design asks for: its unit, the array around it, and their Verilog.

use foveate_design::Design;
use foveate_emit::Top;
use foveate_toolchain::{Source, SynthesisJob, sources_sha256};

use crate::EstimateJob;

impl EstimateJob {
    /// The synthesis of a design's freshly generated Verilog.
    #[must_use]
    pub fn of(design: &Design, top: Top) -> Self {
        Self::with_sources(design, top, sources(design, top))
    }

    /// The synthesis of a design from this Verilog. Where the array is not made of modules
    /// `rpu`, that is an array of its own.
    #[must_use]
    pub fn with_sources(design: &Design, top: Top, verilog: Vec<Source>) -> Self {
        let unit = design.unit();
        let array = top.array(design);
        let units = match array {
            Top::Rpu => 1,
            Top::Rcm => unit.count,
        };
        Self {
            synthesis: SynthesisJob {
                sources: verilog,
                unit: unit.module.to_owned(),
                array: array.module().to_owned(),
                parameters: array.parameters(design),
            },
            unit_name: unit.name.to_owned(),
            units: units.into(),
            regions: design.regions().into(),
            clocks_per_frame: design.timing().clocks_per_frame(),
            rpu_sha256: sources_sha256(&sources(design, Top::Rpu)),
            leaves_of: None,
        }
    }
}

pub(crate) fn sources(design: &Design, top: Top) -> Vec<Source> {
    foveate_emit::verilog(design, top).into_iter().map(Source::from).collect()
}
