// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog around a core: leaves of `rtl/board/`, and the top that connects them.

use askama::Template;
use foveate_design::index_bits;
use foveate_emit::SourceFile;

use crate::clock::Source;
use crate::project::{Project, file};
use crate::sensor::{Level, Sensor};
use crate::text::text_of;

/// Bits of I2C in a second, and parts of a bit.
const I2C_HZ: u32 = 100_000;
const QUARTERS: u32 = 4;

macro_rules! leaves {
    ($($name:literal),+) => {
        /// What stands between a sensor, a core and a serial line, each after what it instantiates.
        const LEAVES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../../rtl/board/", $name, ".v")))),+];
    };
}

leaves!(
    "clock_crossing",
    "dvp_capture",
    "i2c_setup",
    "packet_bytes",
    "uart_sender",
    "uart_receiver",
    "uart_registers"
);

#[derive(Template)]
#[template(path = "board.v")]
struct Top<'a> {
    banner: String,
    title: &'a str,
    mhz: u32,
    core_mhz: u32,
    capture: Capture,
    leds: usize,
    lit_low: bool,
    width: u32,
    height: u32,
    divisor: u32,
}

/// Parameters of what stands between a sensor and a core.
struct Capture {
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
struct Steps<'a> {
    banner: String,
    title: &'a str,
    step_bits: u32,
    word_bits: u32,
    words: Vec<String>,
}

#[derive(Template)]
#[template(path = "board_clock.v")]
struct Clock {
    banner: String,
    mhz: u32,
    core_mhz: u32,
    how: &'static str,
    body: String,
}

/// The modules around the core, each after those that it instantiates.
pub(crate) fn around(project: &Project) -> Vec<SourceFile> {
    let path = |name: &str| format!("rtl/{name}.v");
    let leaves = LEAVES.iter().map(|&(name, text)| file(&path(name), text.to_owned()));
    let own = [
        ("sensor_steps", steps(project)),
        ("board_clock", clock(project, false)),
        ("board", top(project)),
    ];
    leaves.chain(own.map(|(name, text)| file(&path(name), text))).collect()
}

fn top(project: &Project) -> String {
    let Project { board, design, sensor, .. } = project;
    text_of(&Top {
        banner: project.banner(),
        title: &board.title,
        mhz: board.clock.mhz,
        core_mhz: board.clock.core_mhz,
        capture: capture(project, sensor),
        leds: board.leds.pins.len(),
        lit_low: board.leds.lit == Level::Low,
        width: design.width(),
        height: design.height(),
        divisor: board.divisor(),
    })
}

fn capture(project: &Project, sensor: &Sensor) -> Capture {
    let (design, clocks) = (&project.design, project.board.clock.core_mhz * 1_000_000);
    let (steps, bits) = (sensor.words().len(), sensor.word_bits());
    Capture {
        lines: sensor.format.lines(),
        reset: project.board.pins.reset_n.is_some(),
        power_down: project.board.pins.power_down.is_some(),
        device: format!("{:02X}", sensor.i2c.device),
        address_bytes: sensor.i2c.address_bytes,
        steps,
        step_bits: index_bits(steps as u64),
        word_bits: bits,
        quarter: clocks.div_ceil(QUARTERS * I2C_HZ),
        pause: clocks / 1000,
        format: sensor.format.number(),
        vsync_high: u32::from(sensor.vsync == Level::High),
        left: sensor.left,
        top: sensor.top,
        column_bits: index_bits(u64::from(sensor.left + design.width())),
        line_bits: index_bits(u64::from(sensor.top + design.height())),
    }
}

fn steps(project: &Project) -> String {
    let words = project.sensor.words();
    let bits = project.sensor.word_bits();
    let digits = bits.div_ceil(4) as usize;
    text_of(&Steps {
        banner: project.banner(),
        title: &project.sensor.title,
        step_bits: index_bits(words.len() as u64),
        word_bits: bits,
        words: words.iter().map(|word| format!("{word:0digits$X}")).collect(),
    })
}

/// The clock of the core; for a simulation that of the board takes its place.
pub(crate) fn clock(project: &Project, simulated: bool) -> String {
    let (how, body) = match project.clock {
        _ if simulated => (", in a simulation: the clock that comes is taken for it", direct()),
        Source::Direct => ("", direct()),
        Source::Ice40 { pad, reference, feedback, output, filter } => {
            // A PLL at its own pin takes it whole, and hands its clock on.
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
        Source::Ecp5 { reference, feedback, output } => {
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
    text_of(&Clock {
        banner: project.banner(),
        mhz: project.board.clock.mhz,
        core_mhz: project.board.clock.core_mhz,
        how,
        body,
    })
}

fn direct() -> String {
    "    assign clk_o = clk_i;\n    assign raw_o = clk_i;\n    assign locked_o = 1'b1;".to_owned()
}
