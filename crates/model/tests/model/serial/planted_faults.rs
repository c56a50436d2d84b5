// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that wrong expectations are noticed: the bench, with one thing changed in what it expects.

use foveate_model::SerialRcm;

use super::bench::{SerialBench, SerialCheckResult, SerialTraffic};
use super::expected_outputs::RegionResults;
use super::properties::stimuli;
use super::serial_parameters::SerialParameters;
use crate::frames::FrameContent;
use crate::parameters::{DesignParameters, FeatureParameters, PeripheryParameters};

fn recipe() -> SerialParameters {
    let feature = |name, level, min_milli| FeatureParameters {
        name,
        level,
        min_milli,
        fraction_bits: 1,
        radius: 1,
    };
    SerialParameters {
        base: DesignParameters {
            width: 15,
            height: 9,
            bits: 8,
            side: 5,
            shared: true,
            filter: "median3x3",
            features: vec![feature("edge", 150, 9000), feature("mad", 0, 20_000)],
            all_must_vote: false,
            temporal_level: 20,
            temporal_min: 9,
            last_sent: true,
            blank_irrelevant: true,
            periphery: None,
            raw_payload: false,
            constant: true,
            deep: false,
            zones: None,
            forced_srs: None,
        },
        raster: true,
        fold: 2,
    }
}

/// Runs the array of `built` against expectations with the fault `spoil`, which changes the recipe
/// or the expected results of the frames.
fn check_with_fault(built: &SerialParameters, spoil: &SerialFault) -> SerialCheckResult {
    use FrameContent::{AlmostFlat, FewChanges, Noise, Repeat, SmallSteps};
    let contents = [Noise, FewChanges, Repeat, AlmostFlat, SmallSteps, FewChanges, Noise];
    let script = contents.into_iter().zip(5..).collect();
    let mut expected = built.clone();
    let mut jobs_of_both = stimuli(built, &script);
    if let SerialFault::Recipe(change) = spoil {
        change(&mut expected);
        for (job, other) in jobs_of_both.iter_mut().zip(stimuli(&expected, &script)) {
            job.facts = other.facts;
        }
    }
    let mut bench = SerialBench::new(
        &expected,
        SerialRcm::new(built.design().as_serial().unwrap()),
        SerialTraffic::DENSE,
    );
    match spoil {
        SerialFault::None | SerialFault::Recipe(_) => {}
        SerialFault::Clock => bench.late = 1,
        SerialFault::Facts(change) => {
            jobs_of_both.iter_mut().for_each(|job| change(&mut job.facts));
        }
    }
    bench.run(&jobs_of_both)
}

enum SerialFault {
    None,
    Clock,
    Recipe(fn(&mut SerialParameters)),
    Facts(fn(&mut Vec<RegionResults>)),
}

#[test]
fn every_planted_fault_is_noticed() {
    let faults = [
        ("clock", SerialFault::Clock),
        ("regions swapped", SerialFault::Facts(|facts| facts.swap(0, 3))),
        ("one pixel of a region", SerialFault::Facts(|facts| facts[1].payload[24] ^= 1)),
        ("one bit of a score", SerialFault::Facts(|facts| facts[5].scores[2] ^= 1)),
        ("edge level", SerialFault::Recipe(|recipe| recipe.base.features[0].level += 30)),
        ("edge minimum", SerialFault::Recipe(|recipe| recipe.base.features[0].min_milli += 4000)),
        ("fraction bits", SerialFault::Recipe(|recipe| recipe.base.features[1].fraction_bits = 2)),
        ("order of features", SerialFault::Recipe(|recipe| recipe.base.features.reverse())),
        ("combination", SerialFault::Recipe(|recipe| recipe.base.all_must_vote = true)),
        ("median", SerialFault::Recipe(|recipe| recipe.base.filter = "none")),
        ("neighborhood", SerialFault::Recipe(|recipe| recipe.base.shared = false)),
        ("temporal level", SerialFault::Recipe(|recipe| recipe.base.temporal_level += 1)),
        ("temporal minimum", SerialFault::Recipe(|recipe| recipe.base.temporal_min = 25)),
        ("reference", SerialFault::Recipe(|recipe| recipe.base.last_sent = false)),
        ("irrelevant", SerialFault::Recipe(|recipe| recipe.base.blank_irrelevant = false)),
        ("payload", SerialFault::Recipe(|recipe| recipe.base.raw_payload = true)),
        ("fold", SerialFault::Recipe(|recipe| recipe.fold = 3)),
        ("pipelining", SerialFault::Recipe(|recipe| recipe.base.deep = true)),
        ("depth", SerialFault::Recipe(|recipe| recipe.base.bits = 9)),
    ];
    check(&recipe(), &faults);
}

#[test]
fn every_planted_fault_of_a_summary_is_noticed() {
    let mut recipe = recipe();
    recipe.base.side = 4;
    set_periphery(&mut recipe, 2, 3);
    let faults = [
        ("clock", SerialFault::Clock),
        ("regions swapped", SerialFault::Facts(|facts| facts.swap(0, 3))),
        ("one mean of a region", SerialFault::Facts(|facts| facts[1].means[3] ^= 1)),
        ("blocks swapped", SerialFault::Facts(|facts| facts[4].means.swap(1, 2))),
        ("all is sent", SerialFault::Facts(|facts| facts[2].summary = !facts[2].srs)),
        ("nothing is sent", SerialFault::Facts(|facts| facts[2].summary = false)),
        ("level", SerialFault::Recipe(|recipe| set_periphery(recipe, 2, 0))),
        ("blocks", SerialFault::Recipe(|recipe| set_periphery(recipe, 1, 3))),
        ("irrelevant", SerialFault::Recipe(|recipe| recipe.base.periphery = None)),
        ("payload", SerialFault::Recipe(|recipe| recipe.base.raw_payload = true)),
        ("reference", SerialFault::Recipe(|recipe| recipe.base.last_sent = false)),
        ("fold", SerialFault::Recipe(|recipe| recipe.fold = 3)),
        ("pipelining", SerialFault::Recipe(|recipe| recipe.base.deep = true)),
    ];
    check(&recipe, &faults);
}

fn set_periphery(recipe: &mut SerialParameters, blocks: i64, level: i64) {
    recipe.base.periphery = Some(PeripheryParameters { blocks, level });
}

/// Checks that every fault is noticed with both feeds, and that there is no error without a fault.
fn check(recipe: &SerialParameters, faults: &[(&str, SerialFault)]) {
    for raster in [false, true] {
        let recipe = SerialParameters { raster, ..recipe.clone() };
        assert_eq!(check_with_fault(&recipe, &SerialFault::None), Ok(()));
        for (fault, spoil) in faults {
            assert!(check_with_fault(&recipe, spoil).is_err(), "{fault} goes unnoticed");
        }
    }
}
