// SPDX-License-Identifier: MIT OR Apache-2.0
//! A port of a core, in the form that the module around the core needs.

use foveate_design::{Port, PortDirection};

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
