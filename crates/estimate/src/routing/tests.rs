// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests on small netlists and reports in the formats of Yosys and nextpnr.

use serde_json::{Value, json};

use super::device::DeviceFamily;
use super::job::placement_netlist;
use super::netlist::{ModuleHierarchy, PlacementNetlist};
use super::nextpnr_report::NextpnrReport;
use super::report::ClockStatistics;
use super::shortage::{ResourceShortage, resource_shortages};
use super::{ROUTE_DEVICES, RouteDevice, netlist};
use crate::error::EstimateError;

fn netlist(ports: &Value, cells: &Value) -> PlacementNetlist {
    let names = json!({
        "u_a.sum": { "hide_name": 0, "bits": [20, 21] },
        "u_a.sum_q": { "hide_name": 0, "bits": [20, 21], "offset": 4 },
        "y_o": { "hide_name": 0, "bits": [21] },
        "$auto$x": { "hide_name": 1, "bits": [30] },
        "w_LUT4_Z": { "hide_name": 0, "bits": [31] },
        "u_a.u_b.wire": { "hide_name": 0, "bits": [31] },
        "score": { "hide_name": 0, "bits": [32] },
        "score_o": { "hide_name": 0, "bits": [32] },
        "u_a.count_o": { "hide_name": 0, "bits": [32] },
        "u_b.u_c.value_i": { "hide_name": 0, "bits": [32] },
        "d_i": { "hide_name": 0, "bits": [33] },
        "u_b.d_i": { "hide_name": 0, "bits": [33] },
    });
    let top = json!({ "ports": ports, "cells": cells, "netnames": names });
    let file = json!({ "creator": "Yosys", "modules": { "rpu": top } }).to_string();
    PlacementNetlist::parse(file.as_bytes(), "rpu").unwrap().0
}

/// No step between Yosys and nextpnr improves a design, because a user has no such step. A block
/// RAM stays unchanged even if a register behind it could be its own.
#[test]
fn placement_adds_only_registers_at_the_ports() {
    let cells = json!({
        "block": {
            "type": "DP16KD", "hide_name": 0, "attributes": { "src": "a.v:1" },
            "parameters": { "REGMODE_A": "NOREG", "REGMODE_B": "NOREG", "DATA_WIDTH_A": "1001" },
            "port_directions": { "CLKA": "input", "RSTA": "input", "OCEA": "input", "DOA0": "output" },
            "connections": { "CLKA": [2], "RSTA": ["0"], "OCEA": ["1"], "DOA0": [20] },
        },
        "register": {
            "type": "TRELLIS_FF", "hide_name": 0, "attributes": {},
            "parameters": { "CEMUX": "1 ", "CLKMUX": "CLK", "LSRMUX": "LSR", "REGSET": "RESET" },
            "port_directions": { "CLK": "input", "DI": "input", "LSR": "input", "Q": "output" },
            "connections": { "CLK": [2], "DI": [20], "LSR": ["0"], "Q": [21] },
        },
    });
    let ports = json!({
        "clk_i": { "direction": "input", "bits": [2] },
        "y_o": { "direction": "output", "bits": [21] },
    });
    let module =
        json!({ "ports": ports, "cells": cells, "netnames": {}, "attributes": { "top": "1" } });
    let written = json!({ "creator": "Yosys", "modules": { "rpu": module } });
    let (_, placed, port_ff) =
        placement_netlist(written.to_string().as_bytes(), "rpu", "clk_i", DeviceFamily::Ecp5)
            .unwrap();
    let mut placed: Value = serde_json::from_slice(&placed).unwrap();
    let at_port = placed["modules"]["rpu"]["cells"].as_object_mut().unwrap().remove("$port$y_o[0]");
    assert_eq!((port_ff, &at_port.unwrap()["type"]), (1, &"TRELLIS_FF".into()));
    placed["modules"]["rpu"]["ports"]["y_o"] = ports["y_o"].clone();
    assert_eq!(placed, written);
}

