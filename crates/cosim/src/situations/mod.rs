// SPDX-License-Identifier: MIT OR Apache-2.0
//! Situations that a check must reach, as data: a name, the designs that can have it, and the
//! number of times that it occurred on the ports.
//!
//! A check that never meets the situation that it guards proves nothing, and this would stay
//! unnoticed. So every co-simulation and every shipped bench counts the situations. The lists do
//! not depend on how stimuli are made.

mod bus_situations;
mod monitor;
mod occurrence;
mod port_situations;
mod region_traces;
mod watched_ports;

pub(crate) use bus_situations::{BusSituationCounts, EVENTS, can_drop_regions, can_drop_rows};
pub(crate) use monitor::SituationMonitor;
pub use occurrence::{Occurrence, Occurrences};
pub(crate) use port_situations::{
    can_be_irrelevant, can_hold, can_lose, has_sink, largest_min_count,
};
