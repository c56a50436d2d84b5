// SPDX-License-Identifier: MIT OR Apache-2.0
//! Situations that a check must reach, as data: a name, the designs that can have it, and how often it occurred, by what is seen
//! on ports alone.
//!
//! A check that never meets the situation that it guards proves nothing, and nobody would see that: so every co-simulation and
//! every shipped bench counts them. The lists know nothing of how stimuli are made.

mod bus;
mod occurrence;
mod places;
mod ports;
mod regions;
mod watch;

pub(crate) use bus::{BusFacts, EVENTS, can_drop_regions, can_drop_rows};
pub use occurrence::{Occurrence, Occurrences};
pub(crate) use watch::Watch;
