// SPDX-License-Identifier: MIT OR Apache-2.0
//! The models of block RAM and DSP cells against the RTL that Yosys maps to them: memories of every
//! width and of both sizes, products of every sign. A wrong model is found, and a mode that is not
//! modelled is refused.

use crate::common::in_parallel;
use foveate_cosim::{
    CosimError, Difference, Dut, Recorder, Recording, Run, Simulator, cell_models,
};
use foveate_design::{Direction, Port, PortRole, Qualifier};
use foveate_toolchain::testing::require_tools;
use foveate_toolchain::verilator::Optimize;
use foveate_toolchain::yosys::{self, YosysJob};
use foveate_toolchain::{Cache, Source, Tool, Toolchain};
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

const TOOLS: &[Tool] = &[Tool::Yosys, Tool::Iverilog, Tool::Vvp];

/// What a word shows is only compared where `known_i` has said, a clock before, that it was written.
const MEMORY: &str = "module dut (
    input wire clk_i, input wire write_i, input wire [BITS-1:0] address_i,
    input wire [WIDTH-1:0] data_i, input wire known_i,
    output reg known_o, output wire [WIDTH-1:0] data_o
);
    always @(posedge clk_i) known_o <= known_i;
    serial_memory #(.WIDTH(WIDTH), .WORDS(WORDS), .ADDRESS_BITS(BITS), .BLOCK(1)) u_memory (
        .clk_i(clk_i), .write_i(write_i), .address_i(address_i), .data_i(data_i), .data_o(data_o)
    );
endmodule
";

const PRODUCT: &str = "module dut (
    input wire clk_i, input wire signed [26:0] a_i, input wire signed [17:0] b_i,
    output reg signed [44:0] product_o
);
    always @(posedge clk_i) product_o <= a_i * b_i;
endmodule
";

fn port(name: &str, direction: Direction, role: PortRole, width: u32) -> Port {
    let qualifier = match role {
        PortRole::ForwardPixel => Qualifier::With(PortRole::ForwardValid),
        _ => Qualifier::Always,
    };
    let (name, doc) = (name.to_owned(), String::new());
    Port { name, direction, role, width, lanes: 1, per_lane: false, qualifier, doc }
}

fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    *state >> 20
}

/// A memory of that many words, and what it must do with few addresses that are often met again.
fn memory(width: u32, words: u32) -> (Dut, Recording) {
    use Direction::{Input, Output};
    let bits = words.ilog2();
    let ports = vec![
        port("clk_i", Input, PortRole::Clock, 1),
        port("write_i", Input, PortRole::Valid, 1),
        port("address_i", Input, PortRole::Border, bits),
        port("data_i", Input, PortRole::Pixel, width),
        port("known_i", Input, PortRole::Reset, 1),
        port("known_o", Output, PortRole::ForwardValid, 1),
        port("data_o", Output, PortRole::ForwardPixel, width),
    ];
    let mut recorder = Recorder::new(&ports).unwrap();
    let (inputs, outputs) = (recorder.inputs().clone(), recorder.outputs().clone());
    let (mut state, mut written) = (1, BTreeMap::new());
    let mut addresses: Vec<u64> = (0..60).map(|_| random(&mut state) % u64::from(words)).collect();
    addresses.extend((0..bits).map(|bit| 1 << bit).chain([0, u64::from(words) - 1]));
    let mask = (1 << width) - 1;
    for _ in 0..2000 {
        let address = addresses[usize::try_from(random(&mut state)).unwrap() % addresses.len()];
        let (write, data) = (random(&mut state) % 2, random(&mut state) & mask);
        let before = written.get(&address).copied();
        let (mut input, mut output) = (inputs.record(), outputs.record());
        for (field, value) in
            inputs.fields().iter().zip([write, address, data, before.is_some().into()])
        {
            field.set(&mut input, 0, value);
        }
        outputs.fields()[0].set(&mut output, 0, before.is_some().into());
        outputs.fields()[1].set(&mut output, 0, before.unwrap_or(0));
        recorder.push(&input, &output).unwrap();
        if write == 1 {
            written.insert(address, data);
        }
    }
    let text = MEMORY.replace("WIDTH-1", &(width - 1).to_string());
    let text = text.replace("BITS-1", &(bits - 1).to_string());
    let values = format!(".WIDTH({width}), .WORDS({words}), .ADDRESS_BITS({bits})");
    let text = text.replace(".WIDTH(WIDTH), .WORDS(WORDS), .ADDRESS_BITS(BITS)", &values);
    let leaf = |name: &str| {
        let leaf = foveate_emit::LEAVES.iter().find(|leaf| leaf.name == name).unwrap();
        (format!("{name}.v"), leaf.contents.to_owned())
    };
    let sources = vec![leaf("frame_store"), leaf("serial_memory"), ("dut.v".to_owned(), text)];
    (dut(ports, sources), recorder.finish().unwrap())
}

