// SPDX-License-Identifier: MIT OR Apache-2.0
//! The models of block RAM and DSP cells against the RTL that Yosys maps to them: memories of every
//! width and of both sizes, products of every sign. A wrong model is found, and a mode without a
//! model is refused.

use crate::common::in_parallel;
use foveate_cosim::{
    CosimError, DesignUnderTest, PortDifference, Recorder, Recording, SimulationRun, Simulator,
    cell_models, has_miswired_block_ram,
};
use foveate_design::{OutputQualifier, Port, PortDirection, PortRole};
use foveate_tools::{
    Cache, Source, Tool, Toolchain,
    testing::{require_tools, sample},
    verilator::OptimizationLevel,
    yosys::{self, YosysJob},
};
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

const TOOLS: &[Tool] = &[Tool::Yosys, Tool::Iverilog, Tool::Vvp];

/// A memory with one port. A word is compared only if `known_i` said a clock earlier that it was
/// written.
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

/// A memory with a separate read port, which can read a word at the edge at which it is written.
const TWO_PORT_MEMORY: &str = "module dut (
    input wire clk_i, input wire write_i, input wire [BITS-1:0] address_i,
    input wire [WIDTH-1:0] data_i, input wire known_i,
    output reg known_o, output wire [WIDTH-1:0] data_o,
    input wire read_i, input wire [BITS-1:0] read_address_i
);
    always @(posedge clk_i) known_o <= known_i;
    raster_memory #(.WIDTH(WIDTH), .WORDS(WORDS), .ADDRESS_BITS(BITS)) u_memory (
        .clk_i(clk_i), .write_i(write_i), .write_address_i(address_i), .data_i(data_i),
        .read_i(read_i), .read_address_i(read_address_i), .output_i(1'b1), .data_o(data_o)
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

#[derive(Clone, Copy, Debug, PartialEq)]
enum MemoryPorts {
    /// One port reads and writes.
    One,
    /// One port writes, the other reads.
    Two,
}

fn port(name: &str, direction: PortDirection, role: PortRole, width: u32) -> Port {
    let qualifier = match role {
        PortRole::ForwardPixel => OutputQualifier::WhileSet(PortRole::ForwardValid),
        _ => OutputQualifier::Always,
    };
    let (name, doc) = (name.to_owned(), String::new());
    Port { name, direction, role, width, lanes: 1, per_lane: false, qualifier, doc }
}

fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    *state >> 20
}

