// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which synthesis a design asks for: its unit, the array around it, and their Verilog.

use foveate_design::{Design, Organization};
use foveate_emit::{SourceFile, Top};
use foveate_toolchain::{Source, sources_sha256};

use crate::EstimateJob;

/// A lane of the serial organization.
const LANE: &str = "serial_lane";

impl EstimateJob {
    /// The synthesis of a design's freshly generated Verilog.
    #[must_use]
    pub fn of(design: &Design, top: Top) -> Self {
        Self::with_sources(design, top, sources(foveate_emit::verilog(design, top)))
    }

    /// The synthesis of a design from this Verilog. A serial array and its lone lane have each a
    /// module of their own; a pipelined one is made of RPUs.
    #[must_use]
    pub fn with_sources(design: &Design, top: Top, verilog: Vec<Source>) -> Self {
        let (unit, array, units) = match (design.organization(), top) {
            (Organization::Pipelined, _) => (Top::Rpu.module(), Top::Rcm, design.regions()),
            (Organization::Serial, Top::Rcm) => (LANE, Top::Rcm, design.lanes()),
            (Organization::Serial, Top::Rpu) => (LANE, Top::Rpu, 1),
        };
        let unit_name = match design.organization() {
            Organization::Pipelined => "RPU",
            Organization::Serial => "lane",
        };
        let parameters = array.parameters(design).into_iter();
        Self {
            sources: verilog,
            unit: unit.to_owned(),
            unit_name: unit_name.to_owned(),
            units: units.into(),
            array: array.module().to_owned(),
            parameters: parameters.map(|(name, value)| (name.to_owned(), value)).collect(),
            regions: design.regions().into(),
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
