// SPDX-License-Identifier: MIT OR Apache-2.0
//! The text of generated Verilog, as all templates share it: files ([`module_file`]), filled
//! templates ([`rendered_text`]), and ports in each form in which a module names them: in its
//! own header ([`PortLine`]), in a user's instance of `rcm` ([`instance`]), and in a module
//! around it ([`WrappedPort`]).

use super::camera_flags::threshold_value;
use crate::prefix::module_path;
use crate::{Prefix, SourceFile, Top};
use askama::Template;
use foveate_design::{Design, Port, PortDirection, PortRole};

pub(crate) fn module_file(module: &str, contents: String) -> SourceFile {
    SourceFile { path: module_path(module), contents }
}

/// Returns the text of a filled template, with the final newline that askama drops.
pub(crate) fn rendered_text(view: &impl Template) -> String {
    let text = view.render();
    text.map_or_else(|e| unreachable!("a template only fails when writing does: {e}"), |t| t + "\n")
}

/// A port as a line of a module header.
pub(crate) struct PortLine {
    pub(crate) declaration: String,
    pub(crate) doc: String,
}

impl PortLine {
    /// Returns the lines for `ports`, aligned; every line but the last ends in a comma. `range`
    /// returns the range of a port whose width depends on the grid, and `None` for other ports.
    pub(crate) fn aligned(ports: &[Port], range: impl Fn(&Port) -> Option<String>) -> Vec<Self> {
        let widest = |texts: &[String]| texts.iter().map(String::len).max().unwrap_or(0);
        let ranges: Vec<_> =
            ports.iter().map(|port| range(port).unwrap_or_else(|| fixed_range(port))).collect();
        let mut names: Vec<_> = ports.iter().map(|port| format!("{},", port.name)).collect();
        if let Some(last) = names.last_mut() {
            last.pop();
        }
        let (range_width, name_width) = (widest(&ranges), widest(&names));
        let line = |((port, range), name): ((&Port, &String), &String)| Self {
            declaration: format!(
                "{} wire {range:range_width$} {name:name_width$}",
                direction(port)
            ),
            doc: port.doc.clone(),
        };
        ports.iter().zip(&ranges).zip(&names).map(line).collect()
    }
}

fn direction(port: &Port) -> &'static str {
    match port.direction {
        PortDirection::Input => "input ",
        PortDirection::Output => "output",
    }
}

/// Returns the range of a port, such as `[7:0]`; empty for a single bit.
fn fixed_range(port: &Port) -> String {
    match port.width {
        1 => String::new(),
        width => format!("[{}:0]", width - 1),
    }
}

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

/// A port other than the clock.
pub(crate) struct WrappedPort {
    pub(crate) name: String,
    pub(crate) bits: u32,
    /// The range of the port and a space; empty for one bit.
    pub(crate) range: String,
    pub(crate) input: bool,
}

impl WrappedPort {
    pub(crate) fn of(port: &Port) -> Self {
        let input = match port.direction {
            PortDirection::Input => true,
            PortDirection::Output => false,
        };
        Self::new(&port.name, port.bits(), input)
    }

    pub(crate) fn new(name: &str, bits: u32, input: bool) -> Self {
        let range = if bits == 1 { String::new() } else { format!("[{}:0] ", bits - 1) };
        Self { name: name.to_owned(), bits, range, input }
    }
}
