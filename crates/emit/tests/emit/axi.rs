// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cores on AXI: no tool warns of them, and their registers have distinct places and names.

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use crate::common::{covering_values, design, every_design, every_design_on_a_bus, has_tclsh};
use foveate_design::Hardware;
use foveate_emit::{
    AXI_TOP, FieldKind, Prefix, SourceFile, array_table, axi_modules, axi_registers, core_files,
};
use foveate_tools::{
    Source, Tool, Toolchain,
    testing::{require_tools, sample},
    verilator,
};
use rayon::prelude::*;

#[test]
fn verilator_has_no_warning_for_cores_on_axi() {
    if !require_tools(&[Tool::Verilator]) {
        return;
    }
    let toolchain = Toolchain::system();
    let check = |toml: &String| {
        let files = axi_modules(&design(toml)).unwrap();
        let sources: Vec<Source> = files.into_iter().map(Source::from).collect();
        let said = verilator::lint(&toolchain, &sources, AXI_TOP, None).err()?;
        Some(format!("{toml}{said}"))
    };
    let found: Vec<String> =
        covering_values(every_design_on_a_bus()).par_iter().filter_map(check).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn registers_and_fields_have_places_and_names_of_their_own() {
    let buses = every_design_on_a_bus().into_iter().map(|toml| {
        let design = design(&toml);
        let Hardware::Raster(own) = design.hardware() else { panic!("{toml}") };
        (axi_registers(design.with_hardware(own)), toml)
    });
    // The registers of arrays on a board leave the upper half of the addresses to the captured
    // frame.
    let arrays = every_design().into_iter().filter_map(|toml| {
        let list = array_table(design(&toml).as_pipelined()?);
        assert!(list.iter().all(|register| register.address < 0x800), "{toml}");
        Some((list, toml))
    });
    for (list, toml) in buses.chain(arrays) {
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
                    FieldKind::Constant(value)
                    | FieldKind::Control { reset: value }
                    | FieldKind::Threshold { reset: value } => assert!(fits(value), "{register:?}"),
                    FieldKind::Status
                    | FieldKind::Command
                    | FieldKind::Event
                    | FieldKind::External { .. } => {}
                }
            }
            assert!(end <= 32, "{register:?}");
        }
    }
}

/// Runs `package_ip.tcl` of a core, with an edit, where stubs check what it requests from Vivado.
fn run_package_ip(files: &[SourceFile], fault: Option<(&str, &str)>) -> Result<String, String> {
    let dir = tempfile::tempdir().unwrap();
    for file in files {
        let path = dir.path().join(&file.path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let mut contents = file.contents.clone();
        if let (Some((from, to)), "package_ip.tcl") = (fault, file.path.as_str()) {
            assert_eq!(contents.matches(from).count(), 1, "`{from}`");
            contents = contents.replace(from, to);
        }
        fs::write(path, contents).unwrap();
    }
    let stub = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/emit/vivado_stub.tcl");
    let run = Command::new("tclsh").args([stub, "package_ip.tcl"]).current_dir(dir.path()).output();
    let output = run.unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if output.status.success() { Ok(text(&output.stdout)) } else { Err(text(&output.stderr)) }
}

#[test]
fn the_script_that_packages_a_core_for_vivado_asks_for_what_is_there() {
    if !has_tclsh() {
        return;
    }
    for toml in sample(every_design_on_a_bus(), 8) {
        let files = core_files(&design(&toml), &Prefix::default());
        let said = run_package_ip(&files, None).unwrap_or_else(|error| panic!("{toml}{error}"));
        assert!(said.contains(" 6 interfaces, "), "{said}");
    }
    let files = core_files(&design(&every_design_on_a_bus()[0]), &Prefix::new("left").unwrap());
    run_package_ip(&files, None).unwrap();
    // Each planted fault must be found.
    for fault in [
        ("    rtl/left_adder.v\n", "    rtl/adder.v\n"),
        ("set top left_rcm_axi", "set top rcm_axi"),
        ("-import_files", "-import"),
        ("{s_axis_video m_axis_packets s_axi aclk aresetn interrupt_o}", "{s_axis}"),
        ("-clock aclk -reset aresetn", "-clock aclk -reset aclk"),
        ("foreach bus {s_axis_video m_axis_packets s_axi} {", "foreach bus {s_axis_video s_axi} {"),
        ("{version 0x004", "{version 0x000"),
        ("{version 0x004", "{identity 0x004"),
        ("{version 0x004", "{version 0x1004"),
        ("{height 16 16", "{height 15 16"),
        ("set_property slave_memory_map_ref", "# set_property"),
        ("ipx::save_core $core", ""),
        ("ipx::create_xgui_files", "ipx::create_gui_files"),
        ("set_property range 4096", "set_property size 4096"),
    ] {
        assert!(run_package_ip(&files, Some(fault)).is_err(), "not seen: {fault:?}");
    }
}