#[test]
fn registers_replace_all_ports_except_the_clock() {
    let all = json!({
        "clk_i": { "direction": "input", "bits": [2] },
        "d_i": { "direction": "input", "bits": [3, 4] },
        "y_o": { "direction": "output", "bits": [3, "0", 5] },
    });
    for (family, kind, data) in [
        (DeviceFamily::Ecp5, "TRELLIS_FF", "DI"),
        (DeviceFamily::Ice40Up, "SB_DFF", "D"),
        (DeviceFamily::Gowin, "DFF", "D"),
    ] {
        let mut core = netlist(&all, &json!({}));
        assert_eq!(
            netlist::replace_ports(&mut core, "clk_i", family).unwrap(),
            4,
            "a constant needs none"
        );
        assert_eq!(core.ports.keys().collect::<Vec<_>>(), ["clk_i"]);
        assert_eq!(core.count_cells(kind), 4);
        let input = &core.cells["$port$d_i[1]"];
        assert_eq!((input.net(data), input.net("Q")), (Some(4), Some(4)), "it holds itself");
        let output = &core.cells["$port$y_o[2]"];
        assert_eq!(
            (output.net(data), output.net("Q")),
            (Some(5), Some(7)),
            "a net that nobody reads"
        );
    }
    // A core on AXI has another name for its clock.
    let mut core = netlist(&all, &json!({}));
    let error = netlist::replace_ports(&mut core, "aclk", DeviceFamily::Ecp5);
    assert!(error.unwrap_err().to_string().contains("`aclk`"));
    let (_, pins) = DeviceFamily::Gowin.pin_file("aclk").unwrap();
    assert!(pins.contains("\"aclk\""), "{pins}");
}

#[test]
fn nets_have_the_name_where_they_are_driven() {
    let core = netlist(&json!({}), &json!({}));
    assert_eq!(core.name(21).unwrap(), "u_a.sum_q[5]");
    assert_eq!(core.name(31).unwrap(), "u_a.u_b.wire", "and those of the source before made ones");
    assert_eq!(core.name(30), None);
    assert_eq!(core.name(32).unwrap(), "u_a.count_o", "the innermost output");
    assert_eq!(core.name(33).unwrap(), "d_i", "the outermost input");
    assert_eq!(
        (core.net("u_a.sum[1]"), core.net("u_a.sum_q[5]"), core.net("y_o")),
        (Some(21), Some(21), Some(21))
    );
    assert_eq!((core.net("u_a.sum_q[3]"), core.net("nothing")), (None, None));
}

#[test]
fn names_have_the_module_that_they_are_declared_in() {
    let modules = json!({ "modules": {
        "rpu": { "cells": {
            "u_edge": { "type": "edge_detector" },
            "g_row[1].u_add": { "type": r"$paramod\adder\WIDTH=s32'00000000000000000000000000001000" },
            "$add$1": { "type": "$add" },
        } },
        "edge_detector": { "cells": { "u_above": { "type": r"$paramod$0123\magnitude_above" } } },
        r"$paramod\adder\WIDTH=s32'00000000000000000000000000001000": { "cells": {} },
        r"$paramod$0123\magnitude_above": { "cells": {} },
    } });
    let hierarchy =
        ModuleHierarchy::parse("hierarchy.json", modules.to_string().as_bytes()).unwrap();
    for (name, module) in [
        ("count_q[3]", "rpu"),
        ("u_edge.sum_q", "edge_detector"),
        ("u_edge.u_above.value_i[2]", "magnitude_above"),
        ("u_edge_count.sum", "rpu"),
        ("g_row[1].u_add.sum_q[0]", "adder"),
    ] {
        assert_eq!(hierarchy.module_of("rpu", name), module, "{name}");
    }
}

#[test]
fn resource_shortages_are_read_from_the_log() {
    let log = "Info: Device utilisation:\n\
               Info: \t          TRELLIS_IO:     1/  365     0%\n\
               Info: \t              DP16KD:   155/  108   143%\n\
               ERROR: Unable to place cell 'x', no BELs remaining to implement cell type 'DP16KD'\n";
    let expected = ResourceShortage { place: "DP16KD".to_owned(), used: 155, available: 108 };
    assert_eq!(resource_shortages(log), [expected]);
    assert_eq!(resource_shortages("Info: 3: a/b\nERROR: 5/4\n"), []);
}

