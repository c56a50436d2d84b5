// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clock frequency that a design reaches when nextpnr places and routes it on a supported
//! device.
//!
//! Each device gets the synthesis of its family, and several seeds, because the result of one
//! placement is random. Cores have more ports than a device has pins, and in use their ports
//! connect to other logic, not to pins. So every port bit gets a flip-flop of its own, only the
//! clock has a pin, and these flip-flops are not counted. See [`netlist`].

mod device;
mod job;
mod netlist;
mod nextpnr_report;
mod report;
mod shortage;
#[cfg(test)]
mod tests;

pub use device::{ROUTE_DEVICES, RouteDevice};
pub use job::{RouteJob, place_and_route};
pub use report::{
    ClockStatistics, CriticalPath, DeviceResult, PathEnd, PlacementResult, ROUTE_FORMAT_VERSION,
    ResourceUse, RouteReport,
};
pub use shortage::ResourceShortage;
