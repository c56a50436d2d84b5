// SPDX-License-Identifier: MIT OR Apache-2.0
//! Small netlists and reports, written down as Yosys and nextpnr would.

use serde_json::{Value, json};

use super::device::Family;
use super::hierarchy::Hierarchy;
use super::netlist::Netlist;
use super::report::{Fmax, Over};
use super::result::{Outcome, over};
use super::{ROUTE_DEVICES, RouteDevice, outreg, ports};
use crate::error::EstimateError;

fn netlist(ports: &Value, cells: &Value) -> Netlist {
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
    Netlist::parse(file.as_bytes(), "rpu").unwrap().0
}

/// A block RAM that shows bit 20 at its side A, and a flip-flop behind it with these changes.
fn block_and_register(changes: &[(&str, &str)]) -> Value {
    let mut register = json!({
        "type": "TRELLIS_FF", "hide_name": 0, "attributes": {},
        "parameters": { "CEMUX": "1 ", "CLKMUX": "CLK", "LSRMUX": "LSR", "REGSET": "RESET" },
        "port_directions": { "CLK": "input", "DI": "input", "LSR": "input", "Q": "output" },
        "connections": { "CLK": [2], "DI": [20], "LSR": ["0"], "Q": [21] },
    });
    for &(pointer, value) in changes {
        *register.pointer_mut(pointer).unwrap() = serde_json::from_str(value).unwrap();
    }
    json!({
        "block": {
            "type": "DP16KD", "hide_name": 0, "attributes": {},
            "parameters": { "REGMODE_A": "NOREG", "REGMODE_B": "NOREG" },
            "port_directions": { "CLKA": "input", "RSTA": "input", "DOA0": "output", "DOA1": "output" },
            "connections": { "CLKA": [2], "RSTA": ["0"], "DOA0": [20], "DOA1": [22] },
        },
        "register": register,
    })
}

#[test]
fn a_plain_register_behind_a_block_becomes_its_own() {
    let mut plain = netlist(&json!({}), &block_and_register(&[]));
    assert_eq!(outreg::absorb(&mut plain), 1);
    let block = &plain.cells["block"];
    assert_eq!(plain.cells.len(), 1);
    assert_eq!((block.net("DOA0"), block.net("DOA1")), (Some(21), Some(22)));
    assert_eq!((block.text("REGMODE_A"), block.text("REGMODE_B")), (Some("OUTREG"), Some("NOREG")));
}

#[test]
fn registers_with_one_enable_move_and_those_with_several_stay() {
    let with_enables = |first: u32, second: u32| {
        let mut cells = block_and_register(&[("/parameters/CEMUX", "\"CE\"")]);
        cells["second"] = cells["register"].clone();
        cells["register"]["connections"]["CE"] = json!([first]);
        cells["second"]["connections"]["CE"] = json!([second]);
        cells["second"]["connections"]["DI"] = json!([22]);
        netlist(&json!({}), &cells)
    };
    let mut one = with_enables(8, 8);
    assert_eq!(outreg::absorb(&mut one), 2);
    assert_eq!(one.cells["block"].net("OCEA"), Some(8));
    assert_eq!(outreg::absorb(&mut with_enables(8, 9)), 0);
}

#[test]
fn other_registers_stay_where_they_are() {
    for change in [
        ("/parameters/CEMUX", "\"INV\""),
        ("/parameters/CLKMUX", "\"INV\""),
        ("/parameters/REGSET", "\"SET\""),
        ("/connections/LSR", "[7]"),
        ("/connections/CLK", "[3]"),
        ("/type", "\"LUT4\""),
    ] {
        let mut other = netlist(&json!({}), &block_and_register(&[change]));
        assert_eq!(outreg::absorb(&mut other), 0, "{change:?}");
        assert_eq!(other.cells.len(), 2, "{change:?}");
    }
    // One that is seen elsewhere, too: at another cell, at a port.
    let mut cells = block_and_register(&[]);
    cells["second"] = cells["register"].clone();
    assert_eq!(outreg::absorb(&mut netlist(&json!({}), &cells)), 0);
    let port = json!({ "y_o": { "direction": "output", "bits": [20] } });
    assert_eq!(outreg::absorb(&mut netlist(&port, &block_and_register(&[]))), 0);
    let mut cells = block_and_register(&[]);
    cells["block"]["connections"]["RSTA"] = json!([9]);
    assert_eq!(outreg::absorb(&mut netlist(&json!({}), &cells)), 0);
}

