// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that wrong expectations are noticed: the bench, with one thing changed in what it expects.

use foveate_model::SerialRcm;

use super::bench::{Bench, Check, Manner};
use super::properties::jobs;
use super::recipe::SerialRecipe;
use super::waveform::Facts;
use crate::frames::Content;
use crate::recipe::{FeatureRecipe, PeripheryRecipe, Recipe};

fn recipe() -> SerialRecipe {
    let feature =
        |name, level, min_milli| FeatureRecipe { name, level, min_milli, fraction_bits: 1 };
    SerialRecipe {
        base: Recipe {
            width: 15,
            height: 9,
            bits: 8,
            side: 5,
            shared: true,
            median: true,
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
        },
        raster: true,
        fold: 2,
    }
}

/// Runs the array of `built` against expectations with the fault `spoil`, which changes the recipe
/// or the expected results of the frames.
fn expect(built: &SerialRecipe, spoil: &Spoil) -> Check {
    use Content::{AlmostFlat, Noise, Nudge, Repeat, Touch};
    let contents = [Noise, Touch, Repeat, AlmostFlat, Nudge, Touch, Noise];
    let script = contents.into_iter().zip(5..).collect();
    let mut expected = built.clone();
    let mut jobs_of_both = jobs(built, &script);
    if let Spoil::Recipe(change) = spoil {
        change(&mut expected);
        for (job, other) in jobs_of_both.iter_mut().zip(jobs(&expected, &script)) {
            job.facts = other.facts;
        }
    }
    let mut bench =
        Bench::new(&expected, SerialRcm::new(built.design().serial().unwrap()), Manner::DENSE);
    match spoil {
        Spoil::Nothing | Spoil::Recipe(_) => {}
        Spoil::Clock => bench.late = 1,
        Spoil::Facts(change) => jobs_of_both.iter_mut().for_each(|job| change(&mut job.facts)),
    }
    bench.run(&jobs_of_both)
}

enum Spoil {
    Nothing,
    Clock,
    Recipe(fn(&mut SerialRecipe)),
    Facts(fn(&mut Vec<Facts>)),
}

#[test]
fn every_planted_fault_is_noticed() {
    let faults = [
        ("clock", Spoil::Clock),
        ("regions swapped", Spoil::Facts(|facts| facts.swap(0, 3))),
        ("one pixel of a region", Spoil::Facts(|facts| facts[1].payload[24] ^= 1)),
        ("one bit of a score", Spoil::Facts(|facts| facts[5].scores[2] ^= 1)),
        ("edge level", Spoil::Recipe(|recipe| recipe.base.features[0].level += 30)),
        ("edge minimum", Spoil::Recipe(|recipe| recipe.base.features[0].min_milli += 4000)),
        ("fraction bits", Spoil::Recipe(|recipe| recipe.base.features[1].fraction_bits = 2)),
        ("order of features", Spoil::Recipe(|recipe| recipe.base.features.reverse())),
        ("combination", Spoil::Recipe(|recipe| recipe.base.all_must_vote = true)),
        ("median", Spoil::Recipe(|recipe| recipe.base.median = false)),
        ("neighborhood", Spoil::Recipe(|recipe| recipe.base.shared = false)),
        ("temporal level", Spoil::Recipe(|recipe| recipe.base.temporal_level += 1)),
        ("temporal minimum", Spoil::Recipe(|recipe| recipe.base.temporal_min = 25)),
        ("reference", Spoil::Recipe(|recipe| recipe.base.last_sent = false)),
        ("irrelevant", Spoil::Recipe(|recipe| recipe.base.blank_irrelevant = false)),
        ("payload", Spoil::Recipe(|recipe| recipe.base.raw_payload = true)),
        ("fold", Spoil::Recipe(|recipe| recipe.fold = 3)),
        ("pipelining", Spoil::Recipe(|recipe| recipe.base.deep = true)),
        ("depth", Spoil::Recipe(|recipe| recipe.base.bits = 9)),
    ];
    check(&recipe(), &faults);
}

#[test]
fn every_planted_fault_of_a_summary_is_noticed() {
    let mut recipe = recipe();
    recipe.base.side = 4;
    set(&mut recipe, 2, 3);
    let faults = [
        ("clock", Spoil::Clock),
        ("regions swapped", Spoil::Facts(|facts| facts.swap(0, 3))),
        ("one mean of a region", Spoil::Facts(|facts| facts[1].means[3] ^= 1)),
        ("blocks swapped", Spoil::Facts(|facts| facts[4].means.swap(1, 2))),
        ("all is sent", Spoil::Facts(|facts| facts[2].summary = !facts[2].srs)),
        ("nothing is sent", Spoil::Facts(|facts| facts[2].summary = false)),
        ("level", Spoil::Recipe(|recipe| set(recipe, 2, 0))),
        ("blocks", Spoil::Recipe(|recipe| set(recipe, 1, 3))),
        ("irrelevant", Spoil::Recipe(|recipe| recipe.base.periphery = None)),
        ("payload", Spoil::Recipe(|recipe| recipe.base.raw_payload = true)),
        ("reference", Spoil::Recipe(|recipe| recipe.base.last_sent = false)),
        ("fold", Spoil::Recipe(|recipe| recipe.fold = 3)),
        ("pipelining", Spoil::Recipe(|recipe| recipe.base.deep = true)),
    ];
    check(&recipe, &faults);
}

fn set(recipe: &mut SerialRecipe, blocks: i64, level: i64) {
    recipe.base.periphery = Some(PeripheryRecipe { blocks, level });
}

/// Checks that every fault is noticed with both feeds, and that there is no error without a fault.
fn check(recipe: &SerialRecipe, faults: &[(&str, Spoil)]) {
    for raster in [false, true] {
        let recipe = SerialRecipe { raster, ..recipe.clone() };
        assert_eq!(expect(&recipe, &Spoil::Nothing), Ok(()));
        for (fault, spoil) in faults {
            assert!(expect(&recipe, spoil).is_err(), "{fault} goes unnoticed");
        }
    }
}
