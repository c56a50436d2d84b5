// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cores on AXI: their packets and registers against the model.

pub(crate) mod faults;

use crate::common::in_parallel;
use faults::{BusFault, FAULTS, ZONED};
use foveate_cosim::{BusJob, CosimReport};
use foveate_design::{Design, DesignConfig};
use foveate_tools::{
    Cache, Tool, Toolchain,
    testing::{require_tools, sample, takes_whole_lists},
};
use std::collections::BTreeSet;
use std::path::Path;

/// Designs in small frames: words of one pixel and of several, lanes of 8 and of 16 bits, pixels,
/// means and raw pixels, all stores, and thresholds as ports and as constants. The last two are a
/// core whose regions have an odd number of values, in parts of several values, and whose rows do
/// not fill a word, and a core whose regions come faster than their places are known.
pub(crate) const DESIGNS: &[&[&str]] = &[
    &["frame={width=64,height=48}"],
    &["frame={width=70,height=45}", "render.irrelevant='mean'", "hardware.sync=true"],
    &[
        "frame={width=101,height=50}",
        "temporal.reference='last-sent'",
        "hardware.pixels_per_clock=2",
        "hardware.pipelining='deep'",
    ],
    &[
        "frame={width=83,height=33,pixel_bits=12}",
        "region.size=5",
        "render.payload='raw'",
        "spatial=[{feature='variance'}]",
    ],
    &[
        "frame={width=130,height=40,pixel_bits=10}",
        "region.size=4",
        "spatial=[{feature='mad'},{feature='edge'}]",
        "render.irrelevant='hold'",
        "hardware.pixels_per_clock=4",
    ],
    &[
        "frame={width=72,height=33}",
        "region.size=4",
        "spatial=[{feature='mad'}]",
        "hardware.store='external'",
    ],
    &[
        "frame={width=40,height=33}",
        "region.size=5",
        "spatial=[{feature='surface'},{feature='segment',mean_fraction_bits=1}]",
        "denoise.filter='binomial3x3'",
        "hardware.pipelining='deep'",
    ],
    &[
        "frame={width=48,height=36}",
        "region.size=6",
        "hardware.thresholds='constant'",
        "hardware.store='single-port'",
    ],
    &[
        "frame={width=96,height=24,pixel_bits=16}",
        "render={irrelevant='mean',payload='raw'}",
        "periphery.blocks=4",
        "hardware.pixels_per_clock=2",
    ],
    &[
        "frame={width=63,height=24}",
        "region.size=5",
        "denoise.filter='none'",
        "spatial=[{feature='variance'}]",
        "hardware.thresholds='constant'",
    ],
    &[
        "frame={width=64,height=132}",
        "region.size=4",
        "denoise.filter='none'",
        "spatial=[{feature='variance'}]",
        "hardware.pixels_per_clock=4",
    ],
    ZONED,
    &[
        "frame={width=80,height=40}",
        "region.size=4",
        "denoise.filter='none'",
        "spatial=[{feature='segment',min_score=2},{feature='edge'}]",
        "temporal.reference='last-sent'",
        "hardware.pipelining='deep'",
        "zones={areas=[{class='off',rectangle=[0,0,80,8]}],keen={temporal={level=1},spatial=[{feature='edge',level=9}]}}",
    ],
];

pub(crate) fn axi_design(keys: &[&str]) -> Design {
    let raster = DesignConfig::from_toml_with("", &["hardware.organization='raster'"]).unwrap();
    let config = DesignConfig::from_toml_with(&raster.to_toml(), keys).unwrap();
    DesignConfig::from_toml_with(&config.to_toml(), &["hardware.interface='axi'"])
        .unwrap()
        .validate()
        .unwrap_or_else(|error| panic!("{keys:?}: {error}"))
}

pub(crate) fn run_bus_job(
    design: &Design,
    output: &Path,
    edit: impl FnOnce(&mut BusJob),
) -> Result<CosimReport, String> {
    let mut job = BusJob::new(design, output).unwrap();
    edit(&mut job);
    let cache = Cache::from_env().unwrap();
    job.run(&Toolchain::system(), &cache, &mut |_| {}).map_err(|error| error.to_string())
}

/// Runs the scenes of each design with its seed, and returns the runs that differ from the model or
/// miss a situation.
fn failing_runs(runs: &[(&[&str], u64)]) -> Vec<String> {
    let output = tempfile::tempdir().unwrap();
    in_parallel(runs, |&(keys, seed)| {
        let design = axi_design(keys);
        let folder = output.path().join(format!("{} {seed}", design.fingerprint()));
        let report = run_bus_job(&design, &folder, |job| job.seed = seed)?;
        match &report.mismatch {
            None if report.passed() && report.situations.missing().is_empty() => Ok(()),
            found => Err(format!("{keys:?}, {seed}: {report}: {found:?}, {}", report.situations)),
        }
    })
}

