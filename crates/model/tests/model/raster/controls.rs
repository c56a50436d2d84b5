// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that wrong expectations are noticed: the checks of this module, with one thing changed in
//! what they expect.

use std::collections::BTreeSet;

use foveate_design::Store;

use super::driver::{Driver, Manner, Sink};
use super::expected::{Check, Oracle};
use super::memory::Faults;
use super::properties::Film;
use super::recipe::{Misread, RasterRecipe};
use crate::frames::{Content, Script};
use crate::recipe::{FeatureRecipe, PeripheryRecipe, Recipe};

fn feature(name: &'static str, level: i64, min_milli: i64) -> FeatureRecipe {
    FeatureRecipe { name, level, min_milli, fraction_bits: 1 }
}

/// Returns 4x4 regions of 4x4 pixels. The last column and the last row are ragged.
fn recipe(last: FeatureRecipe) -> RasterRecipe {
    RasterRecipe {
        base: Recipe {
            width: 15,
            height: 14,
            bits: 8,
            side: 4,
            shared: true,
            median: true,
            features: vec![feature("edge", 150, 6000), last],
            all_must_vote: false,
            temporal_level: 20,
            temporal_min: 6,
            last_sent: true,
            blank_irrelevant: false,
            periphery: None,
            raw_payload: false,
            constant: true,
            deep: false,
        },
        pixels: 1,
        deep: false,
        store: Store::Block,
        forward: true,
        misread: Misread::default(),
    }
}

fn script() -> Script {
    use Content::{AlmostFlat, Noise, Repeat, Touch};
    let contents = [Noise, Touch, Repeat, AlmostFlat, Touch, Noise, Touch, Repeat, Touch, Repeat];
    contents.into_iter().zip(5..).collect()
}

/// A sink that loses regions.
const SLOW: Manner =
    Manner { gaps: 3, pushing: 50, sink: Sink::Often(45), faults: FEW, ..Manner::DENSE };
/// An external memory that fails occasionally.
const FEW: Faults = Faults { missing: 4, wrong: 4 };

/// Runs the core of `built`, and checks it against the changed expectations.
fn expect(built: &RasterRecipe, change: impl Fn(&mut RasterRecipe)) -> Check {
    expect_of(built, &script(), SLOW, change)
}

fn expect_of(
    built: &RasterRecipe,
    script: &Script,
    manner: Manner,
    change: impl Fn(&mut RasterRecipe),
) -> Check {
    let film = Film::new(built, script);
    let trace = Driver::new(built, manner).run(&film.jobs(), 300, i64::MAX);
    let mut expected = built.clone();
    change(&mut expected);
    let mut recipes = film.recipes.clone();
    recipes.iter_mut().for_each(change);
    Oracle::check(&expected, &recipes, &film.frames, &trace)
}

