// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which module an instance is of. Flattening keeps the instances in the names of nets and cells
//! (`u_core.u_edge.count_q`), but not their modules: they are read before it.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::error::EstimateError;

/// The modules with their instances, as they were before flattening.
#[derive(Deserialize)]
pub(super) struct Hierarchy {
    modules: BTreeMap<String, Module>,
}

#[derive(Deserialize)]
struct Module {
    cells: BTreeMap<String, Cell>,
}

#[derive(Deserialize)]
struct Cell {
    #[serde(rename = "type")]
    kind: String,
}

impl Hierarchy {
    pub(super) fn parse(file: &'static str, json: &[u8]) -> Result<Self, EstimateError> {
        serde_json::from_slice(json).map_err(|source| EstimateError::Format { file, source })
    }

    /// The source's name of the module in which a name below `top` is declared.
    pub(super) fn module_of(&self, top: &str, name: &str) -> String {
        let (mut module, mut rest) = (top, name);
        while let Some((kind, inner)) = self.enter(module, rest) {
            (module, rest) = (kind, inner);
        }
        source_name(module).to_owned()
    }

    /// The instance that a name begins with: its module, and what follows. Names of instances in generated
    /// blocks have dots of their own, so that all instances are compared.
    fn enter<'a>(&'a self, module: &str, name: &'a str) -> Option<(&'a str, &'a str)> {
        let cells = &self.modules.get(module)?.cells;
        cells.iter().find_map(|(instance, cell)| {
            let inner = name.strip_prefix(instance.as_str())?.strip_prefix('.')?;
            self.modules.contains_key(&cell.kind).then_some((cell.kind.as_str(), inner))
        })
    }
}

/// A module with parameters is called `$paramod\adder\WIDTH=...` or `$paramod$hash\adder`.
fn source_name(module: &str) -> &str {
    if !module.starts_with("$paramod") {
        return module;
    }
    module.split('\\').nth(1).unwrap_or(module)
}
