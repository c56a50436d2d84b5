// SPDX-License-Identifier: MIT OR Apache-2.0
//! The real tools on a small counter. A test is skipped with a message where a tool is missing.

use std::fs;
use std::time::Duration;

use foveate_tools::{
    Cache, Invocation, Source, Tool, ToolError, Toolchain,
    iverilog::{self, IverilogJob},
    nextpnr::{self, NextpnrJob},
    testing::require_tools,
    verilator::{self, VerilatorJob},
    yosys::{self, YosysJob},
};

const COUNTER: &str = "`default_nettype none
module counter (input wire clk_i, input wire rst_i, output wire [7:0] count_o);
  reg [7:0] count_q;
  always @(posedge clk_i) count_q <= rst_i ? 8'd0 : count_q + 8'd1;
  assign count_o = count_q;
endmodule
`default_nettype wire
";

const MAIN: &str = r#"
#include "Vcounter.h"
#include "verilated.h"
#if VM_TRACE
#include "verilated_fst_c.h"
#endif
#include <cstdio>
int main(int argc, char** argv) {
    VerilatedContext context;
    Vcounter top{&context};
#if VM_TRACE
    context.traceEverOn(true);
    VerilatedFstC waves;
    top.trace(&waves, 99);
    waves.open("waves.fst");
#endif
    top.rst_i = 1;
    for (int i = 0; i < 20; ++i) {
        top.clk_i = i & 1;
        if (i == 2) top.rst_i = 0;
        top.eval();
#if VM_TRACE
        waves.dump(i);
#endif
    }
#if VM_TRACE
    waves.close();
#endif
    std::printf("%d\n", top.count_o);
    top.final();
    return 0;
}
"#;

const BENCH: &str = "`timescale 1ns/1ns
module bench;
  reg clk = 1'b0, rst = 1'b1;
  wire [7:0] count;
  integer last;
  counter dut (.clk_i(clk), .rst_i(rst), .count_o(count));
  always #1 clk = ~clk;
  initial begin
    if (!$value$plusargs(\"last=%d\", last)) last = 0;
    @(posedge clk);
    #1 rst = 1'b0;
    repeat (last) @(posedge clk);
    #1 $display(\"%0d\", count);
    $finish;
  end
endmodule
";

fn source(name: &str, text: &str) -> Source {
    (name.to_owned(), text.to_owned())
}

fn counter(trace: bool) -> VerilatorJob {
    VerilatorJob {
        sources: vec![source("counter.v", COUNTER)],
        top: "counter".to_owned(),
        cpp_main: MAIN.to_owned(),
        trace,
        ..VerilatorJob::default()
    }
}

#[test]
fn verilator_builds_a_model_that_counts() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let (tools, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let simulator = verilator::build(&tools, &cache, &counter(false)).unwrap();
    let output = tools.run_checked(&Invocation::new(&simulator)).unwrap();
    assert_eq!(output.stdout, b"9\n");
    assert_eq!(verilator::build(&tools, &cache, &counter(false)).unwrap(), simulator);
    let kept = fs::read_dir(simulator.parent().unwrap()).unwrap().count();
    assert_eq!(kept, 1, "only the executable stays");
}

#[test]
fn verilator_writes_waves() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let (tools, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let dir = tempfile::tempdir().unwrap();
    let simulator = verilator::build(&tools, &cache, &counter(true)).unwrap();
    let output = tools.run_checked(&Invocation::new(simulator).dir(dir.path())).unwrap();
    assert_eq!(output.stdout, b"9\n");
    assert!(fs::metadata(dir.path().join("waves.fst")).unwrap().len() > 0);
}

#[test]
fn verilator_lint_is_strict_by_default() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let (tools, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let narrow = COUNTER.replace("8'd1", "9'd1");
    let mut job = VerilatorJob { sources: vec![source("counter.v", &narrow)], ..counter(false) };
    let error = verilator::build(&tools, &cache, &job).unwrap_err();
    assert!(matches!(error, ToolError::Failed { .. }) && error.to_string().contains("WIDTH"));
    assert!(verilator::lint(&tools, &job.sources, "counter", None).is_err());
    let waiver = "`verilator_config\nlint_off -rule WIDTH -file \"counter.v\"\n";
    verilator::lint(&tools, &job.sources, "counter", Some(waiver)).unwrap();
    job.lint = verilator::LintMode::Lenient;
    verilator::build(&tools, &cache, &job).unwrap();
}

#[test]
fn a_broken_main_shows_the_compiler_error() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (tools, cache) = (Toolchain::system(), Cache::in_folder(folder.path()).unwrap());
    let job = VerilatorJob { cpp_main: "int main() { return x; }".to_owned(), ..counter(false) };
    let error = verilator::build(&tools, &cache, &job).unwrap_err().to_string();
    assert!(error.contains("‘x’") || error.contains("'x'"), "{error}");
    assert!(error.contains("complete log in"), "{error}");
}

#[test]
fn icarus_compiles_and_runs() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp]) {
        return;
    }
    let (tools, cache) = (Toolchain::system(), Cache::temporary().unwrap());
    let dir = tempfile::tempdir().unwrap();
    let job = IverilogJob {
        sources: vec![source("bench.v", BENCH), source("rtl/counter.v", COUNTER)],
        top: "bench".to_owned(),
        ..IverilogJob::default()
    };
    let program = iverilog::compile(&tools, &cache, &job).unwrap();
    let limit = Duration::from_secs(60);
    let args = ["+last=7".to_owned()];
    let output = iverilog::run(&tools, &program, &args, dir.path(), limit).unwrap();
    assert_eq!(output.stdout, b"7\n", "{}", output.log());

    let implicit = BENCH.replace("wire [7:0] count;", "");
    let sources = vec![source("bench.v", &implicit), source("rtl/counter.v", COUNTER)];
    let job = IverilogJob { sources, strict: true, ..job };
    let error = iverilog::compile(&tools, &cache, &job).unwrap_err().to_string();
    assert!(error.contains("bench.v"), "{error}");
}

