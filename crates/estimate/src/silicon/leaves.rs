// SPDX-License-Identifier: MIT OR Apache-2.0
//! The leaf modules of a design, each mapped by itself.

use serde::{Deserialize, Serialize};

use super::cell_totals::CellTotals;
use super::error::SiliconError;
use super::library::LibertyLibrary;
use crate::netlist::AreaNetlist;

/// A leaf module that was mapped by itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SiliconLeaf {
    /// The name of the module.
    pub module: String,
    /// The parameters as `NAME=VALUE`.
    pub parameters: Vec<String>,
    /// The number of instances in the module whose leaves are listed.
    pub instances: u64,
    /// The cells of one instance, without the modules inside it.
    pub cells: CellTotals,
}

/// Lists the modules inside `top`, its own cells first. Instances of one module with the same
/// parameters share a row.
pub(super) fn list_leaves(
    netlist: &AreaNetlist,
    library: &LibertyLibrary,
    top: &str,
) -> Result<Vec<SiliconLeaf>, SiliconError> {
    let mut leaves: Vec<SiliconLeaf> = Vec::new();
    let inside = netlist.instances(top, &[])?;
    for (name, instances) in std::iter::once((top.to_owned(), 1)).chain(inside) {
        let module = netlist.module(&name)?;
        let cells = CellTotals::of_own_cells(netlist, library, &name)?;
        let (module, parameters) = (module.source_name.clone(), module.parameters.clone());
        let same = |leaf: &&mut SiliconLeaf| {
            leaf.module == module && leaf.parameters == parameters && leaf.cells == cells
        };
        match leaves.iter_mut().find(same) {
            Some(leaf) => leaf.instances += instances,
            None => leaves.push(SiliconLeaf { module, parameters, instances, cells }),
        }
    }
    let own = leaves.len().min(1);
    leaves[own..].sort_by(|a, b| (&a.module, &a.parameters).cmp(&(&b.module, &b.parameters)));
    Ok(leaves)
}
