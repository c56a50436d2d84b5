// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of hard frames at every clock. The designs are a matrix in which every value of every
//! choice meets every other.

use foveate_design::FrameStoreKind;
use foveate_model::RasterOutput;

use super::driver::{RasterDriver, RasterTrace, RasterTraffic};
use super::properties::RasterClip;
use super::raster_parameters::RasterParameters;
use crate::hard_cases::{FILTERS, feature, hard_frames};
use crate::oracle::OracleOutcome;
use crate::parameters::{DesignParameters, PeripheryParameters};

/// Checks that the last decision of a lone frame comes at the clock of `DepartureTiming`. If all
/// regions are active, the last word leaves at its clock, too; otherwise it leaves no later.
fn check_departure(recipe: &RasterParameters, outcome: &OracleOutcome, trace: &RasterTrace) {
    let departure = recipe.design().timing().departure();
    let last = |which: fn(&RasterOutput) -> bool| trace.shown.iter().rposition(which);
    let decided = (departure.take_clocks + departure.decision_clocks) as usize;
    assert_eq!(last(|shown| shown.decision_valid), Some(decided));
    let left = (departure.take_clocks + departure.forward_clocks) as usize;
    match last(|shown| shown.forward_valid) {
        found if !recipe.forward => assert_eq!(found, None),
        found if outcome.regions.iter().all(|region| region.active) => {
            assert_eq!(found, Some(left));
        }
        found => assert!(found <= Some(left)),
    }
}

/// Plays a frame alone, and then all hard frames from this one on.
fn check(recipe: &RasterParameters, first: usize) {
    let mut frames = hard_frames(&recipe.base);
    let number = first % frames.len();
    frames.rotate_left(number);
    for count in [1, frames.len()] {
        let mut driver = RasterDriver::new(recipe, RasterTraffic::DENSE);
        let clip = RasterClip::from_frames(recipe, &frames[..count]);
        let rest = 2 * recipe.words() + 100;
        let (trace, history) = clip.check(&mut driver, (rest, i64::MAX)).unwrap();
        assert!(!driver.rcm.is_pending());
        if count == 1 {
            check_departure(recipe, &history[0], &trace);
        }
    }
}

/// Returns the recipe of a number. Its choices change at different rates with the number.
fn recipe(number: usize) -> RasterParameters {
    let on = |speed: usize| number / speed % 2 == 1;
    let all = [
        feature("edge", 120, 3000),
        feature("mad", 0, 9000),
        feature("corner", 12, 2000),
        feature("variance", 0, 300_000),
        feature("range", 0, 60_000),
        feature("surface", 0, 20_000),
        feature("segment", 16, 2000),
    ];
    let count = 1 + number % 5;
    let features = (0..count).map(|turn| all[(number / 5 + turn) % all.len()].clone()).collect();
    let (side, pixels) = [(4, 4), (4, 1), (5, 1), (6, 2), (8, 4), (3, 1), (2, 2)][number % 7];
    let columns = 4.max((16 * pixels + side - 1) / side);
    let periphery = PeripheryParameters::from_number(number / 3, side, 255)
        .filter(|periphery| side / periphery.blocks % pixels == 0);
    RasterParameters {
        base: DesignParameters {
            width: columns * side - number as i64 % side,
            height: [2, 3, 4][number % 3] * side - number as i64 / 2 % side,
            bits: 8,
            side,
            shared: on(1),
            filter: FILTERS[number / 2 % 4],
            features,
            all_must_vote: on(8),
            temporal_level: 9,
            temporal_min: side,
            last_sent: on(4),
            blank_irrelevant: on(3),
            periphery,
            raw_payload: on(6),
            constant: on(5),
            deep: false,
            zones: None,
            forced_srs: None,
        },
        word_pixels: pixels,
        deep: on(7),
        store: FrameStoreKind::Block,
        forward: true,
    }
}

/// The second core of a number has a single-port or an external store, and may lack forwarding.
#[test]
fn hard_frames_in_every_kind_of_core() {
    for number in 0..56 {
        let mut recipe = recipe(number);
        check(&recipe, number);
        recipe.base.last_sent = false;
        recipe.store =
            [FrameStoreKind::External, FrameStoreKind::SinglePort, FrameStoreKind::External]
                [number % 3];
        recipe.forward = number % 5 > 1 || recipe.base.periphery.is_some();
        check(&recipe, number);
    }
}
