// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests on small netlists in the format of Yosys.

use serde_json::{Value, json};

use super::{CellLibrary, LogicPath, ecp5, longest_paths, slowest_path};
use crate::error::EstimateError;

fn module(ports: &Value, cells: &Value) -> Value {
    json!({ "ports": ports, "cells": cells, "netnames": {
        "q": { "hide_name": 0, "bits": [10, 11] },
        "$auto$q": { "hide_name": 1, "bits": [10] },
        "sum": { "hide_name": 0, "bits": [30] },
        "d_i": { "hide_name": 0, "bits": [2] },
        "y_o": { "hide_name": 0, "bits": [3] },
    } })
}

fn port(direction: &str, bit: u32) -> Value {
    json!({ "direction": direction, "bits": [bit] })
}

fn cell(kind: &str, connections: &Value) -> Value {
    json!({ "type": kind, "connections": connections })
}

fn try_longest(modules: &Value, top: &str) -> Result<LogicPath, EstimateError> {
    let json = json!({ "modules": modules }).to_string();
    longest_paths("netlist.json", json.as_bytes(), &[top]).map(|paths| paths[0].clone())
}

fn longest(ports: &Value, cells: &Value) -> LogicPath {
    try_longest(&json!({ "top": module(ports, cells) }), "top").unwrap()
}

fn text(path: &LogicPath) -> String {
    let LogicPath { levels, carry4, from, to, through } = path;
    format!("{levels}+{carry4} {from} [{}] {to}", through.join(" "))
}

#[test]
fn tables_are_levels_and_multiplexers_behind_them_are_not() {
    let path = longest(
        &json!({}),
        &json!({
            "a": cell("FDRE", &json!({ "C": [1], "D": [3], "Q": [10] })),
            "b": cell("LUT2", &json!({ "I0": [10], "I1": ["1"], "O": [20] })),
            "c": cell("MUXF7", &json!({ "I0": [20], "I1": [10], "S": [10], "O": [21] })),
            "d": cell("LUT1", &json!({ "I0": [21], "O": [22] })),
            "e": cell("FDRE", &json!({ "C": [1], "D": [10], "CE": [22], "Q": [11] })),
        }),
    );
    assert_eq!(text(&path), "2+0 q[0] [LUT2 MUXF7 LUT1] q[1] (FDRE.CE)");
}

#[test]
fn a_chain_is_one_level_and_its_blocks_are_counted() {
    let chain = |s: u32| {
        json!({
            "f": cell("FDRE", &json!({ "C": [1], "D": [30], "Q": [10] })),
            "a": cell("CARRY4", &json!({
                "CI": ["0"], "CYINIT": ["0"], "DI": [10, "0", "0", "0"], "S": [s, "0", "0", "0"],
                "O": [40, 41, 42, 43], "CO": [44, 45, 46, 47],
            })),
            "b": cell("CARRY4", &json!({
                "CI": [47], "CYINIT": ["0"], "DI": ["0", "0", "0", "0"], "S": ["0", "0", "0", "0"],
                "O": [30, 51, 52, 53], "CO": [54, 55, 56, 57],
            })),
        })
    };
    let path = longest(&json!({}), &chain(10));
    assert_eq!(text(&path), "1+2 q[0] [CARRY4 CARRY4] q[0] (FDRE.D)");
}

/// The lowest sum does not depend on the data input of its bit, so it may select that data.
#[test]
fn bits_of_a_block_wait_only_for_lower_ones() {
    let path = longest(
        &json!({ "d_i": port("input", 2), "y_o": port("output", 3) }),
        &json!({
            "a": cell("CARRY4", &json!({
                "CI": ["0"], "CYINIT": ["0"], "S": [2, 41, "0", "0"], "DI": [41, "0", "0", "0"],
                "O": [40, 3, 42, 43], "CO": [44, 45, 46, 47],
            })),
            "b": cell("LUT1", &json!({ "I0": [40], "O": [41] })),
        }),
    );
    assert_eq!(text(&path), "3+2 d_i [CARRY4 LUT1 CARRY4] y_o");
}

