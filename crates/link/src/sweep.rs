// SPDX-License-Identifier: MIT OR Apache-2.0
//! The design with one threshold at a time set to other values: the points of its own curves.

use foveate_design::{Config, Decimal};

/// Grey levels of 8 bits.
const LEVELS: [u32; 9] = [0, 1, 2, 4, 8, 16, 32, 64, 128];
/// Of the first feature, in its own unit; 0 finds every region relevant.
const SCORES: [u64; 8] = [0, 1, 2, 5, 10, 20, 40, 60];

/// A design of a curve.
#[derive(Clone, Debug)]
pub(crate) struct Swept {
    /// The threshold that differs.
    pub(crate) key: &'static str,
    /// What it is.
    pub(crate) value: u64,
    pub(crate) config: Config,
}

/// `temporal.level` and `spatial.0.min_score`, each varied alone.
pub(crate) fn swept(config: &Config) -> Vec<Swept> {
    let level = |&value: &u32| {
        let mut config = config.clone();
        config.temporal.level = Some(value);
        Swept { key: "temporal.level", value: value.into(), config }
    };
    let score = |&value: &u64| {
        let mut config = config.clone();
        config.spatial.first_mut()?.min_score = Some(Decimal::whole(value));
        Some(Swept { key: "spatial.0.min_score", value, config })
    };
    // A score above what a region of this design can have is no design.
    let is_design = |swept: &Swept| swept.config.validate().is_ok();
    let all = LEVELS.iter().map(level).chain(SCORES.iter().filter_map(score));
    all.filter(is_design).collect()
}
