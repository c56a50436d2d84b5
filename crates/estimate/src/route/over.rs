// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a device has too few of, as nextpnr's log says where a design does not fit.

use serde::{Deserialize, Serialize};

/// A kind of place of which a device has too few.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Over {
    /// What nextpnr calls it.
    pub place: String,
    /// How many the design needs.
    pub used: u64,
    /// How many the device has.
    pub available: u64,
}

/// What a device has too few of, from the table in nextpnr's log: `DP16KD:  155/ 108 143%`.
pub(super) fn over(log: &str) -> Vec<Over> {
    let row = |line: &str| {
        let (place, counts) = line.strip_prefix("Info:")?.split_once(':')?;
        let (used, rest) = counts.split_once('/')?;
        let available = rest.split_whitespace().next()?;
        let over = Over {
            place: place.trim().to_owned(),
            used: used.trim().parse().ok()?,
            available: available.parse().ok()?,
        };
        (over.used > over.available).then_some(over)
    };
    log.lines().filter_map(row).collect()
}