#[test]
fn memory_is_read_in_a_level_and_written_at_the_end_of_a_path() {
    let path = longest(
        &json!({ "d_i": port("input", 2), "y_o": port("output", 3) }),
        &json!({
            "m": cell("RAM64X1S", &json!({ "A0": [2], "D": [50], "WE": [2], "WCLK": [1], "O": [30] })),
            "a": cell("LUT1", &json!({ "I0": [30], "O": [50] })),
            "s": cell("SRL16E", &json!({ "A0": ["1"], "CE": [2], "CLK": [1], "D": [30], "Q": [3] })),
        }),
    );
    assert_eq!(text(&path), "2+0 d_i [RAM64X1S LUT1] sum (RAM64X1S.D)");
}

#[test]
fn paths_cross_modules() {
    let modules = json!({
        "inner": module(
            &json!({ "d_i": port("input", 2), "y_o": port("output", 3), "z_o": port("output", 2) }),
            &json!({ "l": cell("LUT1", &json!({ "I0": [2], "O": [3] })) }),
        ),
        "top": module(
            &json!({ "d_i": port("input", 2), "y_o": port("output", 3) }),
            &json!({
                "u_a": cell("inner", &json!({ "d_i": [2], "y_o": [30] })),
                "u_b": cell("inner", &json!({ "d_i": [30], "z_o": [31] })),
                "u_c": cell("inner", &json!({ "d_i": [31], "y_o": [3] })),
            }),
        ),
    });
    let path = try_longest(&modules, "top").unwrap();
    assert_eq!(text(&path), "2+0 d_i [LUT1 LUT1] y_o");
    assert_eq!(try_longest(&modules, "inner").unwrap().levels, 1);
    let error = try_longest(&modules, "outer").unwrap_err().to_string();
    assert!(error.contains("`outer`"), "{error}");
}

#[test]
fn logic_in_a_circle_is_an_error_that_names_it() {
    let cells = json!({
        "a": cell("LUT2", &json!({ "I0": [11], "I1": [2], "O": [30] })),
        "b": cell("LUT1", &json!({ "I0": [30], "O": [11] })),
        "c": cell("LUT1", &json!({ "I0": [30], "O": [3] })),
    });
    let ports = json!({ "d_i": port("input", 2), "y_o": port("output", 3) });
    let error = try_longest(&json!({ "top": module(&ports, &cells) }), "top").unwrap_err();
    let text = error.to_string();
    assert!(text.contains("`q[1]`") && text.contains("`sum`"), "{text}");
    assert!(!text.contains("y_o"), "{text}");
}

#[test]
fn without_logic_there_are_no_levels() {
    let wire = json!({ "d_i": port("input", 2), "y_o": port("output", 2) });
    assert_eq!(longest(&wire, &json!({})).levels, 0);
    assert_eq!(longest(&json!({}), &json!({})), LogicPath::default());
}

fn slowest(cells: &Value, library: CellLibrary) -> (String, u32) {
    let json = json!({ "modules": { "top": module(&json!({}), cells) } }).to_string();
    let (path, ps) = slowest_path("netlist.json", json.as_bytes(), "top", library).unwrap();
    (text(&path), ps)
}

/// Returns a delay of logic with the share of its wires.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some nanoseconds")]
fn with_wires(ps: u32) -> u32 {
    (f64::from(ps) / 0.35).round() as u32
}

#[test]
fn the_slowest_path_need_not_have_the_most_levels() {
    // One path has two tables entered by their last inputs, the other has one table entered by its
    // first.
    let cells = json!({
        "f": cell("FDRE", &json!({ "C": [1], "D": [30], "Q": [10] })),
        "a": cell("LUT2", &json!({ "I0": ["0"], "I1": [10], "O": [20] })),
        "b": cell("LUT2", &json!({ "I0": ["0"], "I1": [20], "O": [30] })),
        "c": cell("LUT6", &json!({ "I0": [10], "I1": ["0"], "I2": ["0"], "I3": ["0"], "I4": ["0"],
            "I5": ["0"], "O": [11] })),
        "g": cell("FDRE", &json!({ "C": [1], "D": [11], "Q": [12] })),
    });
    let (path, ps) = slowest(&cells, CellLibrary::Xilinx);
    assert!(path.starts_with("1+0 q[0] [LUT6]"), "{path}");
    assert_eq!(ps, with_wires(303) + with_wires(642));
    let levels = try_longest(&json!({ "top": module(&json!({}), &cells) }), "top").unwrap();
    assert_eq!(levels.levels, 2);
}

