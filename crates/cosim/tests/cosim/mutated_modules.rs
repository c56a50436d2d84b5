// SPDX-License-Identifier: MIT OR Apache-2.0
//! Mutation reaches every module: each is in a design of `mutation/designs.txt`.

use foveate_cosim::CosimLevel;
use foveate_design::{Design, DesignConfig, Preset};
use foveate_emit::{LEAVES, Top, axi_modules, verilog};
use std::collections::BTreeSet;

/// Returns the modules of the design in a line: the organization, a name, and options of `cosim`.
fn modules(line: &str) -> Vec<String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let of_option = |option: &'static str| {
        words.windows(2).filter(move |pair| pair[0] == option).map(|pair| pair[1].to_owned())
    };
    let mut keys: Vec<String> = of_option("--set").collect();
    keys.push(match words[0] {
        "axi" => "hardware.organization='raster'".to_owned(),
        organization => format!("hardware.organization='{organization}'"),
    });
    if words[0] == "axi" {
        keys.push("hardware.interface='axi'".to_owned());
    }
    let bare = Preset::find("bare").unwrap().toml;
    let design = DesignConfig::from_toml_with(bare, &keys).unwrap().validate().unwrap();
    let design =
        of_option("--grid").next().map_or(design.clone(), |grid| with_grid(&design, &grid));
    let files = match words[0] {
        "axi" => axi_modules(&design).unwrap(),
        _ => verilog(&design, Top::Rcm),
    };
    files.into_iter().map(|file| file.path).collect()
}

fn with_grid(design: &Design, grid: &str) -> Design {
    let (columns, rows) = grid.split_once('x').unwrap();
    let level = CosimLevel::Rcm { columns: columns.parse().unwrap(), rows: rows.parse().unwrap() };
    level.design(design).unwrap()
}

#[test]
fn every_module_is_in_a_design_of_mutation() {
    let designs = concat!(env!("CARGO_MANIFEST_DIR"), "/../../mutation/designs.txt");
    let designs = std::fs::read_to_string(designs).unwrap();
    let lines = designs.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    let mutated: BTreeSet<String> = lines.flat_map(modules).collect();
    let rendered = ["rpu", "rcm", "rcm_axi", "axi_registers"];
    let all = LEAVES.iter().map(|leaf| leaf.name).chain(rendered);
    let missing: Vec<&str> =
        all.filter(|name| !mutated.contains(&format!("rtl/{name}.v"))).collect();
    assert!(missing.is_empty(), "no design of mutation/designs.txt has {missing:?}");
}
