// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that wrong expectations are noticed: the checks of this module, with one thing changed in
//! what they expect.

use std::collections::BTreeSet;

use foveate_design::FrameStoreKind;

use super::driver::{RasterDriver, RasterTraffic, SinkPattern};
use super::memory::MemoryFaultRates;
use super::properties::RasterClip;
use super::raster_oracle::{RasterCheckResult, RasterOracle};
use super::raster_parameters::{PlantedMisreading, RasterParameters};
use crate::frames::{ClipScript, FrameContent};
use crate::parameters::{DesignParameters, FeatureParameters, PeripheryParameters};

fn feature(name: &'static str, level: i64, min_milli: i64) -> FeatureParameters {
    FeatureParameters { name, level, min_milli, fraction_bits: 1, radius: 1 }
}

/// Returns 4x4 regions of 4x4 pixels. The last column and the last row are ragged.
fn recipe(last: FeatureParameters) -> RasterParameters {
    RasterParameters {
        base: DesignParameters {
            width: 15,
            height: 14,
            bits: 8,
            side: 4,
            shared: true,
            filter: "median3x3",
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
            zones: None,
            forced_srs: None,
        },
        word_pixels: 1,
        deep: false,
        store: FrameStoreKind::Block,
        forward: true,
        misread: PlantedMisreading::default(),
    }
}

fn script() -> ClipScript {
    use FrameContent::{AlmostFlat, FewChanges, Noise, Repeat};
    let contents = [
        Noise, FewChanges, Repeat, AlmostFlat, FewChanges, Noise, FewChanges, Repeat, FewChanges,
        Repeat,
    ];
    contents.into_iter().zip(5..).collect()
}

/// A sink that loses regions.
const SLOW_SINK: RasterTraffic = RasterTraffic {
    gaps: 3,
    pushing: 50,
    sink: SinkPattern::Percent(45),
    faults: FEW_FAULTS,
    ..RasterTraffic::DENSE
};
/// An external memory that fails occasionally.
const FEW_FAULTS: MemoryFaultRates = MemoryFaultRates { missing: 4, wrong: 4 };

/// Runs the core of `built`, and checks it against the changed expectations.
fn check_with_change(
    built: &RasterParameters,
    change: impl Fn(&mut RasterParameters),
) -> RasterCheckResult {
    check_clip_with_change(built, &script(), SLOW_SINK, change)
}

fn check_clip_with_change(
    built: &RasterParameters,
    script: &ClipScript,
    traffic: RasterTraffic,
    change: impl Fn(&mut RasterParameters),
) -> RasterCheckResult {
    let clip = RasterClip::new(built, script);
    let trace = RasterDriver::new(built, traffic).run(&clip.stimuli(), 300, i64::MAX);
    let mut expected = built.clone();
    change(&mut expected);
    let mut recipes = clip.recipes.clone();
    recipes.iter_mut().for_each(change);
    RasterOracle::check(&expected, &recipes, &clip.frames, &trace)
}

type PlantedFault = (&'static str, fn(&mut RasterParameters));

const FAULTS: [PlantedFault; 22] = [
    ("S", |recipe| recipe.misread.stored = 1),
    ("D", |recipe| recipe.misread.decided = 1),
    ("resting", |recipe| recipe.misread.rest = 1),
    ("not resting", |recipe| recipe.misread.rest = -1),
    ("buffer", |recipe| recipe.misread.rows = 1),
    ("references of lost regions", |recipe| recipe.misread.keeps_reference = true),
    ("ends of lost regions", |recipe| recipe.misread.drops_aborts = true),
    ("numbers of frames", |recipe| recipe.misread.frame = 1),
    ("pipelining", |recipe| recipe.deep = true),
    ("width", |recipe| recipe.base.width -= 1),
    ("height", |recipe| recipe.base.height -= 1),
    ("edge level", |recipe| recipe.base.features[0].level += 60),
    ("edge minimum", |recipe| recipe.base.features[0].min_milli += 4000),
    ("order of features", |recipe| recipe.base.features.reverse()),
    ("combination", |recipe| recipe.base.all_must_vote = true),
    ("median", |recipe| recipe.base.filter = "none"),
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
        assert_eq!(check_with_change(built, |_| {}), Ok(()));
        for (fault, spoil) in FAULTS {
            assert!(check_with_change(built, spoil).is_err(), "{fault} goes unnoticed");
        }
    }
    assert!(check_with_change(&mad, |recipe| recipe.misread.pass = 1).is_err(), "second pass");
    assert!(
        check_with_change(&mad, |recipe| recipe.base.features[1].fraction_bits = 2).is_err(),
        "fraction"
    );
}

/// The frames have words of two pixels and wait for pending regions.
#[test]
fn faults_of_small_frames_in_wide_words_are_noticed() {
    let mut built = recipe(feature("variance", 0, 900_000));
    (built.word_pixels, built.base.width, built.base.height) = (2, 31, 7);
    assert_eq!(check_with_change(&built, |_| {}), Ok(()));
    let faults: [PlantedFault; 3] = [
        ("waiting", |recipe| recipe.misread.never_waits = true),
        ("words", |recipe| recipe.word_pixels = 1),
        ("width", |recipe| recipe.base.width -= 2),
    ];
    for (fault, spoil) in faults {
        assert!(check_with_change(&built, spoil).is_err(), "{fault} goes unnoticed");
    }
}

