// SPDX-License-Identifier: MIT OR Apache-2.0
//! The modules and parameter values that a run elaborates, from Verilator's elaboration of the
//! Verilog.
//!
//! A module with a `generate` branch for large frames is reached in the text, but a simulation of a
//! small frame never sees that branch. So both the generated core and the simulated part are
//! elaborated, and the modules with their parameter values are compared. [`crate::hierarchy`] finds
//! files that nothing instantiates.

mod array_instance;
mod variant;
mod wiring_check;
mod xml_reader;

use crate::error::CosimError;
use crate::level::CosimLevel;
pub(crate) use array_instance::ArrayInstance;
use foveate_camera::ConfigError;
use foveate_design::{ArrayStructure, Design};
use foveate_emit::{Parameter, Prefix, SourceFile, Top};
use foveate_tools::{Source, Toolchain, verilator};
use std::collections::BTreeSet;
use std::io::BufReader;
pub(crate) use variant::ModuleVariant;
pub use variant::UnelaboratedVariant;

/// The elaborated hierarchy below a top.
#[derive(Debug, Default)]
pub(crate) struct Elaboration {
    /// The modules, each with the values of its parameters.
    pub(crate) variants: BTreeSet<ModuleVariant>,
    /// The instances in the top, in order.
    pub(crate) instances: Vec<ArrayInstance>,
}

impl Elaboration {
    fn elaborate(
        sources: &[Source],
        top: &str,
        parameters: &[Parameter],
        toolchain: &Toolchain,
    ) -> Result<Self, CosimError> {
        let text = verilator::elaborate(toolchain, sources, top, parameters)?;
        xml_reader::read(BufReader::new(text.as_slice()), top)
    }
}

/// Returns the modules with parameter values that the design has and no run at one of these levels
/// elaborates. Module names begin with `prefix`. An array of copies of `rpu` may be larger than its
/// simulated part if each copy is connected to its own lanes.
///
/// # Errors
/// Fails if Verilator is missing or refuses the Verilog, or the toolchain's flag has stopped it.
pub fn unelaborated_variants(
    design: &Design,
    sources: &[SourceFile],
    prefix: &Prefix,
    levels: &[CosimLevel],
    toolchain: &Toolchain,
) -> Result<Vec<UnelaboratedVariant>, CosimError> {
    let simulated = levels.iter().map(|level| Ok((level.top(), level.design(design)?)));
    let simulated = simulated.collect::<Result<Vec<_>, ConfigError>>()?;
    let is_simulated = |top: Top| {
        let same = |part: &Design| top.parameters(part) == top.parameters(design);
        simulated.iter().any(|(other, part)| *other == top && same(part))
    };
    let open: Vec<Top> = [Top::Rpu, Top::Rcm]
        .into_iter()
        .filter(|top| {
            crate::hierarchy::declares(sources, &prefix.prefixed_name(top.module()))
                && !is_simulated(*top)
        })
        .collect();
    if open.is_empty() {
        return Ok(Vec::new());
    }
    let named: Vec<Source> =
        sources.iter().map(|file| (file.path.clone(), file.contents.clone())).collect();
    let elaborate = |top: Top, part: &Design| {
        Elaboration::elaborate(
            &named,
            &prefix.prefixed_name(top.module()),
            &top.parameters(part),
            toolchain,
        )
    };
    let mut seen = BTreeSet::new();
    for (top, part) in &simulated {
        seen.append(&mut elaborate(*top, part)?.variants);
    }
    let mut left = Vec::new();
    for top in open {
        let whole = elaborate(top, design)?;
        let is_wired = match design.unit().array {
            ArrayStructure::RpuCopies => wiring_check::is_wired_correctly(
                design,
                &whole.instances,
                &prefix.prefixed_name(Top::Rpu.module()),
            ),
            ArrayStructure::SharedLogic => false,
        };
        let is_own = |variant: &ModuleVariant| variant.module == prefix.prefixed_name(top.module());
        let unseen = whole.variants.into_iter().filter(|variant| !seen.contains(variant));
        let unseen = unseen.filter(|variant| !(is_wired && is_own(variant)));
        left.extend(unseen.map(|variant| variant.into_unelaborated(&seen)));
    }
    Ok(left)
}
