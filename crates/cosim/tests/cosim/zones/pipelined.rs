// SPDX-License-Identifier: MIT OR Apache-2.0
//! Model against emitted RTL of pipelined designs with zones: the class of every region changes at
//! random, between frames and during them, and all thresholds are aimed at the data.

use crate::common::{
    check_agreement, config_name, design, directed_stimulus, has_simulators, in_parallel,
};
use foveate_cosim::{CosimLevel, Simulator};
use foveate_design::DesignConfig;

/// Designs with zones, each with its purpose: the registers through which the class travels differ
/// between plain and deep, with and without windows, and with and without a second pass.
const DESIGNS: [(&str, &str); 12] = [
    ("a median and edges", "region.size = 4\n"),
    (
        "no window at all",
        "region.size = 3\ndenoise.filter = 'none'\nspatial = [{ feature = 'variance' }]\n",
    ),
    (
        "no window, and no register in front of the tail",
        "region.size = 2\nspatial = [{ feature = 'edge', level = 9, min_score = 2 }]\ntemporal.min_count = 2\n\
         region.neighborhood = 'shared'\ndenoise.filter = 'none'\n",
    ),
    (
        "two windows, shared",
        "region.size = 4\nregion.neighborhood = 'shared'\nspatial = [{ feature = 'edge' }, { feature = 'corner' }]\n\
         decision.combine = 'all'\ntemporal.reference = 'last-sent'\n",
    ),
    (
        "a second pass",
        "region.size = 4\nspatial = [{ feature = 'segment', min_score = 3 }, { feature = 'mad' }]\n",
    ),
    (
        "a second pass with last-sent",
        "region.size = 4\ndenoise.filter = 'none'\nspatial = [{ feature = 'segment', min_score = 3 }, { feature = 'edge' }]\n\
         temporal.reference = 'last-sent'\nrender = { irrelevant = 'mean', payload = 'raw' }\n",
    ),
    ("four means", "region.size = 4\nrender.irrelevant = 'mean'\nzones.off_level = 9\n"),
    (
        "one mean",
        "region.size = 5\nrender.irrelevant = 'mean'\nspatial = [{ feature = 'corner' }]\n",
    ),
    (
        "deep",
        "region.size = 4\nhardware.pipelining = 'deep'\nspatial = [{ feature = 'edge' }, { feature = 'corner' }]\n",
    ),
    (
        "deep, with a second pass and means",
        "region.size = 4\nhardware.pipelining = 'deep'\nspatial = [{ feature = 'segment', min_score = 3 }, { feature = 'range' }]\n\
         temporal.reference = 'last-sent'\nrender.irrelevant = 'mean'\nregion.neighborhood = 'shared'\n",
    ),
    (
        "constant thresholds",
        "region.size = 4\nhardware.thresholds = 'constant'\nspatial = [{ feature = 'edge', level = 300, min_score = 4 }]\n\
         render.irrelevant = 'mean'\nzones = { off_level = 40, keen = { spatial = [{ feature = 'edge', level = 60, min_score = 2 }], \
         temporal = { level = 2, min_count = 1 }, periphery = { level = 1 } } }\n",
    ),
    (
        "constant thresholds, deep, with a second pass",
        "region.size = 4\nhardware = { thresholds = 'constant', pipelining = 'deep' }\n\
         spatial = [{ feature = 'segment', level = 40, min_score = 4 }]\nzones = { keen = { temporal = { level = 1 }, \
         spatial = [{ feature = 'segment', level = 3, min_score = 1 }] } }\n",
    ),
];

fn config(toml: &str) -> DesignConfig {
    let mut config = DesignConfig::from_toml(toml).unwrap();
    config.camera.zones.get_or_insert_default();
    config
}

#[test]
fn designs_with_zones_agree() {
    if !has_simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let runs: Vec<_> = DESIGNS
        .iter()
        .flat_map(|run| {
            [(run, CosimLevel::Rpu, (1, 1)), (run, CosimLevel::Rcm { columns: 3, rows: 2 }, (3, 2))]
        })
        .collect();
    let failures = in_parallel(&runs, |&(&(purpose, toml), level, grid)| {
        let config = config(toml);
        let name = format!("{purpose}, {level:?}: {}", config_name(&config));
        let design = design(&config, grid);
        let folder = output.path().join(format!("{level:?}-{}", design.fingerprint()));
        check_agreement(&name, &design, Simulator::Iverilog, directed_stimulus(level, 1), &folder)
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}
