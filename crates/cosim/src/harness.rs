// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sources that are made from a port list alone: the C++ harness for Verilator and the replay
//! bench.

use super::layout::RecordField;
use crate::gate::ComparisonGate;
use crate::layout::RecordLayout;
use askama::Template;
use foveate_design::{Port, PortDirection, PortRole};
use foveate_emit::Parameter;

/// Returns the C++ main that clocks module `top` with packed records; [`RecordLayout`] describes
/// their bytes.
#[must_use]
pub fn cpp_harness(top: &str, ports: &[Port]) -> String {
    let clock = clock_name(ports);
    let (inputs, outputs) = (RecordLayout::inputs(ports), RecordLayout::outputs(ports));
    render(&CppHarness { top, clock, inputs, outputs })
}

/// Returns the name of the bench that [`replay_bench`] writes for module `top`.
#[must_use]
pub fn bench_name(top: &str) -> String {
    format!("{top}_replay")
}

/// Returns the name of the file of that bench.
#[must_use]
pub fn bench_file(top: &str) -> String {
    format!("{}.v", bench_name(top))
}

/// Returns a bench in Verilog-2005 that replays vectors through module `top` and compares every
/// output at every clock. `parameters` are those of the module, with their values.
/// [`crate::VectorPacker`] writes the vectors.
#[must_use]
pub fn replay_bench(top: &str, ports: &[Port], parameters: &[Parameter]) -> String {
    annotated_bench(top, ports, parameters, &[], None)
}

/// Returns the bench of [`replay_bench`] with the lines `about` in its first comment. With a
/// `shortcoming` of the vectors it prints `INCOMPLETE` instead of `PASS`.
pub(crate) fn annotated_bench(
    top: &str,
    ports: &[Port],
    parameters: &[Parameter],
    about: &[String],
    shortcoming: Option<&str>,
) -> String {
    let (inputs, outputs) = (RecordLayout::inputs(ports), RecordLayout::outputs(ports));
    let bench_ports = |layout: &RecordLayout| -> Vec<BenchPort> {
        layout.fields().iter().map(|field| BenchPort::new(field, layout.fields())).collect()
    };
    let (inputs, outputs) = (bench_ports(&inputs), bench_ports(&outputs));
    let clock = BenchPort {
        name: clock_name(ports).to_owned(),
        declared: clock_name(ports).to_owned(),
        ..BenchPort::default()
    };
    render(&ReplayBench {
        top,
        parameters: parameters.iter().map(|(name, value)| format!(".{name}({value})")).collect(),
        bench: bench_name(top),
        clock,
        has_lanes: outputs.iter().any(|port| port.lanes > 1),
        columns: inputs.len() + outputs.len(),
        inputs,
        outputs,
        comment_lines: about,
        shortcoming,
    })
}

#[derive(Template)]
#[template(path = "harness.cpp")]
struct CppHarness<'a> {
    top: &'a str,
    clock: &'a str,
    inputs: RecordLayout,
    outputs: RecordLayout,
}

#[derive(Template)]
#[template(path = "replay_bench.v")]
struct ReplayBench<'a> {
    top: &'a str,
    parameters: Vec<String>,
    bench: String,
    clock: BenchPort,
    inputs: Vec<BenchPort>,
    outputs: Vec<BenchPort>,
    has_lanes: bool,
    /// The number of values of a line. It is also the index of the bit that says that a number of
    /// clocks comes first.
    columns: usize,
    comment_lines: &'a [String],
    shortcoming: Option<&'a str>,
}

/// The pieces of text with which a port appears in the bench.
#[derive(Default)]
struct BenchPort {
    name: String,
    declared: String,
    next: String,
    expected: String,
    lanes: u32,
    lane: String,
    expected_lane: String,
    /// The condition for a comparison of the port, followed by `&&`; empty if the port is always
    /// compared.
    gate: String,
}

