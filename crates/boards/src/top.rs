// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog around a core: the leaves of `rtl/board/`, and the top that connects them.

use std::borrow::Cow;

use askama::Template;
use foveate_camera::index_bits;
use foveate_design::{Hardware, PipelinedDesign, RasterDesign};
use foveate_emit::{
    BOARD_LEAVES, LEAVES, Leaf, SourceFile, Top as CoreTop, array_registers, axi_modules, verilog,
};
use foveate_tools::escaping::comment_text;

use super::text_forms::{rendered, source_file};
use crate::array;
use crate::board::SensorPins;
use crate::clock::ClockSource;
use crate::pattern::{COMPARED_FRAMES, packet_layout, packet_sums};
use crate::project::BoardProject;
use crate::sensor::{LogicLevel, Sensor};

/// The rate of I2C in bits per second.
const I2C_HZ: u32 = 100_000;
const QUARTERS_PER_BIT: u32 = 4;

/// The leaves between a sensor and the core.
const SENSOR_LEAVES: &[&str] = &["clock_crossing", "dvp_capture", "i2c_setup"];
const PATTERN_LEAVES: &[&str] = &["pattern_source", "packet_signature", "packet_sample"];
const OUTPUT_LEAVES: &[&str] = &["packet_bytes", "uart_sender", "uart_receiver", "uart_registers"];
/// The leaf of a core that an array needs, too.
const ARRAY_CORE_LEAF: &str = "packet_crc";
const ARRAY_LEAVES: &[&str] = &[
    "array_pattern",
    "array_turn",
    "array_signature",
    "array_snapshot",
    "uart_sender",
    "uart_receiver",
    "uart_registers",
];

#[derive(Template)]
#[template(path = "board.v")]
struct SensorTopTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    mhz: u32,
    core_mhz: u32,
    capture: CaptureParameters,
    leds: usize,
    lit_low: bool,
    width: u32,
    height: u32,
    divisor: u32,
}

/// The parameters of the modules between a sensor and a core.
struct CaptureParameters {
    lines: usize,
    reset: bool,
    power_down: bool,
    device: String,
    address_bytes: u32,
    steps: usize,
    step_bits: u32,
    word_bits: u32,
    quarter: u32,
    pause: u32,
    format: u32,
    vsync_high: u32,
    left: u32,
    top: u32,
    column_bits: u32,
    line_bits: u32,
}

#[derive(Template)]
#[template(path = "sensor_steps.v")]
struct SetupStepsTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    step_bits: u32,
    word_bits: u32,
    words: Vec<String>,
}

#[derive(Template)]
#[template(path = "pattern_board.v")]
struct PatternTopTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    pair: bool,
    mhz: u32,
    core_mhz: u32,
    leds: usize,
    lit_low: bool,
    lanes: u32,
    video_bits: u32,
    words: u32,
    word_bits: u32,
    height: u32,
    line_bits: u32,
    packet_words: usize,
    packet_bits: u32,
    divisor: u32,
}

#[derive(Template)]
#[template(path = "expected_sums.v")]
struct ExpectedSumsTemplate {
    banner: String,
    sums: Vec<String>,
}

#[derive(Template)]
#[template(path = "board_clock.v")]
struct ClockTemplate {
    banner: String,
    pair: bool,
    mhz: u32,
    core_mhz: u32,
    description: &'static str,
    body: String,
}

/// Returns the Verilog of a project, each module after those that it instantiates.
pub(crate) fn modules(project: &BoardProject) -> Vec<SourceFile> {
    let design = &project.design;
    let (core, leaves, own_modules) = match (design.hardware(), &project.sensor) {
        (Hardware::Pipelined(hardware), _) => {
            let array = design.with_hardware(hardware);
            let own_modules = [
                ("expected_sums", expected_sums(project)),
                ("board", array::array_top(project, array)),
            ];
            (array_core(array), [ARRAY_LEAVES, &[]], own_modules)
        }
        (Hardware::Raster(_) | Hardware::Serial(_), Some((sensor, pins))) => {
            let own_modules = [
                ("sensor_steps", setup_steps(project, sensor)),
                ("board", sensor_top(project, sensor, pins)),
            ];
            (axi_modules(design).unwrap_or_default(), [SENSOR_LEAVES, OUTPUT_LEAVES], own_modules)
        }
        (Hardware::Raster(hardware), None) => {
            let top = pattern_top(project, design.with_hardware(hardware));
            let own_modules = [("expected_sums", expected_sums(project)), ("board", top)];
            (axi_modules(design).unwrap_or_default(), [PATTERN_LEAVES, OUTPUT_LEAVES], own_modules)
        }
        // [`BoardProject::new`] has refused such a design.
        (Hardware::Serial(_), None) => return Vec::new(),
    };
    let is_used = |leaf: &&Leaf| leaves.iter().any(|names| names.contains(&leaf.name));
    let leaves = BOARD_LEAVES.iter().filter(is_used).map(leaf_file);
    let clock = source_file(&rtl_path("board_clock"), clock_module(project, false));
    let own_modules = own_modules.map(|(name, text)| source_file(&rtl_path(name), text));
    core.into_iter().chain(leaves).chain([clock]).chain(own_modules).collect()
}