/// Returns a memory of `words` words, and a recording that uses few addresses, so that each is used
/// often.
fn memory_with_recording(
    ports: MemoryPorts,
    width: u32,
    words: u32,
) -> (DesignUnderTest, Recording) {
    use PortDirection::{Input, Output};
    let bits = words.ilog2();
    let mut list = vec![
        port("clk_i", Input, PortRole::Clock, 1),
        port("write_i", Input, PortRole::Valid, 1),
        port("address_i", Input, PortRole::Border, bits),
        port("data_i", Input, PortRole::Pixel, width),
        port("known_i", Input, PortRole::Reset, 1),
        port("known_o", Output, PortRole::ForwardValid, 1),
        port("data_o", Output, PortRole::ForwardPixel, width),
    ];
    if ports == MemoryPorts::Two {
        list.push(port("read_i", Input, PortRole::ForwardReady, 1));
        list.push(port("read_address_i", Input, PortRole::ReferencePixel, bits));
    }
    let mut recorder = Recorder::new(&list).unwrap();
    let (inputs, outputs) = (recorder.inputs().clone(), recorder.outputs().clone());
    let (mut state, mut written, mut shown) = (1, BTreeMap::new(), None);
    let mut addresses: Vec<u64> = (0..60).map(|_| random(&mut state) % u64::from(words)).collect();
    addresses.extend((0..bits).map(|bit| 1 << bit).chain([0, u64::from(words) - 1]));
    let mask = u64::MAX >> (64 - width);
    for _ in 0..2000 {
        let mut any = || addresses[usize::try_from(random(&mut state)).unwrap() % addresses.len()];
        let (address, elsewhere) = (any(), any());
        let (write, data) = (random(&mut state) % 2, random(&mut state) << 32 ^ random(&mut state));
        // A separate read port reads at two of three clocks, often at the address of the write.
        let (read, read_address) = match (ports, random(&mut state) % 6) {
            (MemoryPorts::One, _) => (1, address),
            (MemoryPorts::Two, dice) => {
                (u64::from(dice < 4), if dice == 0 { address } else { elsewhere })
            }
        };
        if read == 1 {
            shown = written.get(&read_address).copied();
        }
        let (mut input, mut output) = (inputs.zero_record(), outputs.zero_record());
        let known = u64::from(shown.is_some());
        let values = [write, address, data & mask, known, read, read_address];
        for (field, value) in inputs.fields().iter().zip(values) {
            field.set(&mut input, 0, value);
        }
        outputs.fields()[0].set(&mut output, 0, known);
        outputs.fields()[1].set(&mut output, 0, shown.unwrap_or(0));
        recorder.push(&input, &output).unwrap();
        if write == 1 {
            written.insert(address, data & mask);
        }
    }
    let (text, leaves) = match ports {
        MemoryPorts::One => (MEMORY, &["frame_store", "serial_memory"][..]),
        MemoryPorts::Two => (TWO_PORT_MEMORY, &["raster_memory"][..]),
    };
    let text = text.replace("WIDTH-1", &(width - 1).to_string());
    let text = text.replace("BITS-1", &(bits - 1).to_string());
    let values = format!(".WIDTH({width}), .WORDS({words}), .ADDRESS_BITS({bits})");
    let text = text.replace(".WIDTH(WIDTH), .WORDS(WORDS), .ADDRESS_BITS(BITS)", &values);
    let leaf = |name: &&str| {
        let leaf = foveate_emit::LEAVES.iter().find(|leaf| leaf.name == *name).unwrap();
        (format!("{name}.v"), leaf.contents.to_owned())
    };
    let mut sources: Vec<Source> = leaves.iter().map(leaf).collect();
    sources.push(("dut.v".to_owned(), text));
    (dut(list, sources), recorder.finish().unwrap())
}

/// Returns a multiplier, and a recording with the extremes and random factors.
fn product_with_recording() -> (DesignUnderTest, Recording) {
    use PortDirection::{Input, Output};
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
        let (mut input, mut output) = (inputs.zero_record(), outputs.zero_record());
        inputs.fields()[0].set(&mut input, 0, a.cast_unsigned());
        inputs.fields()[1].set(&mut input, 0, b.cast_unsigned());
        outputs.fields()[0].set(&mut output, 0, (a * b).cast_unsigned());
        recorder.push(&input, &output).unwrap();
    }
    let sources = vec![("dut.v".to_owned(), PRODUCT.to_owned())];
    (dut(ports, sources), recorder.finish().unwrap())
}

fn dut(ports: Vec<Port>, sources: Vec<Source>) -> DesignUnderTest {
    let (top, parameters, no_inline) = ("dut".to_owned(), Vec::new(), Vec::new());
    DesignUnderTest { top, ports, parameters, sources, no_inline }
}

