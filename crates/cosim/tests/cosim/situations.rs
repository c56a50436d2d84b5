// SPDX-License-Identifier: MIT OR Apache-2.0
//! The situations that vectors must reach: those of the default co-simulation, for any seed, and
//! those of the benches of a core.

use crate::common::in_parallel;
use foveate_cosim::{CosimLevel, Occurrences, ShippedBench, Stimulus};
use foveate_design::{Design, DesignConfig};
use foveate_emit::{Prefix, Top};
use foveate_tools::testing::{sample, takes_whole_lists};
use std::sync::atomic::AtomicBool;

/// A frame so small that arrays are simulated whole.
const FRAME: &str = "frame={width=32,height=24}";
const RASTER: &str = "hardware.organization='raster'";
const SERIAL: &str = "hardware.organization='serial'";
const MEAN: &str = "render.irrelevant='mean'";
const LAST_SENT: &str = "temporal.reference='last-sent'";

/// Designs of all organizations, with and without a periphery, with both kinds of references, every
/// store, and start marks of frames.
const DESIGNS: &[&[&str]] = &[
    &[FRAME],
    &[FRAME, LAST_SENT, "hardware.sync=true"],
    &[FRAME, MEAN, LAST_SENT],
    &[
        FRAME,
        MEAN,
        "periphery.blocks=4",
        "region.neighborhood='shared'",
        "hardware.pipelining='deep'",
    ],
    &[FRAME, MEAN, "spatial=[{feature='mad'}]", LAST_SENT],
    &[FRAME, MEAN, "hardware.thresholds='constant'"],
    &[FRAME, SERIAL, "hardware.fold=2"],
    // The last slot of the second lane carries no region.
    &["frame={width=12,height=4}", "region.size=4", SERIAL, "hardware.fold=2", MEAN],
    &[FRAME, SERIAL, "hardware.fold=4", MEAN, LAST_SENT, "hardware.sync=true"],
    &[
        FRAME,
        SERIAL,
        "hardware.feed='raster'",
        MEAN,
        "periphery.blocks=2",
        "spatial=[{feature='variance'}]",
    ],
    &[FRAME, SERIAL, LAST_SENT, "hardware.thresholds='constant'"],
    &[FRAME, SERIAL, "spatial=[{feature='flow'}]"],
    &[FRAME, SERIAL, MEAN, "spatial=[{feature='flow',radius=2}]"],
    &[FRAME, SERIAL, LAST_SENT, MEAN, "spatial=[{feature='edge'},{feature='flow',radius=3}]"],
    &[FRAME, RASTER],
    &[FRAME, RASTER, LAST_SENT, "hardware.sync=true"],
    &[FRAME, RASTER, MEAN, "periphery.blocks=2"],
    &[FRAME, RASTER, MEAN, LAST_SENT],
    &[
        "frame={width=48,height=48}",
        RASTER,
        MEAN,
        LAST_SENT,
        "periphery.blocks=2",
        "hardware.pixels_per_clock=2",
    ],
    &[FRAME, RASTER, "hardware.store='external'"],
    &[FRAME, RASTER, MEAN, "hardware.store='external'", "spatial=[{feature='mad'}]"],
    &[FRAME, RASTER, MEAN, "spatial=[{feature='segment'}]", "denoise.filter='switching3x3'"],
    &[FRAME, RASTER, "spatial=[{feature='surface'}]", "denoise.filter='binomial3x3'"],
    &[FRAME, RASTER, "hardware.forward=false"],
    &[FRAME, RASTER, MEAN, "hardware.thresholds='constant'"],
];

fn design(keys: &[&str]) -> Design {
    let config =
        DesignConfig::from_toml_with("", keys).unwrap_or_else(|error| panic!("{keys:?}: {error}"));
    config.validate().unwrap_or_else(|error| panic!("{keys:?}: {error}"))
}

/// Returns the situations that occur at the levels at which a core is simulated by default.
fn reached_situations(design: &Design, seed: u64) -> Occurrences {
    let levels: Vec<CosimLevel> = ShippedBench::levels(design).unwrap();
    let levels = levels.into_iter().chain([CosimLevel::small_array(design)]);
    let found: Vec<_> = levels.map(|level| recorded_situations(design, level, seed)).collect();
    Occurrences::sum_of(found.iter())
}

