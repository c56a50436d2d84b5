// SPDX-License-Identifier: MIT OR Apache-2.0
//! The synthesis of a design: its unit, the array around it, the core on AXI, and their Verilog.

use foveate_design::Design;
use foveate_emit::{AXI_TOP, SourceFile, Top, axi_modules};
use foveate_tools::{Source, SynthesisJob, sources_sha256};

use crate::EstimateJob;

impl EstimateJob {
    /// Makes the job for a design's freshly generated Verilog.
    #[must_use]
    pub fn for_design(design: &Design, top: Top) -> Self {
        Self::with_sources(design, top, sources(design, top))
    }

    /// Makes the job for a design with this Verilog. If the array does not consist of modules
    /// `rpu`, module `rpu` is an array of its own.
    #[must_use]
    pub fn with_sources(design: &Design, top: Top, verilog: Vec<Source>) -> Self {
        let unit = design.unit();
        let array = top.array_top(design);
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
            bus: match top {
                Top::Rpu => None,
                Top::Rcm => axi_modules(design).map(|verilog| SynthesisJob {
                    sources: sources_of_files(verilog),
                    unit: unit.module.to_owned(),
                    array: AXI_TOP.to_owned(),
                    parameters: Vec::new(),
                }),
            },
            rpu_sha256: sources_sha256(&sources(design, Top::Rpu)),
            leaves_of: None,
        }
    }

    /// Adds the list of separate modules: those of the unit, of the array where that says more, or
    /// of a core on AXI.
    #[must_use]
    pub fn with_leaves(self, design: &Design) -> Self {
        let of_array = design.unit().area_module.to_owned();
        let leaves_of = self.bus.as_ref().map_or(of_array, |bus| bus.array.clone());
        Self { leaves_of: Some(leaves_of), ..self }
    }
}

pub(crate) fn sources(design: &Design, top: Top) -> Vec<Source> {
    sources_of_files(foveate_emit::verilog(design, top))
}

pub(crate) fn sources_of_files(files: Vec<SourceFile>) -> Vec<Source> {
    files.into_iter().map(Source::from).collect()
}