/// Returns the netlist of each module and the names of its cells. All modules share one run of
/// Yosys, because it needs two seconds to read its library of cells.
fn synthesize_all(duts: &[&DesignUnderTest]) -> Vec<(DesignUnderTest, BTreeSet<String>)> {
    let (toolchain, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let (mut sources, mut all) = (BTreeMap::new(), String::new());
    let (mut outputs, mut write) = (Vec::new(), String::new());
    for (number, dut) in duts.iter().enumerate() {
        let module = format!("dut_{number}");
        for (name, text) in &dut.sources {
            let own = format!("(* keep_hierarchy *) module {module} (");
            let is_own = name == "dut.v";
            let name = if is_own { format!("{module}.v") } else { name.clone() };
            sources.insert(name, text.replace("module dut (", &own));
        }
        all.push_str(&format!("(* keep *) {module} u_{number} ();\n"));
        write.push_str(&format!(
            "select {module}\nwrite_verilog -noattr -selected {module}.net.v\nselect -clear\n"
        ));
        outputs.push(format!("{module}.net.v"));
    }
    sources.insert("all.v".to_owned(), format!("module all;\n{all}endmodule\n"));
    let names: Vec<&str> = sources.keys().map(String::as_str).collect();
    let script = format!(
        "read_verilog {}\nsynth_xilinx -family xcup -flatten -noiopad -noclkbuf -top all\n\
         delete =A:blackbox =A:whitebox\n{write}",
        names.join(" ")
    );
    let job = YosysJob { sources: sources.into_iter().collect(), script, outputs: outputs.clone() };
    let mut files = yosys::run(&toolchain, &cache, &job).unwrap().files;
    let library = yosys::cell_models(&toolchain, &cache, "xilinx/cells_sim.v").unwrap();
    let of = |(number, output): (usize, &String)| {
        let netlist = String::from_utf8(files.remove(output).unwrap()).unwrap();
        let netlist = netlist.replace(&format!("module dut_{number}("), "module dut(");
        let name = |line: &str| {
            let word = line.strip_prefix("  ")?.split([' ', '(']).next()?;
            let is_cell = word.starts_with(|c: char| c.is_ascii_uppercase());
            is_cell.then(|| word.to_owned())
        };
        let cells: BTreeSet<String> = netlist.lines().filter_map(name).collect();
        let models = cell_models(&library, cells.clone()).unwrap();
        let sources = vec![("cells.v".to_owned(), models), ("netlist.v".to_owned(), netlist)];
        (DesignUnderTest { sources, ..duts[number].clone() }, cells)
    };
    outputs.iter().enumerate().map(of).collect()
}

fn run_in_icarus(
    dut: &DesignUnderTest,
    recording: &Recording,
) -> Result<Vec<PortDifference>, CosimError> {
    let (toolchain, cache) = (&Toolchain::system(), &Cache::from_env().unwrap());
    let (simulator, limit) = (Simulator::Iverilog, Duration::from_secs(120));
    let (seed, trace, optimize) = (1, false, OptimizationLevel::FastBuild);
    let run = SimulationRun { simulator, seed, trace, toolchain, cache, limit, optimize };
    Ok(run.run(dut, recording)?.differences)
}

/// Returns the module with one edit of the models (`file` 0) or of the netlist (`file` 1). The text
/// must be there.
fn with_edit(dut: &DesignUnderTest, file: usize, from: &str, to: &str) -> DesignUnderTest {
    let mut sources = dut.sources.clone();
    assert!(sources[file].1.contains(from), "{from}");
    sources[file].1 = sources[file].1.replace(from, to);
    DesignUnderTest { sources, ..dut.clone() }
}

#[test]
fn block_rams_of_every_width_do_what_the_rtl_does() {
    if !require_tools(TOOLS) {
        return;
    }
    let shapes = [(1, 1 << 14), (2, 1 << 13), (4, 1 << 12), (8, 1 << 11), (16, 1 << 10)];
    let larger = [(1, 1 << 15), (8, 1 << 12), (16, 1 << 11), (32, 1 << 10), (10, 1 << 12)];
    // Words that are wider than a port; one needs two cells, and one leaves a port unused.
    let wide = [(9, 1 << 11), (36, 1 << 9), (27, 1 << 9), (40, 1 << 10)];
    let one = [&shapes[..], &larger].concat().into_iter();
    let one = one.map(|shape| (MemoryPorts::One, shape));
    let two =
        [&shapes[..], &larger, &wide].concat().into_iter().map(|shape| (MemoryPorts::Two, shape));
    let shapes: Vec<(MemoryPorts, (u32, u32))> = sample(one.chain(two), 6);
    let memories: Vec<(DesignUnderTest, Recording)> = shapes
        .iter()
        .map(|&(ports, (width, words))| memory_with_recording(ports, width, words))
        .collect();
    let netlists = synthesize_all(&memories.iter().map(|(rtl, _)| rtl).collect::<Vec<_>>());
    let all: Vec<_> = shapes.iter().zip(memories.iter().zip(&netlists)).collect();
    let failures = in_parallel(&all, |&(&(ports, (width, words)), ((rtl, recording), netlist))| {
        let (netlist, cells) = netlist;
        let is_ram = |cell: &&String| cell.starts_with("RAMB");
        if cells.iter().filter(is_ram).count() == 0 {
            return Err(format!(
                "{ports:?} {width} bits, {words} words: no block RAM in {cells:?}"
            ));
        }
        for dut in [rtl, netlist] {
            match run_in_icarus(dut, recording) {
                Ok(found) if found.is_empty() => {}
                other => {
                    return Err(format!(
                        "{ports:?} {width} bits, {words} words, {cells:?}: {other:?}"
                    ));
                }
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
    let (rtl, recording) = product_with_recording();
    let (netlist, cells) = synthesize_all(&[&rtl]).remove(0);
    assert!(cells.contains("DSP48E2"), "{cells:?}");
    for dut in [&rtl, &netlist] {
        assert_eq!(run_in_icarus(dut, &recording).unwrap(), []);
    }
    for (from, to) in [
        ("a * b", "a * b + 48'd1"),
        ("{{30{B[17]}}, B}", "{30'd0, B}"),
        ("{{21{A[26]}}, A[26:0]}", "{{22{A[25]}}, A[25:0]}"),
        ("9'h005}", "9'h035}"),
    ] {
        let found = run_in_icarus(&with_edit(&netlist, 0, from, to), &recording).unwrap();
        assert!(!found.is_empty(), "not found: {to}");
    }
    assert_refused(
        &with_edit(&netlist, 1, ".PREG(32'sd0)", ".PREG(32'sd1)"),
        &recording,
        "registers",
    );
    assert_refused(&with_edit(&netlist, 1, ".PREG(", ".RND(48'd1), .PREG("), &recording, "RND");
    let other = with_edit(&netlist, 1, "\"ONE48\"", "\"TWO24\"");
    assert_refused(&other, &recording, "only_multiplies");
}

#[test]
fn a_wrong_block_ram_is_found_and_another_mode_is_refused() {
    if !require_tools(TOOLS) {
        return;
    }
    let word = "word_q <= quiet && read_enable === 1'b1";
    let through = "word_q <= quiet && writes_there ? data : quiet && read_enable === 1'b1";
    let wires = "    integer i;";
    let there =
        "    wire writes_there = &enables && write_address == read_address;\n    integer i;";
    let shapes = [
        (MemoryPorts::One, 8, 1 << 11, "RAMB18E2"),
        (MemoryPorts::One, 16, 1 << 11, "RAMB36E2"),
        (MemoryPorts::Two, 8, 1 << 11, "RAMB18E2"),
        (MemoryPorts::Two, 36, 1 << 9, "RAMB18E2"),
    ];
    let shapes = sample(shapes, 4);
    let memory = |&(ports, width, words, _): &_| memory_with_recording(ports, width, words);
    let memories: Vec<_> = shapes.iter().map(memory).collect();
    let netlists = synthesize_all(&memories.iter().map(|(rtl, _)| rtl).collect::<Vec<_>>());
    for ((ports, width, _, cell), ((_, recording), (netlist, cells))) in
        shapes.into_iter().zip(memories.iter().zip(&netlists))
    {
        assert!(cells.contains(cell), "{cells:?}");
        let shape = format!("{ports:?} {width} bits");
        let write_first = with_edit(&with_edit(netlist, 0, wires, there), 0, word, through);
        assert!(
            !run_in_icarus(&write_first, recording).unwrap().is_empty(),
            "{shape}: writes first"
        );
        // A byte without its enable bit is written, also while its content is unknown.
        let always = with_edit(netlist, 0, "enables !== {ENABLES{1'b0}}", "1'b1");
        assert_eq!(run_in_icarus(&always, recording).unwrap(), [], "{shape}");
        let always = with_edit(&always, 0, "enables[i] !== 1'b0", "1'b1");
        assert!(!run_in_icarus(&always, recording).unwrap().is_empty(), "{shape}: writes always");
        for (from, to) in [
            (") / DATA;", ") / (2 * DATA);"),
            ("? data[8*i+:8]", "? data[8*i+:8] & ~8'd4"),
            ("posedge CLKARDCLK", "negedge CLKARDCLK"),
        ] {
            let found = run_in_icarus(&with_edit(netlist, 0, from, to), recording).unwrap();
            assert!(!found.is_empty(), "{shape}: not found: {to}");
        }
        let writer = if width == 36 { "B" } else { "A" };
        let (mode, other) =
            (format!(".WRITE_MODE_{writer}("), format!(".WRITE_WIDTH_{writer}(32'd"));
        for (from, to, said) in [
            (".DOA_REG(32'sd0)", ".DOA_REG(32'sd1)", "output_registers"),
            (&format!("{mode}\"READ_FIRST\")"), &format!("{mode}\"NO_CHANGE\")"), "READ_FIRST"),
            (&other, &format!("{other}1"), "one_width"),
            (".DOA_REG(", ".IS_CLKARDCLK_INVERTED(1'b1), .DOA_REG(", "inverted"),
            (".DOA_REG(", ".EN_ECC_READ(\"TRUE\"), .DOA_REG(", "EN_ECC_READ"),
            (".INIT_00(256'hx", ".INIT_00(256'h0", "start_unknown"),
        ] {
            assert_refused(&with_edit(netlist, 1, from, to), recording, said);
        }
        if ports == MemoryPorts::One {
            let both = with_edit(netlist, 1, ".READ_WIDTH_B(32'd0)", ".READ_WIDTH_B(32'd9)");
            assert_refused(&both, recording, "one_port");
        } else {
            // A port that only reads must not write, and both ports have one clock.
            let (enable, none) = if width == 36 { (".WEA(2'h0)", 2) } else { (".WEBWE(", 4) };
            let text = &netlist.sources[1].1;
            let at = text.find(enable).unwrap();
            let end = at + text[at..].find(')').unwrap() + 1;
            let name = enable.split('(').next().unwrap();
            let written = format!("{name}({none}'h1)");
            let found = run_in_icarus(&with_edit(netlist, 1, &text[at..end], &written), recording);
            assert!(!found.unwrap().is_empty(), "{shape}: both ports write");
            for clock in [".CLKBWRCLK(~clk_i)", ".CLKBWRCLK(1'h0)"] {
                let clocks = with_edit(netlist, 1, ".CLKBWRCLK(clk_i)", clock);
                assert!(!run_in_icarus(&clocks, recording).unwrap().is_empty(), "{shape}: {clock}");
            }
        }
    }
}

/// A Yosys from before April 2026 gives the upper half of a word the parity bits of the lower half
/// (<https://github.com/YosysHQ/yosys/pull/5833>). The model shows it.
#[test]
fn a_word_of_64_bits_differs_exactly_if_yosys_miswires_it() {
    if !require_tools(TOOLS) {
        return;
    }
    let (rtl, recording) = memory_with_recording(MemoryPorts::Two, 64, 1 << 9);
    assert_eq!(run_in_icarus(&rtl, &recording).unwrap(), []);
    let (netlist, cells) = synthesize_all(&[&rtl]).remove(0);
    assert!(cells.contains("RAMB36E2"), "{cells:?}");
    let found = run_in_icarus(&netlist, &recording).unwrap();
    assert_eq!(!found.is_empty(), has_miswired_block_ram(&netlist.sources[1].1), "{found:?}");
}

/// Checks that the module does not compile, and that the message contains `said`.
fn assert_refused(dut: &DesignUnderTest, recording: &Recording, said: &str) {
    match run_in_icarus(dut, recording) {
        Err(CosimError::Tool(error)) => {
            assert!(error.to_string().contains(said), "{said}: {error}");
        }
        other => panic!("{said}: {other:?}"),
    }
}
