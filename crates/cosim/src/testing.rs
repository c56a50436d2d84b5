// SPDX-License-Identifier: MIT OR Apache-2.0
//! A small hand-made module, to test the machinery without model and RTL.

use foveate_design::{OutputQualifier, Port, PortDirection, PortRole};

/// Returns a port of any name and shape. It has the role of the clock for `clk_i`, and otherwise a
/// role without meaning.
pub(crate) fn port(name: &str, direction: PortDirection, width: u32, lanes: u32) -> Port {
    let role = match (name, direction) {
        ("clk_i", _) => PortRole::Clock,
        (_, PortDirection::Input) => PortRole::Pixel,
        (_, PortDirection::Output) => PortRole::TemporalCount,
    };
    let (name, doc, per_lane) = (name.to_owned(), String::new(), lanes > 1);
    Port { name, direction, role, width, lanes, per_lane, qualifier: OutputQualifier::Always, doc }
}
