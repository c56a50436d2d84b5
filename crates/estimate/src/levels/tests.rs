// SPDX-License-Identifier: MIT OR Apache-2.0
//! Small netlists, written down as Yosys would.

use serde_json::{Value, json};

use super::{LogicPath, longest_paths};
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

/// The lowest sum does not wait for the data beside it, so that it may select that data.
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
