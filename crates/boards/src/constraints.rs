// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pins and clocks of a board, in the format of its tools.

use std::fmt::Write;

use foveate_emit::SourceFile;

use crate::board::Family;
use crate::project::{Project, file};

/// The name of the file with the pins.
pub(crate) fn name(family: Family) -> &'static str {
    match family {
        Family::Ice40 => "board.pcf",
        Family::Ecp5 => "board.lpf",
        Family::Gowin => "board.cst",
    }
}

/// The pins, and the clocks that come from outside where that file has them.
pub(crate) fn file_of(project: &Project) -> SourceFile {
    let family = project.board.device.family;
    let comment = if family == Family::Gowin { "//" } else { "#" };
    let mut text = format!("{comment} {}\n", project.banner());
    for (port, pin) in project.wires() {
        let pulled = port == "sensor_scl" || port == "sensor_sda";
        let pull = if pulled { "UP" } else { "NONE" };
        // Writing to a string cannot fail.
        let _ = match family {
            Family::Ice40 if pulled => writeln!(text, "set_io -pullup yes {port} {pin}"),
            Family::Ice40 => writeln!(text, "set_io {port} {pin}"),
            Family::Ecp5 => writeln!(
                text,
                "LOCATE COMP \"{port}\" SITE \"{pin}\";\nIOBUF PORT \"{port}\" IO_TYPE=LVCMOS33 PULLMODE={pull};"
            ),
            Family::Gowin => writeln!(
                text,
                "IO_LOC \"{port}\" {pin};\nIO_PORT \"{port}\" IO_TYPE=LVCMOS33 PULL_MODE={pull};"
            ),
        };
    }
    for (port, mhz) in
        [("clk_i", f64::from(project.board.clock.mhz)), ("sensor_pclk_i", project.pclk_mhz())]
    {
        let _ = match family {
            Family::Ice40 => writeln!(text, "set_frequency {port} {mhz}"),
            Family::Ecp5 => writeln!(text, "FREQUENCY PORT \"{port}\" {mhz} MHZ;"),
            Family::Gowin => Ok(()),
        };
    }
    file(name(family), text)
}
