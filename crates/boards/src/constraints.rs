// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pins and clocks of a board, in the format of its tools.

use foveate_emit::SourceFile;
use foveate_tools::escaping::tcl_word;

use super::text_forms::source_file;
use crate::board::DeviceFamily;
use crate::project::{BoardProject, PortPin};

/// The I/O standard of pins for which a board names none.
const DEFAULT_STANDARD: &str = "LVCMOS33";

pub(crate) fn pin_file_name(family: DeviceFamily) -> &'static str {
    match family {
        DeviceFamily::Ice40 => "board.pcf",
        DeviceFamily::Ecp5 => "board.lpf",
        DeviceFamily::Gowin => "board.cst",
        DeviceFamily::Vivado => "board.xdc",
    }
}

/// Returns the file with the pins and, if its format has them, the clocks that come from outside.
pub(crate) fn pin_file(project: &BoardProject) -> SourceFile {
    let family = project.board.device.family;
    let comment = if family == DeviceFamily::Gowin { "//" } else { "#" };
    let mut text = format!("{comment} {}\n", project.banner());
    text.extend(project.port_pins().iter().map(|wire| pin_lines(family, wire)));
    let board = (project.clock_port(), f64::from(project.board.clock.mhz));
    let sensor = project.sensor.is_some().then(|| ("sensor_pclk_i", project.pclk_mhz()));
    let clocks = [Some(board), sensor].into_iter().flatten();
    text.extend(clocks.map(|(port, mhz)| clock_line(family, port, mhz)));
    if family == DeviceFamily::Vivado {
        text += "# LEDs and the serial line are asynchronous: no clock outside of the device \
                 belongs to them.\nset_false_path -to [get_ports {tx_o led_o[*]}]\nset_false_path \
                 -from [get_ports rx_i]\n";
    }
    source_file(pin_file_name(family), text)
}

fn pin_lines(family: DeviceFamily, PortPin { port, pin, standard }: &PortPin) -> String {
    let standard = standard.as_deref().unwrap_or(DEFAULT_STANDARD);
    let is_pulled = port == "sensor_scl" || port == "sensor_sda";
    let pull = if is_pulled { "UP" } else { "NONE" };
    match family {
        DeviceFamily::Ice40 if is_pulled => format!("set_io -pullup yes {port} {pin}\n"),
        DeviceFamily::Ice40 => format!("set_io {port} {pin}\n"),
        DeviceFamily::Ecp5 => format!(
            "LOCATE COMP \"{port}\" SITE \"{pin}\";\n\
             IOBUF PORT \"{port}\" IO_TYPE={standard} PULLMODE={pull};\n"
        ),
        DeviceFamily::Gowin => format!(
            "IO_LOC \"{port}\" {pin};\nIO_PORT \"{port}\" IO_TYPE={standard} PULL_MODE={pull};\n"
        ),
        DeviceFamily::Vivado => format!(
            "set_property -dict {{PACKAGE_PIN {} IOSTANDARD {}}} [get_ports {{{port}}}]\n",
            tcl_word(pin),
            tcl_word(standard)
        ),
    }
}

fn clock_line(family: DeviceFamily, port: &str, mhz: f64) -> String {
    match family {
        DeviceFamily::Ice40 => format!("set_frequency {port} {mhz}\n"),
        DeviceFamily::Ecp5 => format!("FREQUENCY PORT \"{port}\" {mhz} MHZ;\n"),
        // nextpnr takes one frequency for all clocks, as an option.
        DeviceFamily::Gowin => String::new(),
        DeviceFamily::Vivado => {
            let period = 1000.0 / mhz;
            format!("create_clock -name {port} -period {period:.3} [get_ports {port}]\n")
        }
    }
}