#[test]
fn packets_and_registers_of_cores_on_axi_are_those_of_the_model() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let runs = sample(DESIGNS.iter().map(|&keys| (keys, 1)), 12);
    let failures = failing_runs(&runs);
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// The scene in which two rows wait is not late for a core with a second pass, whose decisions come
/// a row of regions later, and not for small regions or for a frame that ends before it.
#[test]
fn no_row_is_dropped_before_two_wait() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let runs: [(&[&str], u64); 4] = [
        (
            &[
                "frame={width=60,height=32}",
                "region.size=4",
                "spatial=[{feature='mad'}]",
                "hardware.pipelining='deep'",
            ],
            1,
        ),
        (&["frame={width=60,height=33}", "region.size=5", "spatial=[{feature='mad'}]"], 1),
        (
            &[
                "frame={width=24,height=16}",
                "region.size=3",
                "spatial=[{feature='edge'}]",
                "denoise.filter='binomial3x3'",
                "render.irrelevant='mean'",
                "hardware.thresholds='constant'",
                "hardware.sync=true",
            ],
            719_831,
        ),
        (
            &[
                "frame={width=30,height=10}",
                "region.size=3",
                "spatial=[{feature='mad'},{feature='corner'}]",
                "denoise.filter='binomial3x3'",
                "render.irrelevant='mean'",
                "hardware.thresholds='constant'",
            ],
            516_268,
        ),
    ];
    let failures = failing_runs(&sample(runs, 4));
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// Every fault is found at the port of the check that it proves. Most runs plant the first fault of
/// each port.
#[test]
fn every_kind_of_check_of_the_buses_finds_its_planted_fault() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let mut ports = BTreeSet::new();
    let numbered: Vec<(usize, &BusFault)> = FAULTS
        .iter()
        .enumerate()
        .filter(|(_, fault)| ports.insert(fault.port) || takes_whole_lists())
        .collect();
    let failures = in_parallel(&numbered, |(number, fault)| {
        let BusFault { check, port, design, module, from, to } = fault;
        let path = format!("rtl/{module}.v");
        let mut found = 0;
        let folder = output.path().join(number.to_string());
        let report = run_bus_job(&axi_design(design), &folder, |job| {
            for file in job.sources.iter_mut().filter(|file| file.path == path) {
                found = file.contents.matches(from).count();
                file.contents = file.contents.replace(from, to);
            }
        });
        let named = |problem: String| Err(format!("{module}, {check}: {problem}"));
        match report {
            _ if found != 1 => named(format!("`{from}` is there {found} times")),
            Err(error) => named(error),
            Ok(report) => match &report.mismatch {
                Some(mismatch) if mismatch.port == *port => Ok(()),
                Some(mismatch) => named(format!("{port} does not differ first: {mismatch}")),
                None => named("not caught".to_owned()),
            },
        }
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// The unchanged cores pass, or the tests above would show nothing.
#[test]
fn the_designs_of_the_bus_faults_pass_without_a_fault() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let designs = [faults::SMALL, faults::MEANS, faults::LAST_SENT, ZONED];
    let failures = failing_runs(&sample(designs.map(|design| (design, 1)), 4));
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Frames that a filter smooths have few corners, few regions fill the places for packets, and
/// frames of one or two lines have no other line. All of them reach their situations nevertheless.
#[test]
fn smooth_and_small_frames_reach_the_situations_of_cores_on_axi() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let corner = "spatial=[{feature='corner'}]";
    let binomial = "denoise.filter='binomial3x3'";
    let runs: [(&[&str], u64); 6] = [
        (
            &[
                "frame={width=66,height=10,pixel_bits=4}",
                "region.size=4",
                corner,
                binomial,
                "hardware.thresholds='constant'",
                "hardware.pixels_per_clock=4",
            ],
            512_537,
        ),
        (
            &[
                "frame={width=33,height=14,pixel_bits=10}",
                "region.size=3",
                corner,
                binomial,
                "temporal.reference='last-sent'",
            ],
            872_788,
        ),
        (&["frame={width=16,height=8}", "region.size=5", "spatial=[{feature='mad'}]"], 985_551),
        (&["frame={width=29,height=2}", "region.size=3"], 702_978),
        (
            &[
                "frame={width=53,height=2,pixel_bits=4}",
                "region.size=8",
                "spatial=[{feature='mad'}]",
                "temporal.reference='last-sent'",
            ],
            502_061,
        ),
        (&["frame={width=51,height=1}", "region.size=4", binomial], 436_397),
    ];
    let failures = failing_runs(&sample(runs, 6));
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// The situations are reached with every seed, and not only with a lucky one.
#[test]
fn every_seed_reaches_the_situations_of_cores_on_axi() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let seeds: Vec<(&[&str], u64)> = [faults::SMALL, faults::MEANS, faults::LAST_SENT, ZONED]
        .into_iter()
        .flat_map(|keys| (2..6).map(move |seed| (keys, seed * 1_000_003)))
        .collect();
    let failures = failing_runs(&sample(seeds, 16));
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