#[test]
fn ports_are_registers_but_for_the_clock() {
    let all = json!({
        "clk_i": { "direction": "input", "bits": [2] },
        "d_i": { "direction": "input", "bits": [3, 4] },
        "y_o": { "direction": "output", "bits": [3, "0", 5] },
    });
    for (family, kind, data) in
        [(Family::Ecp5, "TRELLIS_FF", "DI"), (Family::Ice40Up, "SB_DFF", "D")]
    {
        let mut core = netlist(&all, &json!({}));
        assert_eq!(ports::become_registers(&mut core, family).unwrap(), 4, "a constant needs none");
        assert_eq!(core.ports.keys().collect::<Vec<_>>(), ["clk_i"]);
        assert_eq!(core.count(kind), 4);
        let input = &core.cells["$port$d_i[1]"];
        assert_eq!((input.net(data), input.net("Q")), (Some(4), Some(4)), "it holds itself");
        let output = &core.cells["$port$y_o[2]"];
        assert_eq!(
            (output.net(data), output.net("Q")),
            (Some(5), Some(7)),
            "a net that nobody reads"
        );
    }
    let error = ports::become_registers(&mut netlist(&json!({}), &json!({})), Family::Ecp5);
    assert!(error.unwrap_err().to_string().contains("`clk_i`"));
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
    let hierarchy = Hierarchy::parse("hierarchy.json", modules.to_string().as_bytes()).unwrap();
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
fn what_a_device_lacks_is_in_the_log() {
    let log = "Info: Device utilisation:\n\
               Info: \t          TRELLIS_IO:     1/  365     0%\n\
               Info: \t              DP16KD:   155/  108   143%\n\
               ERROR: Unable to place cell 'x', no BELs remaining to implement cell type 'DP16KD'\n";
    let expected = Over { place: "DP16KD".to_owned(), used: 155, available: 108 };
    assert_eq!(over(log), [expected]);
    assert_eq!(over("Info: 3: a/b\nERROR: 5/4\n"), []);
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
    let outcome = Outcome::parse(report.to_string().as_bytes()).unwrap();
    assert!((outcome.longest().unwrap().delay() - 3.5).abs() < 1e-9);
    assert!((outcome.fmax_mhz().unwrap() - 285.7).abs() < 1e-9);
    assert_eq!((outcome.used("DP16KD"), outcome.used("SPRAM")), ((3, 208), (0, 0)));
    let nothing = r#"{"critical_paths": [], "fmax": {}, "utilization": {}}"#;
    let none = Outcome::parse(nothing.as_bytes()).unwrap().fmax_mhz().unwrap_err();
    assert!(matches!(none, EstimateError::Placed { .. }), "{none}");
    let cut = Outcome::parse(b"{\"fmax\"").unwrap_err().to_string();
    assert!(cut.starts_with("cannot read the report of nextpnr: "), "{cut}");
}

#[test]
fn the_median_was_reached() {
    let (fmax, median) = Fmax::of(vec![60.0, 70.0, 50.0, 65.0]).unwrap();
    assert_eq!((fmax.median_mhz, fmax.min_mhz, fmax.max_mhz, median), (60.0, 50.0, 70.0, 0));
    assert_eq!(Fmax::of(vec![1.0, 3.0, 2.0]).unwrap().1, 2);
    assert!(Fmax::of(Vec::new()).is_none());
}

#[test]
fn devices_have_names_of_their_own() {
    for (index, device) in ROUTE_DEVICES.iter().enumerate() {
        assert_eq!(RouteDevice::named(device.name), Some(&ROUTE_DEVICES[index]));
    }
    assert_eq!(RouteDevice::named("vcu118"), None);
}
