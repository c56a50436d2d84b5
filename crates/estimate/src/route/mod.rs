// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clock that a design reaches: placed and routed by nextpnr on devices that it knows.
//!
//! Each device gets the synthesis of its family, and several seeds: one placement is one throw of the
//! dice. Cores have more ports than a device has pins, and their ports are joined to other logic, not to
//! pins. So every port bit gets a flip-flop of its own, only the clock has a pin, and these flip-flops are
//! not counted. See [`ports`].

mod critical;
mod device;
mod hierarchy;
mod job;
mod netlist;
mod over;
mod ports;
mod render;
mod report;
mod result;
#[cfg(test)]
mod tests;

pub use critical::{CriticalPath, PathEnd};
pub use device::{ROUTE_DEVICES, RouteDevice};
pub use job::{RouteJob, place_and_route};
pub use over::Over;
pub use render::{render_routes_markdown, render_routes_text};
pub use report::{Fmax, Placed, ROUTE_FORMAT_VERSION, RouteReport, Routed, Used};
