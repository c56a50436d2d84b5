// SPDX-License-Identifier: MIT OR Apache-2.0
//! A small hand-made module and a matching closure, to test the machinery without model and RTL.

use foveate_design::{Direction, Port, PortRole, Qualifier};

/// A port of any name and shape; the role is the clock's for `clk_i` and of no meaning otherwise.
pub(crate) fn port(name: &str, direction: Direction, width: u32, lanes: u32) -> Port {
    let role = match (name, direction) {
        ("clk_i", _) => PortRole::Clock,
        (_, Direction::Input) => PortRole::Pixel,
        (_, Direction::Output) => PortRole::TemporalCount,
    };
    let (name, doc, per_lane) = (name.to_owned(), String::new(), lanes > 1);
    Port { name, direction, role, width, lanes, per_lane, qualifier: Qualifier::Always, doc }
}
