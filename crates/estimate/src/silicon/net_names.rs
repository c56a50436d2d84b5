// SPDX-License-Identifier: MIT OR Apache-2.0
//! The names of registers in the source, from the netlist in which cells are numbered.

use serde_json::Value;

/// Returns the name of the net that a cell drives, in place of the cell's number: `u_core/cell_9`
/// of the module `top` becomes `u_core.count_q[3]`. A port or an unknown cell keeps its name.
pub(super) fn source_name(netlist: &Value, top: &str, cell: &str) -> String {
    net_of_cell(netlist, top, cell).unwrap_or_else(|| cell.to_owned())
}

fn net_of_cell(netlist: &Value, top: &str, path: &str) -> Option<String> {
    let modules = netlist["modules"].as_object()?;
    let mut module = modules.get(top)?;
    let mut prefix = String::new();
    let mut parts: Vec<&str> = path.split('/').collect();
    let cell = parts.pop()?;
    for instance in parts {
        let kind = module["cells"][instance]["type"].as_str()?;
        module = modules.get(kind)?;
        prefix += &format!("{instance}.");
    }
    let cell = &module["cells"][cell];
    let directions = cell["port_directions"].as_object();
    let is_output = |port: &str| match directions {
        Some(directions) => directions.get(port).is_some_and(|own| own == "output"),
        None => matches!(port, "Q" | "QN" | "Q_N"),
    };
    let pins = cell["connections"].as_object()?;
    let bit = pins.iter().filter(|(port, _)| is_output(port)).find_map(|(_, bits)| bits.get(0))?;
    let nets = module["netnames"].as_object()?;
    let names = nets.iter().filter_map(|(name, net)| {
        let bits = net["bits"].as_array()?;
        let at = bits.iter().position(|own| own == bit)?;
        let is_hidden = net["hide_name"].as_u64() == Some(1) || name.starts_with('$');
        let index = if bits.len() > 1 { format!("[{at}]") } else { String::new() };
        (!is_hidden).then(|| format!("{name}{index}"))
    });
    // The shortest name is the nearest to the register.
    let name = names.min_by_key(|name| (name.len(), name.clone()))?;
    Some(prefix + &name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_register_has_the_name_of_its_net() {
        let netlist = serde_json::json!({ "modules": {
            "rcm": { "cells": { "u_core": { "type": "$paramod\\core" }, "cell_1": { "type": "DFF", "connections": { "Q": [4] } } },
                "netnames": { "go_q": { "bits": [4], "hide_name": 0 } } },
            "$paramod\\core": {
                "cells": { "cell_9": { "type": "DFF", "connections": { "D": [2], "Q": [7] } } },
                "netnames": { "u_a.count_q": { "bits": [5, 7], "hide_name": 0 }, "$1": { "bits": [7], "hide_name": 1 } },
            },
        } });
        for (cell, name) in [
            ("cell_1", "go_q"),
            ("u_core/cell_9", "u_core.u_a.count_q[1]"),
            ("valid_i", "valid_i"),
            ("u_other/cell_9", "u_other/cell_9"),
        ] {
            assert_eq!(source_name(&netlist, "rcm", cell), name);
        }
    }
}
