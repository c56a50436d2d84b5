// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds the ports of a core on AXI, for the module in which the core is placed. Only the filled
//! template `axi.v` declares them, so they are read from its header.

use crate::top::AXI_CLOCK;
use crate::wrapped_port::WrappedPort;

/// Returns the ports in the header of a filled `axi.v`, without its clock.
pub(super) fn header_ports(verilog: &str) -> Vec<WrappedPort> {
    let header = verilog.lines().take_while(|line| *line != ");");
    header.filter_map(declared_port).filter(|port| port.name != AXI_CLOCK).collect()
}

/// Parses the port that a line such as `input wire [11:0] s_axi_awaddr, // what it is` declares.
fn declared_port(line: &str) -> Option<WrappedPort> {
    let (direction, rest) = line.trim_start().split_once(" wire ")?;
    let input = match direction.trim_end() {
        "input" => true,
        "output" => false,
        _ => return None,
    };
    let (highest, name) = match rest.trim_start().strip_prefix('[') {
        Some(ranged) => ranged.split_once(":0]")?,
        None => ("0", rest),
    };
    let name = name.trim_start().split([',', ' ']).next()?;
    Some(WrappedPort::new(name, highest.trim_start().parse::<u32>().ok()? + 1, input))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_are_read_off_a_header() {
        let verilog = "// input  wire no_port\nmodule rcm_axi #(\n    parameter [31:0] TICK_RATE = 32'd1  // no port\n) (\n    \
             (* X_INTERFACE_INFO = \"x CLK\" *)\n    input  wire        aclk,       // clock\n    \
             output wire [ 7:0] tkeep_o,    // 8 bits\n    input  wire [31:0] data_i, // 32 bits\n    \
             output wire        interrupt_o // the last\n);\n    input wire [3:0] beyond,\n";
        let found = header_ports(verilog);
        let text = |port: &WrappedPort| format!("{} {} {}", port.name, port.bits, port.input);
        let expected = ["tkeep_o 8 false", "data_i 32 true", "interrupt_o 1 false"];
        assert_eq!(found.iter().map(text).collect::<Vec<_>>(), expected);
    }
}