#[test]
fn blocks_of_memory_have_delays_without_wires() {
    let block = |parameters: Value| {
        json!({
            "m": { "type": "RAMB18E2", "parameters": parameters,
                "connections": { "CLKARDCLK": [1], "DOUTADOUT": [10] } },
            "a": cell("LUT1", &json!({ "I0": [10], "O": [30] })),
            "f": cell("FDRE", &json!({ "C": [1], "D": [30], "Q": [11] })),
        })
    };
    assert_eq!(
        slowest(&block(json!({})), CellLibrary::Xilinx).1,
        2151 + with_wires(303) + with_wires(127)
    );
    assert_eq!(
        slowest(&block(json!({ "DOA_REG": "1" })), CellLibrary::Xilinx).1,
        579 + with_wires(303) + with_wires(127)
    );
}

#[test]
fn an_ecp5_has_cells_of_its_own() {
    let cells = json!({
        "f": cell("TRELLIS_FF", &json!({ "CLK": [1], "CE": [10], "DI": [30], "Q": [10] })),
        "c": cell("CCU2C", &json!({ "A0": [10], "CIN": ["0"], "COUT": [20] })),
        "d": cell("CCU2C", &json!({ "CIN": [20], "A0": ["0"], "S1": [21] })),
        "p": cell("PFUMX", &json!({ "ALUT": [21], "BLUT": ["0"], "C0": ["0"], "Z": [30] })),
    });
    let (path, ps) = slowest(&cells, CellLibrary::Ecp5);
    assert_eq!(path, "0+0 q[0] [CCU2C CCU2C PFUMX] q[0] (TRELLIS_FF.DI)");
    assert_eq!(ps, with_wires(525) + with_wires(516) + with_wires(273) + with_wires(98));

    let block = |mode: &str| {
        json!({
            "m": { "type": "DP16KD", "parameters": { "REGMODE_A": mode },
                "connections": { "CLKA": [1], "DOA0": [10], "DOB0": [12] } },
            "f": cell("TRELLIS_FF", &json!({ "CLK": [1], "DI": [10], "Q": [11] })),
        })
    };
    assert_eq!(slowest(&block("NOREG"), CellLibrary::Ecp5).1, 5305 + with_wires(525));
    assert_eq!(slowest(&block("OUTREG"), CellLibrary::Ecp5).1, 435 + with_wires(525));
    let unknown = json!({ "modules": { "top": module(&json!({}), &json!({ "x": cell("EHXPLLL", &json!({})) })) } });
    let error =
        slowest_path("netlist.json", unknown.to_string().as_bytes(), "top", CellLibrary::Ecp5);
    assert!(error.unwrap_err().to_string().contains("`EHXPLLL`"));
}

/// The delays are those of the installed Yosys. The test is skipped with a message where Yosys is
/// missing.
#[test]
fn delays_are_those_of_the_cell_models() {
    use foveate_tools::{Cache, Tool, Toolchain, testing::require_tools, yosys};
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let (tools, cache) = (Toolchain::system(), Cache::temporary().unwrap());
    let models = yosys::cell_models(&tools, &cache, "ecp5/cells_sim.v").unwrap();
    let modules = [
        ("LUT4", ecp5::LUT4),
        ("PFUMX", ecp5::PFUMX),
        ("L6MUX21", ecp5::L6MUX21),
        ("CCU2C", ecp5::CCU2C),
    ];
    for (module, table) in modules {
        let text = models.split(&format!("module {module}")).nth(1).unwrap();
        let block = text.split("specify").nth(1).unwrap();
        assert_eq!(block.matches("=>").count(), table.len(), "{module}");
        for (from, to, ps) in table {
            assert!(block.contains(&format!("({from} => {to}) = {ps};")), "{module} {from} {to}");
        }
    }
    let models = yosys::cell_models(&tools, &cache, "xilinx/cells_sim.v").unwrap();
    let text = models.split("module LUT6 ").nth(1).or(models.split("module LUT6(").nth(1)).unwrap();
    for (input, ps) in [642, 631, 472, 407, 238, 127].into_iter().enumerate() {
        assert!(text.contains(&format!("(I{input} => O) = {ps};")), "I{input}");
    }
}
