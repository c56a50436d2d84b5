// SPDX-License-Identifier: MIT OR Apache-2.0
//! Serial arrays.

use std::collections::BTreeSet;

use foveate_camera::Neighborhood;
use foveate_design::{Design, DesignConfig, Pipelining, PixelFeed, SerialTiming};
use foveate_timed::CoreTiming;
use proptest::prelude::*;

use crate::clip_script::{clip, scripts};
use crate::comparison::{
    PlantedFault, cases, check, event_kinds, found_faults, recordings, with_any_sync,
};
use crate::serial_parameters::arbitrary_serial_parameters;
use crate::traffic::traffic;

fn designs() -> impl Strategy<Value = Design> {
    with_any_sync(arbitrary_serial_parameters().prop_map(|recipe| recipe.design()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(60)))]

    #[test]
    fn every_transaction_of_a_serial_array_has_its_clock(
        design in designs(),
        (seed, script) in scripts(),
        traffic in traffic(),
    ) {
        check(&design, traffic, &clip(&design, seed, &script));
    }
}

#[test]
fn random_traffic_of_serial_arrays_shows_every_kind_of_event() {
    let expected = ["decision", "error", "pixels", "reset", "score", "summary"];
    assert_eq!(event_kinds(&recordings(designs(), 30)), BTreeSet::from(expected));
}

/// A serial array with the timing of another design, which differs in one respect.
#[test]
fn the_comparison_finds_the_timing_of_another_serial_array() {
    let recordings = recordings(designs(), 30);
    let faults: [PlantedFault<DesignConfig>; 5] = [
        ("another depth", |config| {
            config.hardware.pipelining = match config.hardware.pipelining {
                Pipelining::Plain => Pipelining::Deep,
                Pipelining::Deep => Pipelining::Plain,
            };
        }),
        ("another feed", |config| {
            config.hardware.make_serial().feed = match config.hardware.make_serial().feed {
                Some(PixelFeed::Parallel) | None => Some(PixelFeed::Raster),
                Some(PixelFeed::Raster) => Some(PixelFeed::Parallel),
            };
        }),
        ("another neighborhood", |config| {
            config.camera.region.neighborhood = match config.camera.region.neighborhood {
                Neighborhood::Isolated => Neighborhood::Shared,
                Neighborhood::Shared => Neighborhood::Isolated,
            };
        }),
        ("one lane", |config| config.hardware.make_serial().fold = 1),
        ("a feature less", |config| {
            if config.camera.spatial.len() > 1 {
                config.camera.spatial.pop();
            }
        }),
    ];
    for (name, plant) in faults {
        let faulty = |design: &Design| {
            let mut config = design.config();
            plant(&mut config);
            let other = config.validate().unwrap();
            CoreTiming::Serial(SerialTiming::from_design(other.as_serial().unwrap()))
        };
        assert!(found_faults(&recordings, faulty) > 0, "{name}");
    }
}
