// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cores on AXI: no tool warns of them, and their registers have places of their own.

use std::collections::BTreeSet;

use crate::common::{design, every_design_on_a_bus};
use foveate_design::Hardware;
use foveate_emit::{AXI_TOP, Kind, on_bus, registers};
use foveate_toolchain::testing::require_tools;
use foveate_toolchain::{Source, Tool, Toolchain, verilator};
use rayon::prelude::*;

#[test]
fn verilator_has_nothing_to_say_of_cores_on_a_bus() {
    if !require_tools(&[Tool::Verilator]) {
        return;
    }
    let toolchain = Toolchain::system();
    let check = |toml: &String| {
        let files = on_bus(&design(toml)).unwrap();
        let sources: Vec<Source> = files.into_iter().map(Source::from).collect();
        let said = verilator::lint(&toolchain, &sources, AXI_TOP, None).err()?;
        Some(format!("{toml}{said}"))
    };
    let found: Vec<String> = every_design_on_a_bus().par_iter().filter_map(check).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn registers_and_fields_have_places_and_names_of_their_own() {
    for toml in every_design_on_a_bus() {
        let design = design(&toml);
        let Hardware::Raster(own) = design.hardware() else { panic!("{toml}") };
        let list = registers(design.on(own));
        let addresses: BTreeSet<u32> = list.iter().map(|register| register.address).collect();
        let names: BTreeSet<&str> = list.iter().map(|register| register.name.as_str()).collect();
        assert_eq!((addresses.len(), names.len()), (list.len(), list.len()), "{toml}");
        for register in &list {
            assert!(register.address % 4 == 0 && register.address < 1 << 12, "{register:?}");
            let mut end = 0;
            for field in &register.fields {
                assert!(field.low >= end && field.width >= 1, "{register:?}");
                end = field.low + field.width;
                let fits = |value: u32| u64::from(value) < 1 << field.width;
                match field.kind {
                    Kind::Constant(value)
                    | Kind::Control { reset: value }
                    | Kind::Threshold { reset: value } => assert!(fits(value), "{register:?}"),
                    Kind::Status | Kind::Command | Kind::Event => {}
                }
            }
            assert!(end <= 32, "{register:?}");
        }
    }
}
