// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pins and clocks of a board, in the format of its tools.

use foveate_emit::SourceFile;
use foveate_toolchain::text::tcl_word;

use crate::board::Family;
use crate::project::{Project, Wire};
use crate::text::file;

/// The I/O standard of pins for which a board names none.
const USUAL: &str = "LVCMOS33";

/// Returns the name of the file with the pins.
pub(crate) fn name(family: Family) -> &'static str {
    match family {
        Family::Ice40 => "board.pcf",
        Family::Ecp5 => "board.lpf",
        Family::Gowin => "board.cst",
        Family::Vivado => "board.xdc",
    }
}

/// Returns the file with the pins and, if its format has them, the clocks that come from outside.
pub(crate) fn file_of(project: &Project) -> SourceFile {
    let family = project.board.device.family;
    let comment = if family == Family::Gowin { "//" } else { "#" };
    let mut text = format!("{comment} {}\n", project.banner());
    text.extend(project.wires().iter().map(|wire| pin(family, wire)));
    let board = (project.clock_port(), f64::from(project.board.clock.mhz));
    let sensor = project.eye.is_some().then(|| ("sensor_pclk_i", project.pclk_mhz()));
    let clocks = [Some(board), sensor].into_iter().flatten();
    text.extend(clocks.map(|(port, mhz)| clock(family, port, mhz)));
    if family == Family::Vivado {
        text += "# Lights and the serial line have no clock outside.\n\
                 set_false_path -to [get_ports {tx_o led_o[*]}]\n\
                 set_false_path -from [get_ports rx_i]\n";
    }
    file(name(family), text)
}

fn pin(family: Family, Wire { port, pin, standard }: &Wire) -> String {
    let standard = standard.as_deref().unwrap_or(USUAL);
    let is_pulled = port == "sensor_scl" || port == "sensor_sda";
    let pull = if is_pulled { "UP" } else { "NONE" };
    match family {
        Family::Ice40 if is_pulled => format!("set_io -pullup yes {port} {pin}\n"),
        Family::Ice40 => format!("set_io {port} {pin}\n"),
        Family::Ecp5 => format!(
            "LOCATE COMP \"{port}\" SITE \"{pin}\";\n\
             IOBUF PORT \"{port}\" IO_TYPE={standard} PULLMODE={pull};\n"
        ),
        Family::Gowin => format!(
            "IO_LOC \"{port}\" {pin};\nIO_PORT \"{port}\" IO_TYPE={standard} PULL_MODE={pull};\n"
        ),
        Family::Vivado => format!(
            "set_property -dict {{PACKAGE_PIN {} IOSTANDARD {}}} [get_ports {{{port}}}]\n",
            tcl_word(pin),
            tcl_word(standard)
        ),
    }
}

fn clock(family: Family, port: &str, mhz: f64) -> String {
    match family {
        Family::Ice40 => format!("set_frequency {port} {mhz}\n"),
        Family::Ecp5 => format!("FREQUENCY PORT \"{port}\" {mhz} MHZ;\n"),
        // nextpnr takes one frequency for all clocks, as an option.
        Family::Gowin => String::new(),
        Family::Vivado => {
            let period = 1000.0 / mhz;
            format!("create_clock -name {port} -period {period:.3} [get_ports {port}]\n")
        }
    }
}