#[test]
fn yosys_runs_a_script() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let (tools, cache) = (Toolchain::system(), Cache::temporary().unwrap());
    let job = YosysJob {
        sources: vec![source("counter.v", COUNTER)],
        script: "read_verilog counter.v\nsynth -top counter\ntee -o stat.json stat -json\n".into(),
        outputs: vec!["stat.json".to_owned()],
    };
    let run = yosys::run(&tools, &cache, &job).unwrap();
    assert!(run.log.contains("counter.v"));
    assert!(run.files["stat.json"].starts_with(b"{"));
    assert_eq!(yosys::run(&tools, &cache, &job).unwrap(), run);

    let incomplete = YosysJob { outputs: vec!["other.json".to_owned()], ..job.clone() };
    let error = yosys::run(&tools, &cache, &incomplete).unwrap_err();
    assert!(matches!(error, ToolError::MissingOutput { .. }), "{error}");
    let broken = YosysJob { script: "read_verilog missing.v\n".to_owned(), ..job };
    let error = yosys::run(&tools, &cache, &broken).unwrap_err().to_string();
    assert!(error.contains("missing.v"), "{error}");
}

#[test]
fn nextpnr_places_routes_and_caches() {
    if !require_tools(&[Tool::Yosys, Tool::NextpnrIce40]) {
        return;
    }
    let (tools, cache) = (Toolchain::system(), Cache::temporary().unwrap());
    let synthesis = YosysJob {
        sources: vec![source("counter.v", COUNTER)],
        script: "read_verilog counter.v\nsynth_ice40 -top counter -json out.json\n".to_owned(),
        outputs: vec!["out.json".to_owned()],
    };
    let netlist = yosys::run(&tools, &cache, &synthesis).unwrap().files["out.json"].clone();
    let up5k = ["--up5k", "--package", "sg48", "--pcf-allow-unconstrained"].map(str::to_owned);
    let job = NextpnrJob {
        tool: Tool::NextpnrIce40,
        extra_file: None,
        args: up5k.to_vec(),
        seed: 1,
        netlist: netlist.clone(),
    };
    let report = nextpnr::run(&tools, &cache, &job).unwrap();
    let json: serde_json::Value = serde_json::from_slice(&report).unwrap();
    assert!(json["utilization"]["ICESTORM_LC"]["used"].as_u64().unwrap() >= 8, "{json}");
    let places = fs::read_dir(cache.root()).unwrap().count();
    assert_eq!(nextpnr::run(&tools, &cache, &job).unwrap(), report);
    assert_eq!(fs::read_dir(cache.root()).unwrap().count(), places, "it was kept");
    nextpnr::run(&tools, &cache, &NextpnrJob { seed: 2, ..job.clone() }).unwrap();
    assert_eq!(fs::read_dir(cache.root()).unwrap().count(), places + 1, "the seed is in the key");

    let refused = NextpnrJob { args: vec!["--up6k".to_owned()], ..job };
    let ToolError::Failed { command, full, .. } =
        nextpnr::run(&tools, &cache, &refused).unwrap_err()
    else {
        panic!("it has failed in another way")
    };
    assert!(command.contains("--seed 1") && full.contains("up6k"), "{command}: {full}");
}
