// SPDX-License-Identifier: MIT OR Apache-2.0
//! `raster_memory` in its form for the ECP5 reads the same words as in its portable form, and uses
//! the output register of the block RAM.

use std::path::Path;
use std::time::Duration;

use foveate_emit::LEAVES;
use foveate_tools::{
    Cache, Source, Tool, Toolchain,
    iverilog::{self, IverilogJob},
    testing::{require_tools, sample},
    yosys::{self, YosysJob},
};

/// The bits of a word and the number of words: each width of a block, several blocks, blocks that
/// are full or not, and several banks.
const SHAPES: &[(u32, u32)] = &[
    (1, 2),
    (12, 240),
    (36, 480),
    (18, 1024),
    (16, 1920),
    (3, 4096),
    (5, 8192),
    (8, 16384),
    (8, 10240),
    (2, 40000),
];

fn memory() -> &'static str {
    LEAVES.iter().find(|leaf| leaf.name == "raster_memory").unwrap().contents
}

/// Returns what a bench prints that compares both forms, the one for the ECP5 with this edit.
fn bench_output((width, words): (u32, u32), from: &str, to: &str) -> String {
    let (toolchain, cache) = (Toolchain::system(), Cache::temporary().unwrap());
    let own = memory().replacen("module raster_memory", "module ecp5_memory", 1);
    let own = own.replace("`ifdef FOVEATE_ECP5", "`ifndef PORTABLE");
    assert!(own.contains(from), "{from}");
    let bench = include_str!("ecp5/bench.v")
        .replacen("WIDTH = 16", &format!("WIDTH = {width}"), 1)
        .replacen("WORDS = 240", &format!("WORDS = {words}"), 1);
    let sources = [
        ("raster_memory.v", memory().to_owned()),
        ("ecp5_memory.v", own.replacen(from, to, 1)),
        ("dp16kd.v", include_str!("ecp5/dp16kd.v").to_owned()),
        ("bench.v", bench),
    ];
    let job = IverilogJob {
        sources: sources.map(|(name, text)| (name.to_owned(), text)).to_vec(),
        top: "bench".to_owned(),
        ..IverilogJob::default()
    };
    let program = iverilog::compile(&toolchain, &cache, &job).unwrap();
    let limit = Duration::from_secs(300);
    let shown = iverilog::run(&toolchain, &program, &[], Path::new("."), limit).unwrap();
    String::from_utf8(shown.stdout).unwrap()
}

#[test]
fn blocks_of_the_ecp5_show_what_the_memory_shows() {
    if !require_tools(&[Tool::Iverilog]) {
        return;
    }
    for &shape in sample(SHAPES, 4) {
        let shown = bench_output(shape, "", "");
        assert!(shown.starts_with("PASS"), "{shape:?}: {shown}");
    }
    let faults = [
        ((16, 1920), "<< SHIFT;", "<< SHIFT >> 1;"),
        ((12, 240), "14'd3", "14'd1"),
        ((16, 1920), ".CEB(read_i)", ".CEB(1'b1)"),
        ((36, 480), "given_all[block*BITS+:BITS]", "given_all[0+:BITS]"),
        ((16, 1920), ".OCEB(output_i)", ".OCEB(1'b1)"),
        ((2, 40000), "write_i && write_address >> PLACE_BITS == bank", "write_i"),
        ((2, 40000), "if (output_i) bank_q", "bank_q"),
        ((2, 40000), "if (read_i) read_bank_q", "read_bank_q"),
    ];
    for (shape, from, to) in sample(faults, 3) {
        let shown = bench_output(shape, from, to);
        assert!(!shown.contains("PASS"), "not found: {to}: {shown}");
    }
}

/// Returns what Yosys makes of the memory of a deep design: the number of blocks, of blocks with
/// their output register, and of flip-flops. `define` defines the family, or is empty.
fn synthesis_counts(define: &str) -> (usize, usize, usize) {
    let (toolchain, cache) = (Toolchain::system(), Cache::temporary().unwrap());
    let script = format!(
        "read_verilog {define} raster_memory.v\n\
         chparam -set OUTPUT_STAGE 1 raster_memory\n\
         synth_ecp5 -abc9 -top raster_memory\n\
         write_verilog -noattr out.v\n"
    );
    let sources: Vec<Source> = vec![("raster_memory.v".to_owned(), memory().to_owned())];
    let job = YosysJob { sources, script, outputs: vec!["out.v".to_owned()] };
    let run = yosys::run(&toolchain, &cache, &job).unwrap();
    let text = String::from_utf8(run.files["out.v"].clone()).unwrap();
    let count = |what: &str| text.matches(what).count();
    (count("DP16KD #("), count(".REGMODE_B(\"OUTREG\")"), count("TRELLIS_FF #("))
}

#[test]
fn only_where_the_family_is_defined_the_register_is_that_of_the_block() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    assert_eq!(synthesis_counts("-DFOVEATE_ECP5"), (1, 1, 0));
    assert_eq!(synthesis_counts(""), (1, 0, 16));
}