/// Products of the extremes and of random factors.
fn product() -> (Dut, Recording) {
    use Direction::{Input, Output};
    let ports = vec![
        port("clk_i", Input, PortRole::Clock, 1),
        port("a_i", Input, PortRole::Pixel, 27),
        port("b_i", Input, PortRole::Border, 18),
        port("product_o", Output, PortRole::AnyScore, 45),
    ];
    let mut recorder = Recorder::new(&ports).unwrap();
    let (inputs, outputs) = (recorder.inputs().clone(), recorder.outputs().clone());
    let extremes = |bits: u32| [0, 1, -1, (1i64 << (bits - 1)) - 1, -(1i64 << (bits - 1))];
    let mut factors: Vec<(i64, i64)> = Vec::new();
    for a in extremes(27) {
        factors.extend(extremes(18).map(|b| (a, b)));
    }
    let mut state = 1;
    let mut signed =
        |bits: u32| i64::try_from(random(&mut state) % (1 << bits)).unwrap() - (1 << (bits - 1));
    factors.extend((0..500).map(|_| (signed(27), signed(18))));
    for (a, b) in factors {
        let (mut input, mut output) = (inputs.record(), outputs.record());
        inputs.fields()[0].set(&mut input, 0, a.cast_unsigned());
        inputs.fields()[1].set(&mut input, 0, b.cast_unsigned());
        outputs.fields()[0].set(&mut output, 0, (a * b).cast_unsigned());
        recorder.push(&input, &output).unwrap();
    }
    let sources = vec![("dut.v".to_owned(), PRODUCT.to_owned())];
    (dut(ports, sources), recorder.finish().unwrap())
}

fn dut(ports: Vec<Port>, sources: Vec<Source>) -> Dut {
    let (top, parameters, no_inline) = ("dut".to_owned(), Vec::new(), Vec::new());
    Dut { top, ports, parameters, sources, no_inline }
}

