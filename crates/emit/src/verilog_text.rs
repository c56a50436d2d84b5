// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parts of all generated Verilog: files, filled templates, and the ports of a header.

use crate::SourceFile;
use crate::prefix::module_path;
use askama::Template;
use foveate_design::{Port, PortDirection};

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
