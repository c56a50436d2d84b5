// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lists the leaf modules of a module under the names and parameters of the source.

use std::collections::BTreeMap;

use crate::error::EstimateError;
use crate::netlist::AreaNetlist;
use crate::report::LeafArea;

/// Returns the areas of all modules inside `top`, its own cells first. Instances of one module with
/// the same parameters and area share a row.
pub(crate) fn leaf_areas(top: &str, netlist: &AreaNetlist) -> Result<Vec<LeafArea>, EstimateError> {
    let mut rows = BTreeMap::new();
    for (name, count) in netlist.instances(top, &[])? {
        let module = netlist.module(&name)?;
        let row = (&module.source_name, &module.parameters, netlist.own_area(&name)?);
        *rows.entry(row).or_insert(0) += count;
    }
    let own = LeafArea {
        module: top.to_owned(),
        parameters: Vec::new(),
        instances: 1,
        area: netlist.own_area(top)?,
    };
    let below = rows.into_iter().map(|((module, parameters, area), instances)| LeafArea {
        module: module.clone(),
        parameters: parameters.clone(),
        instances,
        area,
    });
    Ok(std::iter::once(own).chain(below).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const OLD: &[u8] = include_bytes!("../tests/fixtures/leaves_yosys_0.23.json");
    const NEW: &[u8] = include_bytes!("../tests/fixtures/leaves_yosys_0.70.json");

    #[test]
    fn leaves_have_names_parameters_and_counts() {
        for json in [OLD, NEW] {
            let leaves = leaf_areas("rpu", &AreaNetlist::parse("netlist", json).unwrap()).unwrap();
            let row = |leaf: &LeafArea| {
                format!("{} {} {}", leaf.instances, leaf.module, leaf.parameters.join(" "))
            };
            let expected = [
                "1 rpu ",
                "2 adder W=8",
                "1 adder W=9",
                "1 pair ",
                "1 ram ADDRESS_WIDTH=6 DEPTH=64 LATENCY=1 WIDTH=8",
            ];
            assert_eq!(leaves.iter().map(row).collect::<Vec<_>>(), expected);
            assert_eq!(leaves[4].area.lut_memory, 8);
        }
    }
}
