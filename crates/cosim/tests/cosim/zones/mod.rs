// SPDX-License-Identifier: MIT OR Apache-2.0
//! Model against emitted RTL of designs with zones: classes change at random, between frames and
//! during them, and all thresholds are aimed at the data.

mod pipelined;
mod raster;
mod serial;

use crate::common::{
    check_agreement, config_name, design, directed_stimulus, has_simulators, in_parallel,
};
use foveate_cosim::{CosimLevel, Simulator};
use foveate_design::DesignConfig;
use foveate_tools::testing::sample;

pub(super) struct ZonedDesign {
    purpose: &'static str,
    /// The columns and rows of its regions.
    grid: (u32, u32),
    /// Its configuration. The table `[zones]` may be left out.
    toml: &'static str,
}

/// Checks that the model and the RTL of each design agree, the lone unit and the whole core. Most
/// runs take a seventh of both.
fn check_designs(designs: &[ZonedDesign], simulator: Simulator) {
    if !has_simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let runs = designs.iter().flat_map(|run| {
        let (columns, rows) = run.grid;
        [(run, CosimLevel::Rpu), (run, CosimLevel::Rcm { columns, rows })]
    });
    // Seven is odd, so lone units and whole cores take turns.
    let runs = sample(runs, 7);
    let failures = in_parallel(&runs, |&(run, level)| {
        let config = zoned_config(run.toml);
        let name = format!("{}, {level:?}: {}", run.purpose, config_name(&config));
        let design = design(&config, run.grid);
        let folder = output.path().join(format!("{level:?}-{}", design.fingerprint()));
        check_agreement(&name, &design, simulator, directed_stimulus(level, 1), &folder)
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

fn zoned_config(toml: &str) -> DesignConfig {
    let mut config = DesignConfig::from_toml(toml).unwrap();
    config.camera.zones.get_or_insert_default();
    config
}