fn rtl_path(name: &str) -> String {
    format!("rtl/{name}.v")
}

fn leaf_file(leaf: &Leaf) -> SourceFile {
    source_file(&rtl_path(leaf.name), leaf.contents.to_owned())
}

/// Returns an array with its registers, and the leaf of other cores that it needs.
fn array_core(array: PipelinedDesign<'_>) -> Vec<SourceFile> {
    let crc_leaf = LEAVES.iter().filter(|leaf| leaf.name == ARRAY_CORE_LEAF).map(leaf_file);
    verilog(&array, CoreTop::Rcm)
        .into_iter()
        .chain(crc_leaf)
        .chain([array_registers(array)])
        .collect()
}

fn sensor_top(project: &BoardProject, sensor: &Sensor, pins: &SensorPins) -> String {
    let BoardProject { board, design, .. } = project;
    rendered(&SensorTopTemplate {
        banner: project.banner(),
        title: comment_text(&board.title),
        mhz: board.clock.mhz,
        core_mhz: board.clock.core_mhz,
        capture: capture_parameters(project, sensor, pins),
        leds: board.leds.pins.len(),
        lit_low: board.leds.lit_level == LogicLevel::Low,
        width: design.width(),
        height: design.height(),
        divisor: board.baud_divisor(),
    })
}

fn capture_parameters(
    project: &BoardProject,
    sensor: &Sensor,
    pins: &SensorPins,
) -> CaptureParameters {
    let (design, clocks) = (&project.design, project.board.clock.core_mhz * 1_000_000);
    let steps = sensor.setup_words().len();
    CaptureParameters {
        lines: sensor.format.data_lines(),
        reset: pins.reset_n.is_some(),
        power_down: pins.power_down.is_some(),
        device: format!("{:02X}", sensor.i2c.device),
        address_bytes: sensor.i2c.address_bytes,
        steps,
        step_bits: index_bits(steps as u64),
        word_bits: sensor.setup_word_bits(),
        quarter: clocks.div_ceil(QUARTERS_PER_BIT * I2C_HZ),
        pause: clocks / 1000,
        format: sensor.format.parameter_value(),
        vsync_high: u32::from(sensor.vsync == LogicLevel::High),
        left: sensor.left,
        top: sensor.top,
        column_bits: index_bits(u64::from(sensor.left + design.width())),
        line_bits: index_bits(u64::from(sensor.top + design.height())),
    }
}

fn setup_steps(project: &BoardProject, sensor: &Sensor) -> String {
    let (words, bits) = (sensor.setup_words(), sensor.setup_word_bits());
    let digits = bits.div_ceil(4) as usize;
    rendered(&SetupStepsTemplate {
        banner: project.banner(),
        title: comment_text(&sensor.title),
        step_bits: index_bits(words.len() as u64),
        word_bits: bits,
        words: words.iter().map(|word| format!("{word:0digits$X}")).collect(),
    })
}

fn pattern_top(project: &BoardProject, design: RasterDesign<'_>) -> String {
    let board = &project.board;
    let lanes = design.pixels_per_clock();
    let words = design.width().div_ceil(lanes);
    let layout = packet_layout(&design);
    let lengths = [layout.frame_bytes(), layout.row_bytes(), layout.region_bytes(false)];
    let packet_words = lengths.into_iter().max().unwrap_or_default() / 8;
    rendered(&PatternTopTemplate {
        banner: project.banner(),
        title: comment_text(&board.title),
        pair: project.has_pair(),
        mhz: board.clock.mhz,
        core_mhz: board.clock.core_mhz,
        leds: board.leds.pins.len(),
        lit_low: board.leds.lit_level == LogicLevel::Low,
        lanes,
        video_bits: 8 * lanes,
        words,
        word_bits: index_bits(words.into()),
        height: design.height(),
        line_bits: index_bits(design.height().into()),
        packet_words,
        packet_bits: index_bits(packet_words as u64),
        divisor: board.baud_divisor(),
    })
}

