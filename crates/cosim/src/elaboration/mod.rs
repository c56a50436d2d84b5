// SPDX-License-Identifier: MIT OR Apache-2.0
//! The modules and parameter values that a run elaborates, from Verilator's elaboration of the
//! Verilog.
//!
//! A module with a `generate` branch for large frames is reached in the text, but a simulation of a
//! small frame never sees that branch. So both the generated core and the simulated part are
//! elaborated, and the modules with their parameter values are compared. [`crate::hierarchy`] finds
//! files that nothing instantiates.

mod tile;
mod variant;
mod wiring;
mod xml;

use crate::error::CosimError;
use crate::level::Level;
use foveate_design::{Array, ConfigError, Design};
use foveate_emit::{Parameter, Prefix, SourceFile, Top};
use foveate_toolchain::{Source, Toolchain, verilator};
use std::collections::BTreeSet;
use std::io::BufReader;
pub(crate) use tile::Tile;
pub use variant::NotElaborated;
pub(crate) use variant::Variant;

/// The elaborated hierarchy below a top.
#[derive(Debug, Default)]
pub(crate) struct Elaboration {
    /// The modules, each with the values of its parameters.
    pub(crate) variants: BTreeSet<Variant>,
    /// The instances in the top, in order.
    pub(crate) tiles: Vec<Tile>,
}

impl Elaboration {
    fn of(
        sources: &[Source],
        top: &str,
        parameters: &[Parameter],
        toolchain: &Toolchain,
    ) -> Result<Self, CosimError> {
        let text = verilator::elaborate(toolchain, sources, top, parameters)?;
        xml::read(BufReader::new(text.as_slice()), top)
    }
}

/// Returns the modules with parameter values that the design has and no run at one of these levels
/// elaborates. Module names begin with `prefix`. An array of copies of `rpu` may be larger than its
/// simulated part if each copy is connected to its own lanes.
///
/// # Errors
/// Fails if Verilator is missing or refuses the Verilog, or the toolchain's flag has stopped it.
pub fn not_elaborated(
    design: &Design,
    sources: &[SourceFile],
    prefix: &Prefix,
    levels: &[Level],
    toolchain: &Toolchain,
) -> Result<Vec<NotElaborated>, CosimError> {
    let simulated = levels.iter().map(|level| Ok((level.top(), level.design(design)?)));
    let simulated = simulated.collect::<Result<Vec<_>, ConfigError>>()?;
    let is_simulated = |top: Top| {
        let same = |part: &Design| top.parameters(part) == top.parameters(design);
        simulated.iter().any(|(other, part)| *other == top && same(part))
    };
    let open: Vec<Top> = [Top::Rpu, Top::Rcm]
        .into_iter()
        .filter(|top| {
            crate::hierarchy::declares(sources, &prefix.name(top.module())) && !is_simulated(*top)
        })
        .collect();
    if open.is_empty() {
        return Ok(Vec::new());
    }
    let named: Vec<Source> =
        sources.iter().map(|file| (file.path.clone(), file.contents.clone())).collect();
    let elaborate = |top: Top, part: &Design| {
        Elaboration::of(&named, &prefix.name(top.module()), &top.parameters(part), toolchain)
    };
    let mut seen = BTreeSet::new();
    for (top, part) in &simulated {
        seen.append(&mut elaborate(*top, part)?.variants);
    }
    let mut left = Vec::new();
    for top in open {
        let whole = elaborate(top, design)?;
        let is_wired = match design.unit().array {
            Array::Copies => {
                wiring::is_right(design, &whole.tiles, &prefix.name(Top::Rpu.module()))
            }
            Array::Whole => false,
        };
        let is_own = |variant: &Variant| variant.module == prefix.name(top.module());
        let unseen = whole.variants.into_iter().filter(|variant| !seen.contains(variant));
        let unseen = unseen.filter(|variant| !(is_wired && is_own(variant)));
        left.extend(unseen.map(|variant| variant.beside(&seen)));
    }
    Ok(left)
}
