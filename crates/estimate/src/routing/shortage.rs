// SPDX-License-Identifier: MIT OR Apache-2.0
//! The resources that a device lacks, from nextpnr's log of a design that does not fit.

use serde::{Deserialize, Serialize};

/// A resource that a design needs more of than a device has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResourceShortage {
    /// The name of the resource in nextpnr.
    pub place: String,
    /// The number that the design needs.
    pub used: u64,
    /// The number that the device has.
    pub available: u64,
}

/// Returns the resources that a device lacks, from lines of nextpnr's log such as
/// `DP16KD: 155/ 108 143%`.
pub(super) fn resource_shortages(log: &str) -> Vec<ResourceShortage> {
    let row = |line: &str| {
        let (place, counts) = line.strip_prefix("Info:")?.split_once(':')?;
        let (used, rest) = counts.split_once('/')?;
        let available = rest.split_whitespace().next()?;
        let over = ResourceShortage {
            place: place.trim().to_owned(),
            used: used.trim().parse().ok()?,
            available: available.parse().ok()?,
        };
        (over.used > over.available).then_some(over)
    };
    log.lines().filter_map(row).collect()
}