#[test]
fn the_longest_path_is_between_clock_edges() {
    let path = |from: &str, delay: f64| {
        let pin = json!({ "cell": "a", "port": "Q", "loc": [1, 2] });
        let step = json!({ "type": "routing", "delay": delay, "net": "n", "from": pin, "to": pin });
        json!({ "from": from, "to": "posedge clk", "path": [step] })
    };
    let report = json!({
        "critical_paths": [path("posedge clk", 2.0), path("posedge clk", 3.5), path("<async>", 9.0)],
        "fmax": { "clk": { "achieved": 285.7, "constraint": 400.0 } },
        "utilization": { "DP16KD": { "used": 3, "available": 208 } },
    });
    let outcome = NextpnrReport::parse(report.to_string().as_bytes()).unwrap();
    assert!((outcome.longest().unwrap().delay() - 3.5).abs() < 1e-9);
    assert!((outcome.fmax_mhz().unwrap() - 285.7).abs() < 1e-9);
    assert_eq!(
        (outcome.utilization_of("DP16KD"), outcome.utilization_of("SPRAM")),
        ((3, 208), (0, 0))
    );
    let nothing = r#"{"critical_paths": [], "fmax": {}, "utilization": {}}"#;
    let no_clock = NextpnrReport::parse(nothing.as_bytes()).unwrap().fmax_mhz().unwrap_err();
    assert!(matches!(no_clock, EstimateError::UnreadableReport { .. }), "{no_clock}");
    let truncated = NextpnrReport::parse(b"{\"fmax\"").unwrap_err().to_string();
    assert!(truncated.starts_with("cannot read the report of nextpnr: "), "{truncated}");
}

#[test]
fn the_median_was_reached() {
    let (fmax, median) = ClockStatistics::of(vec![60.0, 70.0, 50.0, 65.0]).unwrap();
    assert_eq!((fmax.median_mhz, fmax.min_mhz, fmax.max_mhz, median), (60.0, 50.0, 70.0, 0));
    assert_eq!(ClockStatistics::of(vec![1.0, 3.0, 2.0]).unwrap().1, 2);
    assert!(ClockStatistics::of(Vec::new()).is_none());
}

#[test]
fn devices_have_names_of_their_own() {
    for (index, device) in ROUTE_DEVICES.iter().enumerate() {
        assert_eq!(RouteDevice::by_name(device.name), Some(&ROUTE_DEVICES[index]));
    }
    assert_eq!(RouteDevice::by_name("vcu118"), None);
}

/// A generated core is placed as by this crate: its scripts pass the same options to Yosys and
/// nextpnr for every device.
#[test]
fn the_scripts_of_a_core_have_the_same_devices() {
    let design = foveate_design::DesignConfig::default().validate().unwrap();
    let files = foveate_emit::core_files(&design, &foveate_emit::Prefix::default());
    let script = |name: &str| &files.iter().find(|file| file.path == name).unwrap().contents;
    for device in ROUTE_DEVICES {
        let (script, ram) = match device.family {
            DeviceFamily::Ecp5 => (script("synth/ecp5.sh"), false),
            DeviceFamily::Ice40Up | DeviceFamily::Ice40Hx => (script("synth/ice40.sh"), true),
            // Boards have their own script for this family.
            DeviceFamily::Gowin => continue,
        };
        let start = format!("{}) ", device.name);
        let line = script.lines().find(|line| line.starts_with(&start)).unwrap();
        let options = device.arguments().join(" ").replace(" --timing-allow-fail", "");
        let expected =
            format!("synthesis='{}' part='{options}' ;;", device.family.synthesis_command());
        assert_eq!(line.strip_prefix(&start), Some(expected.as_str()));
        assert!(script.contains("$part --timing-allow-fail"));
        assert_eq!(script.contains("setattr -unset ram_style */m:*"), ram);
        assert_eq!(ram, !device.family.has_distributed_ram());
    }
}