/// Returns the situations of one round of vectors at a level.
fn recorded_situations(design: &Design, level: CosimLevel, seed: u64) -> Occurrences {
    let stimulus = Stimulus { level, seed, rounds: 1, ..Stimulus::default() };
    stimulus.record(design, &mut |_, _| {}).unwrap().situations().clone()
}

/// Checks that the vectors of each design, with each seed, reach every situation.
fn assert_every_situation_is_reached(runs: &[(&[&str], u64)]) {
    let failures = in_parallel(runs, |&(keys, seed)| {
        let found = reached_situations(&design(keys), seed);
        match found.missing().is_empty() && !found.0.is_empty() {
            true => Ok(()),
            false => Err(format!("{keys:?}, seed {seed}: {found}")),
        }
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn vectors_reach_every_situation_that_a_design_can_have() {
    let seeds = [1, 2, 1_000_003];
    let all: Vec<(&[&str], u64)> =
        DESIGNS.iter().flat_map(|&keys| seeds.map(|seed| (keys, seed))).collect();
    // Seven has no common divisor with the number of seeds, so that they take turns.
    let all = sample(all, 7);
    assert_every_situation_is_reached(&all);
}

/// Frames of one region, whose situations no neighbor brings about.
const SINGLE_REGIONS: &[&[&str]] = &[
    &["spatial=[{feature='edge',level=9,min_score=2}]", "temporal.min_count=2", LAST_SENT],
    &[
        "hardware.pipelining='deep'",
        "spatial=[{feature='mad',min_score=4},{feature='variance',min_score=30},{feature='range',min_score=9}]",
        "temporal={level=2,min_count=2,reference='last-sent'}",
    ],
    &["denoise.filter='none'", MEAN, "spatial=[{feature='range',min_score=9}]"],
    &["hardware.pipelining='deep'", MEAN, LAST_SENT, "render.payload='raw'"],
];

#[test]
fn vectors_of_a_single_region_reach_every_situation() {
    let all: Vec<(&[&str], u64)> =
        SINGLE_REGIONS.iter().flat_map(|&keys| (1..=24).map(move |seed| (keys, seed))).collect();
    let failures = in_parallel(&all, |&(keys, seed)| {
        let frame = ["frame={width=3,height=3,pixel_bits=6}", "region.size=3"];
        let design = design(&[&frame, keys].concat());
        let found = recorded_situations(&design, CosimLevel::small_array(&design), seed);
        match found.missing().is_empty() && !found.0.is_empty() {
            true => Ok(()),
            false => Err(format!("{keys:?}, seed {seed}: {found}")),
        }
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// Designs whose constant thresholds few pictures meet: noise with corners behind a median filter
/// in regions of 4x4 pixels, and means of one bit.
const SELDOM_RELEVANT: &[&[&str]] = &[
    &[
        "frame={width=12,height=4,pixel_bits=4}",
        "region={size=4,neighborhood='shared'}",
        "spatial=[{feature='variance'},{feature='corner'}]",
        "decision.combine='all'",
        "hardware={organization='serial',fold=3,thresholds='constant'}",
    ],
    &[
        "frame={width=30,height=20,pixel_bits=1}",
        "region={size=16,neighborhood='shared'}",
        MEAN,
        "hardware={organization='serial',fold=3,thresholds='constant'}",
    ],
];

#[test]
fn vectors_that_are_seldom_relevant_reach_every_situation() {
    let all: Vec<(&[&str], u64)> =
        SELDOM_RELEVANT.iter().flat_map(|&keys| (1..=6).map(move |seed| (keys, seed))).collect();
    assert_every_situation_is_reached(&sample(all, 7));
}

/// Keys with their values, for designs drawn at random. A value that is empty leaves a key at its
/// default.
const CHOICES: &[&[&str]] = &[
    &["frame={width=12,height=4}", "frame={width=30,height=20}", "frame={width=17,height=33}"],
    &["region.size=2", "region.size=4", "region.size=8", "region.size=16"],
    &["frame.pixel_bits=1", "frame.pixel_bits=4", "frame.pixel_bits=8", "frame.pixel_bits=12"],
    &["denoise.filter='none'", "denoise.filter='median3x3'"],
    &["region.neighborhood='isolated'", "region.neighborhood='shared'"],
    &[
        "",
        "spatial=[{feature='mad'}]",
        "spatial=[{feature='variance'},{feature='corner'}]",
        "spatial=[{feature='range'}]",
        "spatial=[{feature='flow'}]",
        "spatial=[{feature='edge'},{feature='flow',radius=3}]",
    ],
    &["", "decision.combine='all'"],
    &["", LAST_SENT],
    &["render.irrelevant='zero'", "render.irrelevant='hold'", MEAN, MEAN],
    &["", "render.payload='raw'"],
    &["", "periphery.blocks=2", "periphery.level=0", "periphery.level=3"],
    &["", SERIAL, "hardware={organization='serial',feed='raster'}", RASTER, RASTER],
    &["", "hardware.fold=2", "hardware.fold=3", "hardware.pixels_per_clock=2"],
    &["", "hardware.store='external'", "hardware.forward=false", "hardware.pipelining='deep'"],
    &["", "", "hardware.thresholds='constant'"],
    &["", "hardware.sync=true"],
];

/// No region of 1-bit pixels has both scores that these constants ask for.
const UNREACHABLE: [&str; 3] =
    ["frame.pixel_bits=1", "decision.combine='all'", "hardware.thresholds='constant'"];

/// Designs drawn at random from all choices, without those that are refused.
fn drawn_designs(count: usize) -> Vec<(Vec<&'static str>, Design)> {
    let mut state = 0x9e37_79b9_u32;
    let mut draw = |choices: &[&'static str]| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        choices[(state >> 16) as usize % choices.len()]
    };
    let mut designs = Vec::new();
    while designs.len() < count {
        let mut keys: Vec<_> = CHOICES.iter().map(|choices| draw(choices)).collect();
        keys.retain(|key| !key.is_empty());
        if UNREACHABLE.iter().all(|key| keys.contains(key)) {
            continue;
        }
        if let Ok(design) =
            DesignConfig::from_toml_with("", &keys).and_then(|config| config.validate())
        {
            designs.push((keys, design));
        }
    }
    designs
}

/// With `FOVEATE_WHOLE` more designs are drawn.
#[test]
fn vectors_reach_every_situation_of_designs_drawn_at_random() {
    let count = if takes_whole_lists() { 1000 } else { 6 };
    let failures = in_parallel(&drawn_designs(count), |(keys, design)| {
        let found = reached_situations(design, 1);
        match found.missing().is_empty() && !found.0.is_empty() {
            true => Ok(()),
            false => Err(format!("{keys:?}: {found}")),
        }
    });
    assert!(failures.is_empty(), "{} of {count} failed:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn shipped_benches_reach_every_situation_that_a_design_can_have() {
    let failures = in_parallel(DESIGNS, |keys| {
        let design = design(keys);
        for &top in Top::all_of(&design) {
            let bench =
                ShippedBench::new(&design, top, &Prefix::default(), &AtomicBool::new(false))
                    .unwrap();
            let found = bench.tally.situations;
            if !found.missing().is_empty() || found.0.is_empty() {
                return Err(format!("{keys:?}, {top:?}: {found}"));
            }
        }
        Ok(())
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// The verification page lists every situation.
#[test]
fn the_page_names_every_situation() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/verification.md");
    let page = std::fs::read_to_string(page).unwrap();
    for keys in DESIGNS {
        let design = design(keys);
        let recording = Stimulus {
            level: CosimLevel::small_array(&design),
            rounds: 1,
            sufficient_clocks: Some(1),
            ..Stimulus::default()
        };
        let recording = recording.record(&design, &mut |_, _| {}).unwrap();
        for occurrence in &recording.situations().0 {
            assert!(page.contains(&occurrence.situation), "{} is not there", occurrence.situation);
        }
    }
}
