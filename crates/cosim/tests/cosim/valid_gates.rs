// SPDX-License-Identifier: MIT OR Apache-2.0
//! Outputs that are valid only with a valid bit, of the same lane or of any lane. Without the bit
//! their value must not matter, and with it it must.

use foveate_cosim::{
    DesignUnderTest, PortDifference, Recorder, Recording, SimulationRun, Simulator,
};
use foveate_design::{OutputQualifier, Port, PortDirection, PortRole};
use foveate_tools::{Cache, Toolchain, testing::require_tools, verilator::OptimizationLevel};
use std::time::Duration;

const GATED_MODULE: &str = include_str!("gated.v");

fn ports() -> Vec<Port> {
    use PortDirection::{Input, Output};
    let port = |name: &str, direction, role, width, lanes, qualifier| Port {
        name: name.to_owned(),
        direction,
        role,
        width,
        lanes,
        per_lane: lanes > 1,
        qualifier,
        doc: String::new(),
    };
    let (always, with) =
        (OutputQualifier::Always, OutputQualifier::WhileSet(PortRole::ForwardValid));
    vec![
        port("clk_i", Input, PortRole::Clock, 1, 1, always),
        port("rst_i", Input, PortRole::Reset, 1, 1, always),
        port("valid_i", Input, PortRole::Valid, 1, 3, always),
        port("lanes_i", Input, PortRole::Pixel, 8, 3, always),
        port("all_i", Input, PortRole::TemporalLevel, 8, 1, always),
        port("valid_o", Output, PortRole::ForwardValid, 1, 3, always),
        port("lanes_o", Output, PortRole::ForwardPixel, 8, 3, with),
        port("all_o", Output, PortRole::ForwardPosition, 8, 1, with),
    ]
}

/// Records lanes that are valid at random; in the first half at most one lane is valid. The
/// expected value without a valid bit is 0.
fn recording(clocks: u64) -> Recording {
    let mut recorder = Recorder::new(&ports()).unwrap();
    let (inputs, outputs) = (recorder.inputs().clone(), recorder.outputs().clone());
    let mut state = 1u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        state >> 33
    };
    recorder.begin_frame("gates", 0, None);
    for clock in 0..clocks {
        let reset = clock == 0;
        let (mut input, mut output) = (inputs.zero_record(), outputs.zero_record());
        inputs.fields()[0].set(&mut input, 0, reset.into());
        let all = random();
        inputs.fields()[3].set(&mut input, 0, all);
        let chosen = if clock < clocks / 2 { 1 << (random() % 4) } else { random() };
        for lane in 0..3 {
            let (valid, value) = (chosen >> lane & 1, random());
            inputs.fields()[1].set(&mut input, lane, valid);
            inputs.fields()[2].set(&mut input, lane, value);
            if valid == 1 && !reset {
                outputs.fields()[0].set(&mut output, lane, 1);
                outputs.fields()[1].set(&mut output, lane, value);
                outputs.fields()[2].set(&mut output, 0, all);
            }
        }
        recorder.push(&input, &output).unwrap();
    }
    recorder.finish().unwrap()
}

fn run(simulator: Simulator, verilog: String, recording: &Recording) -> Option<PortDifference> {
    let (toolchain, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let (toolchain, cache, limit) = (&toolchain, &cache, Duration::from_secs(60));
    let run = SimulationRun {
        simulator,
        seed: 3,
        trace: false,
        toolchain,
        cache,
        limit,
        optimize: OptimizationLevel::FastBuild,
    };
    let dut = DesignUnderTest {
        top: "gated".to_owned(),
        ports: ports(),
        parameters: Vec::new(),
        sources: vec![("gated.v".to_owned(), verilog)],
        no_inline: Vec::new(),
    };
    run.run(&dut, recording).unwrap().differences.into_iter().next()
}

#[test]
fn outputs_without_their_valid_bit_are_ignored() {
    for simulator in Simulator::ALL {
        if require_tools(simulator.tools()) {
            assert_eq!(
                run(simulator, GATED_MODULE.to_owned(), &recording(2000)),
                None,
                "{simulator}"
            );
        }
    }
}

#[test]
fn outputs_with_their_valid_bit_and_the_bit_are_compared() {
    let recording = recording(2000);
    for (from, to, port, lane) in [
        ("valid_o[2] ? lanes_q[23:16]", "valid_o[2] ? ~lanes_q[23:16]", "lanes_o", 2),
        ("valid_o[1] ? lanes_q[15:8]", "valid_o[1] && valid_o[0] ? lanes_q[15:8]", "lanes_o", 1),
        ("valid_o != 0 ?", "valid_o[0] ?", "all_o", 0),
        ("valid_o != 0 ?", "!valid_o[2] ?", "all_o", 0),
        ("3'd0 : valid_i;", "3'd0 : valid_i & 3'b101;", "valid_o", 1),
        ("3'd0 : valid_i;", "3'd0 : valid_i | 3'b100;", "valid_o", 2),
    ] {
        assert_eq!(GATED_MODULE.matches(from).count(), 1, "{from}");
        for simulator in Simulator::ALL {
            if require_tools(simulator.tools()) {
                let found = run(simulator, GATED_MODULE.replace(from, to), &recording).unwrap();
                assert_eq!((found.port.as_str(), found.lane), (port, lane), "{simulator} {to}");
            }
        }
    }
}

/// Values are counted as compared only at clocks at which they are compared.
#[test]
fn only_compared_values_are_counted() {
    let recording = recording(1000);
    let outputs = recording.outputs();
    let expected = std::fs::read(recording.expected_path()).unwrap();
    let records = expected.chunks_exact(outputs.record_bytes());
    let compared: u64 = records
        .map(|record| {
            let valid = u64::from((record[0] & 7).count_ones());
            3 + valid + u64::from(valid > 0)
        })
        .sum();
    assert_eq!(recording.comparisons(1000).unwrap(), compared);
    assert!(compared > 4000 && compared < 7000, "{compared}");
}
