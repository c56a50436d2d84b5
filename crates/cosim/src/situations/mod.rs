// SPDX-License-Identifier: MIT OR Apache-2.0
//! Situations that a check must reach, as data: a name, the designs that can have it, and the
//! number of times that it occurred on the ports.
//!
//! A check that never meets the situation that it guards proves nothing, and this would stay
//! unnoticed. So every co-simulation and every shipped bench counts the situations. The lists do
//! not depend on how stimuli are made.

mod bus;
mod occurrence;
mod places;
mod ports;
mod regions;
mod watch;

pub(crate) use bus::{BusFacts, EVENTS, can_drop_regions, can_drop_rows};
pub use occurrence::{Occurrence, Occurrences};
pub(crate) use watch::Watch;
