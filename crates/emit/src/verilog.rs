// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Verilog of a design, in compile order.

use crate::organization::Emitter;
use crate::{SourceFile, leaf};
use askama::Template;
use foveate_design::{Design, Direction, Port};

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
#[must_use]
pub fn verilog(design: &Design, top: Top) -> Vec<SourceFile> {
    let leaves = leaf::of(design).map(|leaf| file(leaf.name, leaf.contents.to_owned()));
    leaves.chain((Emitter::of(design).modules)(design, top)).collect()
}

/// The file of a module.
pub(crate) fn file(module: &str, contents: String) -> SourceFile {
    SourceFile { path: format!("rtl/{module}.v"), contents }
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
    (Emitter::of(design).range)(port, design).unwrap_or_else(|| match port.width {
        1 => String::new(),
        width => format!("[{}:0]", width - 1),
    })
}
