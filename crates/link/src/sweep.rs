// SPDX-License-Identifier: MIT OR Apache-2.0
//! The design with one threshold at a time set to other values: the points of its own curves.

use foveate_design::{Config, Decimal, Design};

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
    pub(crate) design: Design,
}

/// `temporal.level` and `spatial.0.min_score`, each varied alone.
pub(crate) fn swept(config: &Config) -> Vec<Swept> {
    // A score above what a region of this design can have is no design.
    let swept =
        |key, value, config: Config| Some(Swept { key, value, design: config.validate().ok()? });
    let level = |&value: &u32| {
        let mut config = config.clone();
        config.camera.temporal.level = Some(value);
        swept("temporal.level", value.into(), config)
    };
    let score = |&value: &u64| {
        let mut config = config.clone();
        config.camera.spatial.first_mut()?.min_score = Some(Decimal::whole(value));
        swept("spatial.0.min_score", value, config)
    };
    LEVELS.iter().filter_map(level).chain(SCORES.iter().filter_map(score)).collect()
}
