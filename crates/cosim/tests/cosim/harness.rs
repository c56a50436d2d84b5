// SPDX-License-Identifier: MIT OR Apache-2.0
//! The machinery without model and RTL: a small hand-made module with ports of every storage class,
//! and the values that it must have.

use foveate_cosim::{
    CosimError, DesignUnderTest, Recorder, Recording, SimulationOutcome, SimulationRun, Simulator,
    bench_name, replay_bench, vectors_hex,
};
use foveate_design::{OutputQualifier, Port, PortDirection, PortRole};
use foveate_tools::{
    Cache, Invocation, Tool, Toolchain,
    testing::{require_tools, sample},
    verilator::OptimizationLevel,
};
use std::time::Duration;

const TINY_MODULE: &str = include_str!("tiny.v");

fn ports() -> Vec<Port> {
    use PortDirection::{Input, Output};
    let port = |name: &str, direction, width, lanes| Port {
        name: name.to_owned(),
        direction,
        role: if name == "clk_i" { PortRole::Clock } else { PortRole::Valid },
        width,
        lanes,
        per_lane: lanes > 1,
        qualifier: OutputQualifier::Always,
        doc: String::new(),
    };
    vec![
        port("clk_i", Input, 1, 1),
        port("rst_i", Input, 1, 1),
        port("a_i", Input, 8, 1),
        port("b_i", Input, 33, 1),
        port("c_i", Input, 64, 1),
        port("d_i", Input, 8, 25),
        port("bit_o", Output, 1, 1),
        port("a_o", Output, 12, 1),
        port("b_o", Output, 33, 1),
        port("c_o", Output, 64, 1),
        port("d_o", Output, 8, 25),
    ]
}

/// Returns a recording of `clocks` clocks with pseudo-random inputs. Each output is an input, one
/// clock later and complemented, or the number of clocks since the reset.
fn single_sequence_recording(clocks: u64) -> Recording {
    recording_in_sequences(clocks, clocks)
}

/// Returns the same recording, divided into sequences of `frames` frames of 50 clocks each.
fn recording_in_sequences(clocks: u64, frames: u64) -> Recording {
    let mut recorder = Recorder::new(&ports()).unwrap();
    let (inputs, outputs) = (recorder.inputs().clone(), recorder.outputs().clone());
    let (mut state, mut count) = (1u64, 0);
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        state ^ (state >> 29)
    };
    for clock in 0..clocks {
        if clock % 50 == 0 {
            recorder.begin_frame("counting", clock / 50 % frames, None);
        }
        let reset = clock == 0 || random() % 64 == 0;
        let (mut input, mut output) = (inputs.zero_record(), outputs.zero_record());
        inputs.fields()[0].set(&mut input, 0, reset.into());
        count = if reset { 0 } else { count + 1 };
        outputs.fields()[0].set(&mut output, 0, count % 2);
        outputs.fields()[1].set(&mut output, 0, count);
        for (from, to) in inputs.fields()[2..].iter().zip(&outputs.fields()[2..]) {
            for lane in 0..from.port.lanes {
                let value = random();
                from.set(&mut input, lane, value);
                to.set(&mut output, lane, if reset { 0 } else { !value });
            }
        }
        recorder.push(&input, &output).unwrap();
    }
    recorder.finish().unwrap()
}

fn dut(verilog: &str) -> DesignUnderTest {
    DesignUnderTest {
        top: "tiny".to_owned(),
        ports: ports(),
        parameters: Vec::new(),
        sources: vec![("tiny.v".to_owned(), verilog.to_owned())],
        no_inline: Vec::new(),
    }
}