/// The external store fails occasionally. The designs have both pipelinings, and one has a second
/// pass.
#[test]
fn faults_of_an_external_store_are_noticed() {
    for (last, deep) in [
        (feature("variance", 0, 900_000), false),
        (feature("variance", 0, 900_000), true),
        (feature("mad", 0, 18_000), false),
    ] {
        let mut built = recipe(last);
        (built.base.last_sent, built.store, built.deep) = (false, FrameStoreKind::External, deep);
        for forward in [true, false] {
            built.forward = forward;
            assert_eq!(check_with_change(&built, |_| {}), Ok(()));
            let faults: [PlantedFault; 6] = [
                ("taking later", |recipe| recipe.misread.taken = 1),
                ("taking earlier", |recipe| recipe.misread.taken = -1),
                ("taking always", |recipe| recipe.misread.always_takes = true),
                ("trusting", |recipe| recipe.misread.trusts_memory = true),
                ("S", |recipe| recipe.misread.stored = 1),
                ("median", |recipe| recipe.base.filter = "none"),
            ];
            for (fault, spoil) in faults {
                assert!(check_with_change(&built, spoil).is_err(), "{fault} goes unnoticed");
            }
            assert!(
                check_with_change(&built, |recipe| recipe.forward ^= true).is_err(),
                "forwarding"
            );
        }
    }
}

/// Returns a recipe with summaries, of which a slow sink loses some.
fn with_summaries(pixels: i64) -> RasterParameters {
    let mut recipe = recipe(feature("variance", 0, 900_000));
    (recipe.base.side, recipe.base.width, recipe.base.height) = (8, 31.max(16 * pixels - 3), 37);
    recipe.base.last_sent = false;
    recipe.base.periphery = Some(PeripheryParameters { blocks: 2, level: 3 });
    recipe.base.features[0].min_milli = 20_000;
    recipe.word_pixels = pixels;
    recipe
}

/// Returns a script of flat and busy regions, some of which do not change.
fn flat_script() -> ClipScript {
    use FrameContent::{AlmostFlat, FewChanges, Noise, Repeat, SmallSteps};
    let contents =
        [AlmostFlat, SmallSteps, Repeat, Noise, AlmostFlat, Repeat, FewChanges, Repeat, AlmostFlat];
    contents.into_iter().zip(5..).collect()
}

const SUMMARY_LOSING_SINK: RasterTraffic =
    RasterTraffic { sink: SinkPattern::Alternating(2000), ..SLOW_SINK };

#[test]
fn faults_of_summaries_are_noticed() {
    let expect = |built: &RasterParameters, change: fn(&mut RasterParameters)| {
        check_clip_with_change(built, &flat_script(), SUMMARY_LOSING_SINK, change)
    };
    for pixels in [1, 2, 4] {
        let built = with_summaries(pixels);
        assert_eq!(expect(&built, |_| {}), Ok(()));
        let faults: [PlantedFault; 10] = [
            ("level", |recipe| recipe.base.periphery.as_mut().unwrap().level = 0),
            ("blocks", |recipe| recipe.base.periphery.as_mut().unwrap().blocks = 1),
            ("summaries of lost regions", |recipe| recipe.misread.keeps_reference = true),
            ("ends of lost regions", |recipe| recipe.misread.drops_aborts = true),
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
    one.base.periphery = Some(PeripheryParameters { blocks: 1, level: 3 });
    assert_eq!(expect(&one, |_| {}), Ok(()));
    assert!(expect(&one, |recipe| recipe.misread.rest = -1).is_err(), "not resting");
}

/// A slow sink loses summaries too, both before a word of them is fetched and in the middle.
#[test]
fn a_slow_sink_loses_summaries() {
    let built = with_summaries(2);
    let clip = RasterClip::new(&built, &flat_script());
    let trace = RasterDriver::new(&built, SUMMARY_LOSING_SINK).run(&clip.stimuli(), 300, i64::MAX);
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
    let clip = RasterClip::new(&built, &script());
    let lost = |sink| {
        let traffic = RasterTraffic { sink, ..SLOW_SINK };
        let trace = RasterDriver::new(&built, traffic).run(&clip.stimuli(), 300, i64::MAX);
        trace.shown.last().unwrap().lost_count
    };
    assert_eq!(lost(SinkPattern::Percent(100)), 0);
    assert!(lost(SinkPattern::Percent(45)) > 20, "{}", lost(SinkPattern::Percent(45)));
    assert!(lost(SinkPattern::Percent(0)) > lost(SinkPattern::Percent(45)));

    let mut small = built.clone();
    small.base.height = 7;
    let clocks = |recipe: &RasterParameters, sink| {
        let clip = RasterClip::new(recipe, &script());
        let traffic = RasterTraffic { sink, ..RasterTraffic::DENSE };
        let trace = RasterDriver::new(recipe, traffic).run(&clip.stimuli(), 0, i64::MAX);
        (trace.shown.last().unwrap().lost, trace.end())
    };
    let (lost, slow) = clocks(&small, SinkPattern::Percent(20));
    assert!(!lost && slow > clocks(&small, SinkPattern::Percent(100)).1);
}
