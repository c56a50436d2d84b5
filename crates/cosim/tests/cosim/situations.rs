// SPDX-License-Identifier: MIT OR Apache-2.0
//! The situations that vectors must reach: those of co-simulation by default, for any seed, and those of the benches that come
//! with a core.

use crate::common::in_parallel;
use foveate_cosim::{Level, Occurrences, ShippedBench, Stimulus};
use foveate_design::{Config, Design};
use foveate_emit::{Prefix, Top};
use std::sync::atomic::AtomicBool;

/// A small frame, so that arrays are whole.
const FRAME: &str = "frame={width=32,height=24}";
const RASTER: &str = "hardware.organization='raster'";
const SERIAL: &str = "hardware.organization='serial'";
const MEAN: &str = "render.irrelevant='mean'";
const SENT: &str = "temporal.reference='last-sent'";

/// Designs of all organizations, with and without a periphery, references of both kinds, every store, marks of frames.
const DESIGNS: &[&[&str]] = &[
    &[FRAME],
    &[FRAME, SENT, "hardware.sync=true"],
    &[FRAME, MEAN, SENT],
    &[
        FRAME,
        MEAN,
        "periphery.blocks=4",
        "region.neighborhood='shared'",
        "hardware.pipelining='deep'",
    ],
    &[FRAME, MEAN, "spatial=[{feature='mad'}]", SENT],
    &[FRAME, MEAN, "hardware.thresholds='constant'"],
    &[FRAME, SERIAL, "hardware.fold=2"],
    &[FRAME, SERIAL, "hardware.fold=4", MEAN, SENT, "hardware.sync=true"],
    &[
        FRAME,
        SERIAL,
        "hardware.feed='raster'",
        MEAN,
        "periphery.blocks=2",
        "spatial=[{feature='variance'}]",
    ],
    &[FRAME, SERIAL, SENT, "hardware.thresholds='constant'"],
    &[FRAME, RASTER],
    &[FRAME, RASTER, SENT, "hardware.sync=true"],
    &[FRAME, RASTER, MEAN, "periphery.blocks=2"],
    &[FRAME, RASTER, MEAN, SENT],
    &[
        "frame={width=48,height=48}",
        RASTER,
        MEAN,
        SENT,
        "periphery.blocks=2",
        "hardware.pixels_per_clock=2",
    ],
    &[FRAME, RASTER, "hardware.store='external'"],
    &[FRAME, RASTER, MEAN, "hardware.store='external'", "spatial=[{feature='mad'}]"],
    &[FRAME, RASTER, "hardware.forward=false"],
    &[FRAME, RASTER, MEAN, "hardware.thresholds='constant'"],
];

fn design(keys: &[&str]) -> Design {
    let config =
        Config::from_toml_with("", keys).unwrap_or_else(|error| panic!("{keys:?}: {error}"));
    config.validate().unwrap_or_else(|error| panic!("{keys:?}: {error}"))
}

/// Of the levels at which a core is simulated by default.
fn reached(design: &Design, seed: u64) -> Occurrences {
    let levels: Vec<Level> = ShippedBench::levels(design).unwrap();
    let levels = levels.into_iter().chain([Level::sample(design)]);
    let recordings: Vec<_> = levels
        .map(|level| {
            let stimulus = Stimulus { level, seed, rounds: 1, ..Stimulus::default() };
            stimulus.record(design, &mut |_, _| {}).unwrap()
        })
        .collect();
    Occurrences::of_all(recordings.iter().map(|recording| recording.situations()))
}

#[test]
fn vectors_reach_every_situation_that_a_design_can_have() {
    let seeds = [1, 2, 1_000_003];
    let all: Vec<(&[&str], u64)> =
        DESIGNS.iter().flat_map(|&keys| seeds.map(|seed| (keys, seed))).collect();
    let failures = in_parallel(&all, |&(keys, seed)| {
        let found = reached(&design(keys), seed);
        match found.missing().is_empty() && !found.0.is_empty() {
            true => Ok(()),
            false => Err(format!("{keys:?}, seed {seed}: {found}")),
        }
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
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

/// The page on verification has the list.
#[test]
fn the_page_names_every_situation() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/verification.md");
    let page = std::fs::read_to_string(page).unwrap();
    for keys in DESIGNS {
        let design = design(keys);
        let recording = Stimulus {
            level: Level::sample(&design),
            rounds: 1,
            enough: Some(1),
            ..Stimulus::default()
        };
        let recording = recording.record(&design, &mut |_, _| {}).unwrap();
        for occurrence in &recording.situations().0 {
            assert!(page.contains(&occurrence.situation), "{} is not there", occurrence.situation);
        }
    }
}