fn expected_sums(project: &BoardProject) -> String {
    let design = &project.design;
    let sums = match design.hardware() {
        Hardware::Pipelined(hardware) => {
            array::signature_sums(design.with_hardware(hardware), COMPARED_FRAMES)
        }
        Hardware::Serial(_) | Hardware::Raster(_) => packet_sums(design, COMPARED_FRAMES),
    };
    rendered(&ExpectedSumsTemplate {
        banner: project.banner(),
        sums: sums.iter().map(|sum| format!("{sum:08X}")).collect(),
    })
}

/// Returns the module that makes the core's clock. In a simulation the clock of the board replaces
/// it.
pub(crate) fn clock_module(project: &BoardProject, simulated: bool) -> String {
    let (pair, port) = (project.has_pair(), project.clock_port());
    let (description, body) = match project.clock {
        _ if simulated => {
            (", in a simulation: the incoming clock is used in its place", direct_clock(port))
        }
        ClockSource::Direct if pair => {
            (", by the buffers of a Xilinx device", differential_clock())
        }
        ClockSource::Direct => ("", direct_clock(port)),
        ClockSource::Ice40 { pad, reference, feedback, output, filter } => {
            // A PLL at its own pin takes the pin's clock exclusively, and outputs it as well.
            let (cell, ports, raw) = if pad {
                ("2_PAD", ".PACKAGEPIN(clk_i), .PLLOUTGLOBALA(raw_o), .PLLOUTGLOBALB(clk_o)", "")
            } else {
                let raw = "\n    assign raw_o = clk_i;";
                ("CORE", ".REFERENCECLK(clk_i), .PLLOUTGLOBAL(clk_o)", raw)
            };
            let body = format!(
                "    SB_PLL40_{cell} #(\n        .FEEDBACK_PATH(\"SIMPLE\"), .DIVR(4'd{reference}), .DIVF(7'd{feedback}), \
                 .DIVQ(3'd{output}), .FILTER_RANGE(3'd{filter})\n    ) u_pll (\n        {ports}, \
                 .LOCK(locked_o), .RESETB(1'b1), .BYPASS(1'b0)\n    );{raw}"
            );
            (", by the PLL of an iCE40", body)
        }
        ClockSource::Ecp5 { reference, feedback, output } => {
            let phase = output / 2 - 1;
            let body = format!(
                "    wire looped;\n    (* FREQUENCY_PIN_CLKI = \"{}\", FREQUENCY_PIN_CLKOP = \"{}\" *)\n    EHXPLLL #(\n        \
                 .PLLRST_ENA(\"DISABLED\"), .INTFB_WAKE(\"DISABLED\"), .STDBY_ENABLE(\"DISABLED\"), .DPHASE_SOURCE(\"DISABLED\"),\n        \
                 .OUTDIVIDER_MUXA(\"DIVA\"), .CLKI_DIV({reference}), .CLKFB_DIV({feedback}), .CLKOP_ENABLE(\"ENABLED\"), \
                 .CLKOP_DIV({output}),\n        .CLKOP_CPHASE({phase}), .CLKOP_FPHASE(0), .FEEDBK_PATH(\"CLKOP\")\n    ) u_pll (\n        \
                 .RST(1'b0), .STDBY(1'b0), .CLKI(clk_i), .CLKOP(looped), .CLKFB(looped), .CLKINTFB(), .PHASESEL0(1'b0),\n        \
                 .PHASESEL1(1'b0), .PHASEDIR(1'b0), .PHASESTEP(1'b0), .PHASELOADREG(1'b0), .PLLWAKESYNC(1'b0), .ENCLKOP(1'b0),\n        \
                 .LOCK(locked_o)\n    );\n    assign clk_o = looped;\n    assign raw_o = clk_i;",
                project.board.clock.mhz, project.board.clock.core_mhz
            );
            (", by the PLL of an ECP5", body)
        }
    };
    rendered(&ClockTemplate {
        banner: project.banner(),
        pair,
        mhz: project.board.clock.mhz,
        core_mhz: project.board.clock.core_mhz,
        description,
        body,
    })
}

fn direct_clock(clock: &str) -> String {
    let other = if clock == "clk_i" { "" } else { "    wire unused_half = clk_n_i;\n" };
    format!(
        "{other}    assign clk_o = {clock};\n    assign raw_o = {clock};\n    assign locked_o = 1'b1;"
    )
}

fn differential_clock() -> String {
    "    wire joined;\n    IBUFDS u_pair (.I(clk_p_i), .IB(clk_n_i), .O(joined));\n    \
     BUFG u_buffer (.I(joined), .O(clk_o));\n    assign raw_o = joined;\n    assign locked_o = 1'b1;"
        .to_owned()
}