/// What Yosys makes of it, and the cells that it takes.
fn synthesized(dut: &Dut) -> (Dut, BTreeSet<String>) {
    let (toolchain, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let read: String =
        dut.sources.iter().map(|(name, _)| format!("read_verilog {name}\n")).collect();
    let script = format!(
        "{read}synth_xilinx -family xcup -flatten -noiopad -noclkbuf -top dut\n\
         delete =A:blackbox =A:whitebox\nwrite_verilog -noattr netlist.v\n"
    );
    let outputs = vec!["netlist.v".to_owned()];
    let job = YosysJob { sources: dut.sources.clone(), script, outputs };
    let mut files = yosys::run(&toolchain, &cache, &job).unwrap().files;
    let netlist = String::from_utf8(files.remove("netlist.v").unwrap()).unwrap();
    let name = |line: &str| {
        let word = line.strip_prefix("  ")?.split([' ', '(']).next()?;
        let is_cell = word.starts_with(|c: char| c.is_ascii_uppercase());
        is_cell.then(|| word.to_owned())
    };
    let cells: BTreeSet<String> = netlist.lines().filter_map(name).collect();
    let library = yosys::cell_models(&toolchain, &cache, "xilinx/cells_sim.v").unwrap();
    let models = cell_models(&library, cells.clone()).unwrap();
    let sources = vec![("cells.v".to_owned(), models), ("netlist.v".to_owned(), netlist)];
    (Dut { sources, ..dut.clone() }, cells)
}

fn run(dut: &Dut, recording: &Recording) -> Result<Vec<Difference>, CosimError> {
    let (toolchain, cache) = (&Toolchain::system(), &Cache::from_env().unwrap());
    let (simulator, limit) = (Simulator::Iverilog, Duration::from_secs(120));
    let (seed, trace, optimize) = (1, false, Optimize::Build);
    let run = Run { simulator, seed, trace, toolchain, cache, limit, optimize };
    Ok(run.run(dut, recording)?.differences)
}

/// The same with one edit of the models, or of the netlist, where the text must be.
fn edited(dut: &Dut, file: usize, from: &str, to: &str) -> Dut {
    let mut sources = dut.sources.clone();
    assert!(sources[file].1.contains(from), "{from}");
    sources[file].1 = sources[file].1.replace(from, to);
    Dut { sources, ..dut.clone() }
}

#[test]
fn block_rams_of_every_width_do_what_the_rtl_does() {
    if !require_tools(TOOLS) {
        return;
    }
    let shapes = [(1, 1 << 14), (2, 1 << 13), (4, 1 << 12), (8, 1 << 11), (16, 1 << 10)];
    let larger = [(1, 1 << 15), (8, 1 << 12), (16, 1 << 11), (32, 1 << 10), (10, 1 << 12)];
    let failures = in_parallel(&[&shapes[..], &larger].concat(), |&(width, words)| {
        let (rtl, recording) = memory(width, words);
        let (netlist, cells) = synthesized(&rtl);
        let is_ram = |cell: &&String| cell.starts_with("RAMB");
        if cells.iter().filter(is_ram).count() == 0 {
            return Err(format!("{width} bits, {words} words: no block RAM in {cells:?}"));
        }
        for dut in [&rtl, &netlist] {
            match run(dut, &recording) {
                Ok(found) if found.is_empty() => {}
                other => return Err(format!("{width} bits, {words} words, {cells:?}: {other:?}")),
            }
        }
        Ok(())
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn a_product_is_that_of_the_rtl() {
    if !require_tools(TOOLS) {
        return;
    }
    let (rtl, recording) = product();
    let (netlist, cells) = synthesized(&rtl);
    assert!(cells.contains("DSP48E2"), "{cells:?}");
    for dut in [&rtl, &netlist] {
        assert_eq!(run(dut, &recording).unwrap(), []);
    }
    for (from, to) in [
        ("a * b", "a * b + 48'd1"),
        ("{{30{B[17]}}, B}", "{30'd0, B}"),
        ("{{21{A[26]}}, A[26:0]}", "{{22{A[25]}}, A[25:0]}"),
        ("9'h005}", "9'h035}"),
    ] {
        let found = run(&edited(&netlist, 0, from, to), &recording).unwrap();
        assert!(!found.is_empty(), "not found: {to}");
    }
    refused(&edited(&netlist, 1, ".PREG(32'sd0)", ".PREG(32'sd1)"), &recording, "registers");
    refused(&edited(&netlist, 1, ".PREG(", ".RND(48'd1), .PREG("), &recording, "RND");
    let other = edited(&netlist, 1, "\"ONE48\"", "\"TWO24\"");
    refused(&other, &recording, "only_multiplies");
}

#[test]
fn a_wrong_block_ram_is_found_and_another_mode_is_refused() {
    if !require_tools(TOOLS) {
        return;
    }
    for (width, words, cell) in [(8, 1 << 11, "RAMB18E2"), (16, 1 << 11, "RAMB36E2")] {
        let (rtl, recording) = memory(width, words);
        let (netlist, cells) = synthesized(&rtl);
        assert!(cells.contains(cell), "{cells:?}");
        for (from, to) in [
            (
                "reads ? words[address]",
                "reads && WEA ? {DINPADINP, DINADIN} : reads ? words[address]",
            ),
            ("ADDRARDADDR / DATA", "ADDRARDADDR / (2 * DATA)"),
            ("<= {DINPADINP, DINADIN}", "<= {DINPADINP, DINADIN} & ~4"),
            ("WEA === {MOST{1'b1}}", "1'b1"),
            ("posedge CLKARDCLK", "negedge CLKARDCLK"),
        ] {
            let found = run(&edited(&netlist, 0, from, to), &recording).unwrap();
            assert!(!found.is_empty(), "{cell}: not found: {to}");
        }
        for (from, to, said) in [
            (".DOA_REG(32'sd0)", ".DOA_REG(32'sd1)", "output_registers"),
            (".WRITE_MODE_A(\"READ_FIRST\")", ".WRITE_MODE_A(\"NO_CHANGE\")", "READ_FIRST"),
            (".READ_WIDTH_B(32'd0)", ".READ_WIDTH_B(32'd1)", "port_B"),
            (".WRITE_WIDTH_A(32'd", ".WRITE_WIDTH_A(32'd1", "one_width"),
            (".DOA_REG(", ".IS_CLKARDCLK_INVERTED(1'b1), .DOA_REG(", "inverted"),
            (".DOA_REG(", ".EN_ECC_READ(\"TRUE\"), .DOA_REG(", "EN_ECC_READ"),
            (".INIT_00(256'hx", ".INIT_00(256'h0", "start_unknown"),
        ] {
            refused(&edited(&netlist, 1, from, to), &recording, said);
        }
    }
}

/// It does not compile, and the message has this in it.
fn refused(dut: &Dut, recording: &Recording, said: &str) {
    match run(dut, recording) {
        Err(CosimError::Tool(error)) => {
            assert!(error.to_string().contains(said), "{said}: {error}");
        }
        other => panic!("{said}: {other:?}"),
    }
}
