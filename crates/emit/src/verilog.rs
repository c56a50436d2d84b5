// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog of a design, in compile order.

use crate::{SourceFile, leaf, rcm, rpu, serial};
use askama::Template;
use foveate_design::{Design, Direction, Organization, Port};

/// A parameter of a module and its value.
pub type Parameter = (&'static str, u32);

/// Which module is on top.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Top {
    /// One regional processing unit, module `rpu`.
    Rpu,
    /// The whole array, module `rcm`.
    Rcm,
}

impl Top {
    /// Name of the module.
    #[must_use]
    pub fn module(self) -> &'static str {
        match self {
            Self::Rpu => "rpu",
            Self::Rcm => "rcm",
        }
    }

    /// Its parameters with the values of the design, which are their defaults in its Verilog. The
    /// widths of the array's ports follow from them.
    #[must_use]
    pub fn parameters(self, design: &Design) -> Vec<Parameter> {
        match self {
            Self::Rpu => Vec::new(),
            Self::Rcm => vec![("COLUMNS", design.columns()), ("ROWS", design.rows())],
        }
    }

    /// Its ports.
    #[must_use]
    pub fn ports(self, design: &Design) -> Vec<Port> {
        match self {
            Self::Rpu => design.rpu_ports(),
            Self::Rcm => design.rcm_ports(),
        }
    }
}

/// The modules that `top` is made of, each after those it instantiates.
/// A pipelined array is made of RPUs; a serial one is a module beside that of its lone lane.
#[must_use]
pub fn verilog(design: &Design, top: Top) -> Vec<SourceFile> {
    let file =
        |name: &str, contents: String| SourceFile { path: format!("rtl/{name}.v"), contents };
    let mut files: Vec<_> =
        leaf::of(design).map(|leaf| file(leaf.name, leaf.contents.to_owned())).collect();
    match (design.organization(), top) {
        (Organization::Pipelined, Top::Rpu) => files.push(file("rpu", rpu::render(design))),
        (Organization::Pipelined, Top::Rcm) => {
            files.push(file("rpu", rpu::render(design)));
            files.push(file("rcm", rcm::render(design)));
        }
        (Organization::Serial, _) => files.push(file(top.module(), serial::render(design, top))),
    }
    files
}

/// A filled template, ending in the newline that askama drops.
pub(crate) fn text_of(view: &impl Template) -> String {
    let text = view.render();
    text.map_or_else(|e| unreachable!("a template only fails when writing does: {e}"), |t| t + "\n")
}

/// A port as a line of a module header.
pub(crate) struct PortLine {
    pub(crate) declaration: String,
    pub(crate) doc: String,
}

impl PortLine {
    /// The lines for `ports`, aligned; every one but the last ends in a comma.
    pub(crate) fn all(ports: &[Port], design: &Design) -> Vec<Self> {
        let widest = |texts: &[String]| texts.iter().map(String::len).max().unwrap_or(0);
        let ranges: Vec<_> = ports.iter().map(|port| range(port, design)).collect();
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
        Direction::Input => "input ",
        Direction::Output => "output",
    }
}

/// `[7:0]`, nothing for a single bit; in the array with its parameters.
fn range(port: &Port, design: &Design) -> String {
    let by_grid = match design.organization() {
        Organization::Serial => serial::range(port, design),
        Organization::Pipelined => match (port.per_lane, port.width) {
            (true, 1) => Some("[COLUMNS*ROWS-1:0]".to_owned()),
            (true, width) => Some(format!("[COLUMNS*ROWS*{width}-1:0]")),
            (false, _) => None,
        },
    };
    by_grid.unwrap_or_else(|| match port.width {
        1 => String::new(),
        width => format!("[{}:0]", width - 1),
    })
}