impl BenchPort {
    fn new(field: &RecordField, fields: &[RecordField]) -> Self {
        let port = &field.port;
        let name = &port.name;
        let range = match port.bits() {
            1 => String::new(),
            bits => format!("[{}:0] ", bits - 1),
        };
        let lane = |vector: &str| match port.width {
            1 => format!("{vector}[lane]"),
            width => format!("{vector}[lane*{width} +: {width}]"),
        };
        Self {
            name: name.clone(),
            declared: format!("{range}{name}"),
            next: format!("{range}{name}_next"),
            expected: format!("{range}{name}_expected"),
            lanes: port.lanes,
            lane: lane(name),
            expected_lane: lane(&format!("{name}_expected")),
            gate: gate_condition(field, fields),
        }
    }
}

fn gate_condition(field: &RecordField, fields: &[RecordField]) -> String {
    match field.gate {
        ComparisonGate::Always => String::new(),
        ComparisonGate::SameLane(valid) if field.port.lanes == 1 => {
            format!("{}_expected && ", fields[valid].port.name)
        }
        ComparisonGate::SameLane(valid) => {
            format!("{}_expected[lane] && ", fields[valid].port.name)
        }
        ComparisonGate::AnyLane(valid) => format!("|{}_expected && ", fields[valid].port.name),
    }
}

/// Returns the name of the clock. A hand-made module without a clock role has `clk_i`.
fn clock_name(ports: &[Port]) -> &str {
    let is_clock = |port: &&Port| {
        port.direction == PortDirection::Input && matches!(port.role, PortRole::Clock)
    };
    ports.iter().find(is_clock).map_or("clk_i", |port| port.name.as_str())
}

/// Returns a filled template, with the final newline that askama drops.
pub(crate) fn render(template: &impl Template) -> String {
    template.render().expect("no template calls something that can fail") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::port;
    use foveate_design::OutputQualifier;

    #[test]
    fn ports_of_every_width_are_named_once_per_use() {
        let ports = [
            port("clk_i", PortDirection::Input, 1, 1),
            port("a_i", PortDirection::Input, 33, 1),
            port("b_o", PortDirection::Output, 8, 25),
        ];
        let cpp = cpp_harness("tiny", &ports);
        assert!(cpp.contains("#include \"Vtiny.h\""), "{cpp}");
        assert!(cpp.contains("put(top.a_i, record + 0, 5);"), "{cpp}");
        assert!(cpp.contains("kFits<200, decltype(top.b_o)>"), "{cpp}");
        assert!(!cpp.contains("put(top.clk_i"), "{cpp}");
        let bench = replay_bench("tiny", &ports, &[("N", 4)]);
        assert!(bench.contains("module tiny_replay;"), "{bench}");
        assert!(bench.contains("tiny #(.N(4)) dut ("), "{bench}");
        assert!(bench.contains("b_o[lane*8 +: 8] !== b_o_expected[lane*8 +: 8]"), "{bench}");
        assert!(bench.contains("reg [2:0] changes;"), "{bench}");
        assert!(bench.contains("if (changes[1]) is_whole = $fscanf(file, \"%h\", b_o_expected)"));
    }

    #[test]
    fn a_port_without_its_valid_bit_is_not_compared() {
        let valid = |lanes| Port {
            role: PortRole::ForwardValid,
            ..port("v_o", PortDirection::Output, 1, lanes)
        };
        let gated = |name, lanes| Port {
            qualifier: OutputQualifier::WhileSet(PortRole::ForwardValid),
            ..port(name, PortDirection::Output, 8, lanes)
        };
        let bench = replay_bench("tiny", &[gated("a_o", 1), gated("b_o", 3), valid(3)], &[]);
        assert!(bench.contains("if (|v_o_expected && a_o !== a_o_expected"), "{bench}");
        assert!(bench.contains("if (v_o_expected[lane] && b_o[lane*8 +: 8] !=="), "{bench}");
        assert!(bench.contains("if (v_o[lane] !== v_o_expected[lane]"), "{bench}");
        let bench = replay_bench("tiny", &[gated("a_o", 1), valid(1)], &[]);
        assert!(bench.contains("if (v_o_expected && a_o !== a_o_expected"), "{bench}");
    }
}
