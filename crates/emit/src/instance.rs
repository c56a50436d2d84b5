// SPDX-License-Identifier: MIT OR Apache-2.0
//! An instance of `rcm` for a user's own Verilog: every port with its width, and thresholds with
//! their values.

use crate::thresholds::threshold_value;
use crate::{Prefix, Top};
use foveate_design::{Design, Port, PortDirection, PortRole};

/// Returns declarations and an instance of `rcm`, as lines of Verilog-2005. The signals have the
/// names of the ports without `_i` and `_o`; threshold inputs are the constants of the
/// configuration.
pub(crate) fn instance(design: &Design, prefix: &Prefix) -> Vec<String> {
    let ports = design.rcm_ports();
    let signals: Vec<&Port> =
        ports.iter().filter(|port| threshold_value(design, port).is_none()).collect();
    let widest = signals.iter().map(|port| range(port).len()).max().unwrap_or(0);
    let declare = |port: &&Port| {
        let driven = match (port.direction, port.role) {
            (PortDirection::Input, PortRole::Clock) => "  // yours",
            (PortDirection::Input, _) => {
                "  // your signal, which changes after the clock's rising edge"
            }
            (PortDirection::Output, _) => "",
        };
        format!("wire {:widest$} {};{driven}", range(port), signal(port))
    };
    let mut lines: Vec<String> = signals.iter().map(declare).collect();
    lines.push(String::new());
    lines.push(format!("{} u_{0} (", prefix.prefixed_name(Top::Rcm.module())));
    let last = ports.len() - 1;
    for (number, port) in ports.iter().enumerate() {
        let value = threshold_value(design, port)
            .map_or_else(|| signal(port).to_owned(), |value| format!("{}'d{value}", port.width));
        let comma = if number == last { "" } else { "," };
        lines.push(format!("    .{}({value}){comma}", port.name));
    }
    lines.push(");".to_owned());
    lines
}

fn signal(port: &Port) -> &str {
    port.name.trim_end_matches("_i").trim_end_matches("_o")
}

fn range(port: &Port) -> String {
    match port.bits() {
        1 => String::new(),
        bits => format!("[{}:0]", bits - 1),
    }
}