type Fault = (&'static str, fn(&mut RasterRecipe));

const FAULTS: [Fault; 22] = [
    ("S", |recipe| recipe.misread.stored = 1),
    ("D", |recipe| recipe.misread.decided = 1),
    ("resting", |recipe| recipe.misread.rest = 1),
    ("not resting", |recipe| recipe.misread.rest = -1),
    ("buffer", |recipe| recipe.misread.rows = 1),
    ("references of lost regions", |recipe| recipe.misread.keeps_reference = true),
    ("ends of lost regions", |recipe| recipe.misread.endless = true),
    ("numbers of frames", |recipe| recipe.misread.frame = 1),
    ("pipelining", |recipe| recipe.deep = true),
    ("width", |recipe| recipe.base.width -= 1),
    ("height", |recipe| recipe.base.height -= 1),
    ("edge level", |recipe| recipe.base.features[0].level += 60),
    ("edge minimum", |recipe| recipe.base.features[0].min_milli += 4000),
    ("order of features", |recipe| recipe.base.features.reverse()),
    ("combination", |recipe| recipe.base.all_must_vote = true),
    ("median", |recipe| recipe.base.median = false),
    ("neighborhood", |recipe| recipe.base.shared = false),
    ("temporal level", |recipe| recipe.base.temporal_level += 5),
    ("temporal minimum", |recipe| recipe.base.temporal_min = 16),
    ("reference", |recipe| recipe.base.last_sent = false),
    ("irrelevant", |recipe| recipe.base.blank_irrelevant = true),
    ("payload", |recipe| recipe.base.raw_payload = true),
];

#[test]
fn every_planted_fault_is_noticed() {
    let mad = recipe(feature("mad", 0, 18_000));
    let variance = recipe(feature("variance", 0, 900_000));
    for built in [&mad, &variance] {
        assert_eq!(expect(built, |_| {}), Ok(()));
        for (fault, spoil) in FAULTS {
            assert!(expect(built, spoil).is_err(), "{fault} goes unnoticed");
        }
    }
    assert!(expect(&mad, |recipe| recipe.misread.pass = 1).is_err(), "second pass");
    assert!(expect(&mad, |recipe| recipe.base.features[1].fraction_bits = 2).is_err(), "fraction");
}

/// The frames have words of two pixels and wait for pending regions.
#[test]
fn faults_of_small_frames_in_wide_words_are_noticed() {
    let mut built = recipe(feature("variance", 0, 900_000));
    (built.pixels, built.base.width, built.base.height) = (2, 31, 7);
    assert_eq!(expect(&built, |_| {}), Ok(()));
    let faults: [Fault; 3] = [
        ("waiting", |recipe| recipe.misread.never_waits = true),
        ("words", |recipe| recipe.pixels = 1),
        ("width", |recipe| recipe.base.width -= 2),
    ];
    for (fault, spoil) in faults {
        assert!(expect(&built, spoil).is_err(), "{fault} goes unnoticed");
    }
}

/// The external store fails occasionally. The designs have both pipelinings, and one has a second
/// pass.
#[test]
fn faults_of_a_store_outside_are_noticed() {
    for (last, deep) in [
        (feature("variance", 0, 900_000), false),
        (feature("variance", 0, 900_000), true),
        (feature("mad", 0, 18_000), false),
    ] {
        let mut built = recipe(last);
        (built.base.last_sent, built.store, built.deep) = (false, Store::External, deep);
        for forward in [true, false] {
            built.forward = forward;
            assert_eq!(expect(&built, |_| {}), Ok(()));
            let faults: [Fault; 6] = [
                ("taking later", |recipe| recipe.misread.taken = 1),
                ("taking earlier", |recipe| recipe.misread.taken = -1),
                ("taking always", |recipe| recipe.misread.always_takes = true),
                ("trusting", |recipe| recipe.misread.trusts = true),
                ("S", |recipe| recipe.misread.stored = 1),
                ("median", |recipe| recipe.base.median = false),
            ];
            for (fault, spoil) in faults {
                assert!(expect(&built, spoil).is_err(), "{fault} goes unnoticed");
            }
            assert!(expect(&built, |recipe| recipe.forward ^= true).is_err(), "forwarding");
        }
    }
}

/// Returns a recipe with summaries, of which a slow sink loses some.
fn with_summaries(pixels: i64) -> RasterRecipe {
    let mut recipe = recipe(feature("variance", 0, 900_000));
    (recipe.base.side, recipe.base.width, recipe.base.height) = (8, 31.max(16 * pixels - 3), 37);
    recipe.base.last_sent = false;
    recipe.base.periphery = Some(PeripheryRecipe { blocks: 2, level: 3 });
    recipe.base.features[0].min_milli = 20_000;
    recipe.pixels = pixels;
    recipe
}

/// Returns a script of flat and busy regions, some of which do not change.
fn flat_script() -> Script {
    use Content::{AlmostFlat, Noise, Nudge, Repeat, Touch};
    let contents =
        [AlmostFlat, Nudge, Repeat, Noise, AlmostFlat, Repeat, Touch, Repeat, AlmostFlat];
    contents.into_iter().zip(5..).collect()
}

/// A sink that loses summaries.
const SLOWER: Manner = Manner { sink: Sink::Turns(2000), ..SLOW };

#[test]
fn faults_of_summaries_are_noticed() {
    let expect = |built: &RasterRecipe, change: fn(&mut RasterRecipe)| {
        expect_of(built, &flat_script(), SLOWER, change)
    };
    for pixels in [1, 2, 4] {
        let built = with_summaries(pixels);
        assert_eq!(expect(&built, |_| {}), Ok(()));
        let faults: [Fault; 10] = [
            ("level", |recipe| recipe.base.periphery.as_mut().unwrap().level = 0),
            ("blocks", |recipe| recipe.base.periphery.as_mut().unwrap().blocks = 1),
            ("summaries of lost regions", |recipe| recipe.misread.keeps_reference = true),
            ("ends of lost regions", |recipe| recipe.misread.endless = true),
            ("numbers of frames", |recipe| recipe.misread.frame = 1),
            ("resting", |recipe| recipe.misread.rest = 1),
            ("buffer", |recipe| recipe.misread.rows = 1),
            ("irrelevant", |recipe| recipe.base.periphery = None),
            ("payload", |recipe| recipe.base.raw_payload = true),
            ("reference", |recipe| recipe.base.last_sent = true),
        ];
        for (fault, spoil) in faults {
            assert!(expect(&built, spoil).is_err(), "{fault} goes unnoticed, {pixels}");
        }
    }
    let mut small = with_summaries(1);
    small.base.height = 14;
    assert_eq!(expect(&small, |_| {}), Ok(()));
    assert!(expect(&small, |recipe| recipe.misread.never_waits = true).is_err(), "waiting");
    // The summary has one mean, after which the readout waits before it holds the next region.
    let mut one = with_summaries(1);
    one.base.periphery = Some(PeripheryRecipe { blocks: 1, level: 3 });
    assert_eq!(expect(&one, |_| {}), Ok(()));
    assert!(expect(&one, |recipe| recipe.misread.rest = -1).is_err(), "not resting");
}

/// A slow sink loses summaries too, both before a word of them is fetched and in the middle.
#[test]
fn a_slow_sink_loses_summaries() {
    let built = with_summaries(2);
    let film = Film::new(&built, &flat_script());
    let trace = Driver::new(&built, SLOWER).run(&film.jobs(), 300, i64::MAX);
    let (mut frame, mut sent) = (0, BTreeSet::new());
    let (mut lost, mut aborted) = (0, 0);
    for shown in &trace.shown {
        if shown.decision_valid {
            frame += u32::from(shown.region == 0);
            sent.extend(shown.summary.then_some((frame - 1, shown.region)));
        }
        let loss = (shown.lost_frame, shown.lost_region);
        lost += usize::from(shown.lost_valid && sent.contains(&loss));
        aborted += usize::from(shown.forward_valid && shown.forward_abort && shown.forward_summary);
    }
    assert!(sent.len() > 50 && lost > 10 && aborted > 0, "{} {lost} {aborted}", sent.len());
}

/// The other tests are meaningful only if the losses and waits that this test counts occur.
#[test]
fn a_slow_sink_loses_regions_and_holds_small_frames_back() {
    let built = recipe(feature("variance", 0, 900_000));
    let film = Film::new(&built, &script());
    let lost = |sink| {
        let manner = Manner { sink, ..SLOW };
        let trace = Driver::new(&built, manner).run(&film.jobs(), 300, i64::MAX);
        trace.shown.last().unwrap().lost_count
    };
    assert_eq!(lost(Sink::Often(100)), 0);
    assert!(lost(Sink::Often(45)) > 20, "{}", lost(Sink::Often(45)));
    assert!(lost(Sink::Often(0)) > lost(Sink::Often(45)));

    let mut small = built.clone();
    small.base.height = 7;
    let clocks = |recipe: &RasterRecipe, sink| {
        let film = Film::new(recipe, &script());
        let manner = Manner { sink, ..Manner::DENSE };
        let trace = Driver::new(recipe, manner).run(&film.jobs(), 0, i64::MAX);
        (trace.shown.last().unwrap().lost, trace.end())
    };
    let (lost, slow) = clocks(&small, Sink::Often(20));
    assert!(!lost && slow > clocks(&small, Sink::Often(100)).1);
}
