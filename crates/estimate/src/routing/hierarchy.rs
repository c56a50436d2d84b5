// SPDX-License-Identifier: MIT OR Apache-2.0
//! The modules of the instances. Flattening keeps the instances in the names of nets and cells
//! (`u_core.u_edge.count_q`), but not their modules, which are therefore read before it.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::error::EstimateError;

/// The modules with their instances, before flattening.
#[derive(Deserialize)]
pub(super) struct ModuleHierarchy {
    modules: BTreeMap<String, HierarchyModule>,
}

#[derive(Deserialize)]
struct HierarchyModule {
    cells: BTreeMap<String, HierarchyCell>,
}

#[derive(Deserialize)]
struct HierarchyCell {
    #[serde(rename = "type")]
    kind: String,
}

impl ModuleHierarchy {
    pub(super) fn parse(file: &'static str, json: &[u8]) -> Result<Self, EstimateError> {
        serde_json::from_slice(json)
            .map_err(|source| EstimateError::UnreadableFile { file, source })
    }

    /// Returns the source name of the module in which a name below `top` is declared.
    pub(super) fn module_of(&self, top: &str, name: &str) -> String {
        let (mut module, mut rest) = (top, name);
        while let Some((kind, inner)) = self.first_instance(module, rest) {
            (module, rest) = (kind, inner);
        }
        source_name(module).to_owned()
    }

    /// Returns the module of the instance that a name begins with, and the rest of the name. Names
    /// of instances in generated blocks contain dots, so the name is compared with all instances.
    fn first_instance<'a>(&'a self, module: &str, name: &'a str) -> Option<(&'a str, &'a str)> {
        let cells = &self.modules.get(module)?.cells;
        cells.iter().find_map(|(instance, cell)| {
            let inner = name.strip_prefix(instance.as_str())?.strip_prefix('.')?;
            self.modules.contains_key(&cell.kind).then_some((cell.kind.as_str(), inner))
        })
    }
}

/// Returns the source name of a module; one with parameters is called `$paramod\adder\WIDTH=...` or
/// `$paramod$hash\adder`.
fn source_name(module: &str) -> &str {
    if !module.starts_with("$paramod") {
        return module;
    }
    module.split('\\').nth(1).unwrap_or(module)
}