fn run(
    simulator: Simulator,
    verilog: &str,
    recording: &Recording,
    trace: bool,
) -> Result<SimulationOutcome, CosimError> {
    let (toolchain, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let limit = Duration::from_secs(60);
    let (toolchain, cache) = (&toolchain, &cache);
    let run = SimulationRun {
        simulator,
        seed: 3,
        trace,
        toolchain,
        cache,
        limit,
        optimize: OptimizationLevel::FastBuild,
    };
    run.run(&dut(verilog), recording)
}

fn with_edit(from: &str, to: &str) -> String {
    assert_eq!(TINY_MODULE.matches(from).count(), 1, "{from}");
    TINY_MODULE.replace(from, to)
}

#[test]
fn ports_of_every_width_pass_in_both_simulators() {
    for simulator in Simulator::ALL {
        if require_tools(simulator.tools()) {
            let recording = single_sequence_recording(5000);
            let outcome = run(simulator, TINY_MODULE, &recording, false).unwrap();
            assert_eq!(outcome.differences, [], "{simulator}");
            assert!(outcome.waves.is_none());
        }
    }
}

#[test]
fn a_planted_fault_is_found_at_its_clock_and_port() {
    // The fault shows at the first clock at which the counter since reset reaches 41.
    let fault = with_edit("count + 12'd1", "count + 12'd1 + (count == 12'd40)");
    let lane = with_edit("~d_i;", "~d_i ^ (200'd1 << 8 * 17 + 3);");
    for simulator in Simulator::ALL {
        if !require_tools(simulator.tools()) {
            continue;
        }
        let recording = single_sequence_recording(2000);
        let found = run(simulator, &fault, &recording, false).unwrap().differences.remove(0);
        let expected = if found.port == "bit_o" { "1" } else { "029" };
        assert_eq!(found.expected, expected, "{simulator} {found:?}");
        let clock = found.clock;
        let found = run(simulator, &lane, &recording, false).unwrap().differences.remove(0);
        assert_eq!((found.port.as_str(), found.lane, found.clock), ("d_o", 17, 1), "{simulator}");
        let hex = |text: &str| u8::from_str_radix(text, 16).unwrap();
        assert_eq!(hex(&found.expected) ^ hex(&found.got), 8, "{simulator}");
        assert!(clock > 40, "{simulator}");
    }
}

/// Differences in the sequence of the first difference are reported, and none in the next sequence.
#[test]
fn differences_are_reported_until_the_sequence_ends() {
    let faults = "if (clock == 60) b_o <= 33'd0;
            if (clock == 110) c_o <= 64'd0;
            if (clock == 160) d_o <= 200'd0;";
    let faulty = with_edit("// here", faults).replace(
        "reg [11:0] count;",
        "reg [11:0] count;\n    integer clock = 0;\n    always @(posedge clk_i) clock <= clock + 1;",
    );
    // With waves the bench continues to the last clock.
    let runs = Simulator::ALL.into_iter().flat_map(|s| [(s, false), (s, true)]);
    // Three is odd, so the first run is without waves, and the second one with them.
    for (simulator, trace) in sample(runs, 3) {
        if require_tools(simulator.tools()) {
            let found = |frames| -> Vec<(String, u64)> {
                let outcome =
                    run(simulator, &faulty, &recording_in_sequences(200, frames), trace).unwrap();
                outcome.differences.into_iter().map(|found| (found.port, found.clock)).collect()
            };
            let all = [("b_o".to_owned(), 60), ("c_o".to_owned(), 110), ("d_o".to_owned(), 160)];
            assert_eq!(found(1), all[..1], "{simulator}");
            assert_eq!(found(3), all[..2], "{simulator}");
            assert_eq!(found(4), all, "{simulator}");
        }
    }
}

#[test]
fn a_register_that_reset_forgets_is_found() {
    let forgetful = with_edit("count <= 12'd0;", "");
    for simulator in Simulator::ALL {
        if require_tools(simulator.tools()) {
            let outcome =
                run(simulator, &forgetful, &single_sequence_recording(100), false).unwrap();
            let found = outcome.differences[0].clone();
            assert_eq!(found.clock, 0, "{simulator}");
            assert_eq!(simulator == Simulator::Iverilog, found.got.contains('x'), "{simulator}");
        }
    }
}

#[test]
fn waves_are_written_when_asked_for() {
    for simulator in sample(Simulator::ALL.into_iter().rev(), 2) {
        if require_tools(simulator.tools()) {
            let recording = single_sequence_recording(100);
            // Each run of a recording has waves of its own.
            let waves = || run(simulator, TINY_MODULE, &recording, true).unwrap().waves.unwrap();
            let both = [waves(), waves()];
            assert_ne!(both[0], both[1]);
            for waves in both {
                assert!(std::fs::read(waves).unwrap().len() > 100, "{simulator}");
            }
        }
    }
}

#[test]
fn a_simulation_that_ends_early_is_an_error() {
    let early = with_edit("// here", "if (count == 12'd60) $finish;");
    if require_tools(Simulator::Iverilog.tools()) {
        let error =
            run(Simulator::Iverilog, &early, &single_sequence_recording(2000), false).unwrap_err();
        assert!(matches!(error, CosimError::EndedEarly { clocks: 2000, .. }), "{error}");
    }
    let early = with_edit("// here", "if (count == 12'd60) $stop;");
    if require_tools(Simulator::Verilator.tools()) {
        let error =
            run(Simulator::Verilator, &early, &single_sequence_recording(2000), false).unwrap_err();
        assert!(matches!(error, CosimError::EndedEarly { clocks: 2000, .. }), "{error}");
    }
}

#[test]
fn sources_without_the_module_or_port_are_refused_by_name() {
    if !require_tools(Simulator::Iverilog.tools()) {
        return;
    }
    let other = with_edit("module tiny", "module tony");
    let error = run(Simulator::Iverilog, &other, &single_sequence_recording(1), false).unwrap_err();
    assert!(error.to_string().starts_with("the Verilog (tiny.v) has no module `tiny`"), "{error}");
    let other = TINY_MODULE.replace("b_i", "other_i");
    let error = run(Simulator::Iverilog, &other, &single_sequence_recording(1), false).unwrap_err();
    assert!(error.to_string().starts_with("module `tiny` has no port `b_i`"), "{error}");
    let broken = with_edit("endmodule", "end");
    let error =
        run(Simulator::Iverilog, &broken, &single_sequence_recording(1), false).unwrap_err();
    assert!(matches!(error, CosimError::Tool(_)), "{error}");
}

/// Ports of another width are refused, even if their widths have the same storage class, which C++
/// and Verilog connect without a warning.
#[test]
fn ports_of_another_width_are_refused() {
    let edits = [
        ("[32:0]  b_o", "[31:0]  b_o", "b_o", 32, 33),
        ("[7:0]   a_i", "[4:0]   a_i", "a_i", 5, 8),
        ("[11:0]  a_o", "[8:0]  a_o", "a_o", 9, 12),
        ("[199:0] d_i", "[201:2-1] d_i", "d_i", 201, 200),
        ("rst_i,", "[1:0] rst_i,", "rst_i", 2, 1),
    ];
    for simulator in Simulator::ALL {
        if !require_tools(simulator.tools()) {
            continue;
        }
        for (from, to, name, bits, of_design) in edits {
            let error = run(simulator, &with_edit(from, to), &single_sequence_recording(1), false)
                .unwrap_err();
            let CosimError::PortWidth { top, port, found, wanted } = &error else {
                panic!("{simulator} {to}: {error}");
            };
            assert_eq!((top.as_str(), port.as_str()), ("tiny", name), "{simulator}");
            assert_eq!((*found, *wanted), (bits, of_design), "{simulator} {to}");
        }
        // The name is that of a wire, but of no port.
        let other = TINY_MODULE
            .replace("input  wire [7:0]   a_i,", "")
            .replace("    reg [11:0] count;", "    wire a_i = 1'b0; reg [11:0] count;");
        assert!(
            run(simulator, &other, &single_sequence_recording(1), false).is_err(),
            "{simulator}"
        );
    }
}

#[test]
fn the_bench_is_clean_in_both_tools() {
    if !require_tools(&[Tool::Iverilog, Tool::Verilator]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| std::fs::write(dir.path().join(name), text).unwrap();
    put("tiny.v", TINY_MODULE);
    put("tiny_replay.v", &replay_bench("tiny", &ports(), &[]));
    let (toolchain, bench) = (Toolchain::system(), bench_name("tiny"));
    let files = ["tiny.v", "tiny_replay.v"];
    let check = |tool, args: &[&str]| {
        let invocation: Invocation = toolchain.invocation(tool).unwrap();
        let invocation = invocation.args(args).args(files).dir(dir.path()).merge_stderr();
        let output = toolchain.run_checked(&invocation).unwrap();
        assert_eq!(output.log(), "");
    };
    check(Tool::Iverilog, &["-g2005", "-Wall", "-s", &bench, "-o", "simulation"]);
    check(Tool::Verilator, &["--lint-only", "--timing", "-Wall", "--top-module", &bench]);
}

#[test]
fn vectors_are_lines_of_hexadecimal_numbers() {
    let text = vectors_hex(&single_sequence_recording(20), 10).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 10 + 1, "{text}");
    // The line has all five inputs and five outputs, and no number of clocks.
    assert!(lines[0].starts_with("3ff ") && lines[0].split(' ').count() == 11, "{}", lines[0]);
    let digits = lines[0].split(' ').map(str::len).zip([3, 1, 2, 9, 16, 50, 1, 3, 9, 16, 50]);
    assert!(digits.clone().all(|(digits, most)| digits <= most), "{}", lines[0]);
    assert_eq!(lines[10], "0");
}

/// Vectors that are cut off do not pass.
#[test]
fn the_bench_refuses_vectors_without_an_end() {
    if !require_tools(Simulator::Iverilog.tools()) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| std::fs::write(dir.path().join(name), text).unwrap();
    put("tiny.v", TINY_MODULE);
    put("tiny_replay.v", &replay_bench("tiny", &ports(), &[]));
    let text = vectors_hex(&single_sequence_recording(20), 20).unwrap();
    let toolchain = Toolchain::system();
    let compile = toolchain.invocation(Tool::Iverilog).unwrap().dir(dir.path());
    let compile = compile.args(["-g2005", "-o", "simulation", "tiny.v", "tiny_replay.v"]);
    toolchain.run_checked(&compile).unwrap();
    let cut = |lines: usize| {
        text.lines().take(lines).fold(String::new(), |text, line| text + line + "\n")
    };
    let in_a_line = text[..text.len() / 2].to_owned();
    for (vectors, verdict, passes) in [
        (text.clone(), "PASS 20 clocks", true),
        (cut(12), "FAIL the vectors end after 12 clocks, in the middle", false),
        (in_a_line, "FAIL", false),
        ("0\n".to_owned(), "FAIL there are no vectors", false),
        (String::new(), "FAIL the vectors end after 0 clocks", false),
    ] {
        put("vectors.hex", &vectors);
        let run = toolchain.invocation(Tool::Vvp).unwrap().args(["-n", "simulation"]);
        let output = toolchain.run(&run.dir(dir.path())).unwrap();
        let log = output.log();
        assert!(log.lines().any(|line| line.starts_with(verdict)), "{verdict}: {log}");
        assert_eq!(output.is_success(), passes, "{verdict}: {log}");
    }
}
