// SPDX-License-Identifier: MIT OR Apache-2.0
//! Model against emitted RTL at RPU level: every feature x region size x filter x neighborhood x
//! reference, with the other keys sampled along the way, and what lies beyond at the edges.

use crate::common::{agrees, design, directed, feature, in_parallel, name, simulators};
use foveate_cosim::{Level, Simulator};
use foveate_design::{
    CameraConfig, Combine, Config, Decimal, FeatureKind, Filter, Irrelevant, Neighborhood, Payload,
    Pipelining, Reference, Thresholds,
};

/// From this many pixels per region on, the time to build with Verilator is won back.
const COMPILED_FROM: u32 = 16 * 16;

fn simulator(config: &Config) -> Simulator {
    if config.camera.region.size * config.camera.region.size >= COMPILED_FROM {
        Simulator::Verilator
    } else {
        Simulator::Iverilog
    }
}

fn check_all(configs: &[Config]) {
    if !simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let failures = in_parallel(configs, |config| {
        let (name, design) = (name(config), design(config, (1, 1)));
        let folder = output.path().join(design.fingerprint());
        let stimulus = directed(Level::Rpu, 1);
        agrees(&name, &design, simulator(config), stimulus, &folder)
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// Plain and deep in turns that have no period with those of the other keys.
fn pipelining(turn: usize) -> Pipelining {
    Pipelining::ALL[turn.count_ones() as usize % 2]
}

/// The 160 designs. Keys that are not among the five axes take turns.
fn matrix() -> Vec<Config> {
    let mut configs = Vec::new();
    for &kind in FeatureKind::ALL {
        for size in [4, 5, 8, 16, 32] {
            for &filter in Filter::ALL {
                for &neighborhood in Neighborhood::ALL {
                    for &reference in Reference::ALL {
                        let turn = configs.len();
                        let fraction = u32::try_from(turn / 4 % 5).unwrap();
                        let mut config = Config::from(CameraConfig {
                            spatial: vec![feature(kind, fraction)],
                            ..CameraConfig::default()
                        });
                        config.camera.region.size = size;
                        config.camera.region.neighborhood = neighborhood;
                        config.camera.denoise.filter = filter;
                        config.camera.temporal.reference = reference;
                        config.camera.render.irrelevant = Irrelevant::ALL[turn / 2 % 2];
                        config.camera.render.payload = Payload::ALL[turn / 3 % 2];
                        config.hardware.pipelining = Some(pipelining(turn));
                        configs.push(config);
                    }
                }
            }
        }
    }
    configs
}

#[test]
fn every_feature_size_filter_neighborhood_and_reference_agrees() {
    let configs = matrix();
    assert_eq!(configs.len(), 160);
    check_all(&configs);
}

/// Several features, other depths, other sizes, built-in thresholds.
#[test]
fn what_the_matrix_leaves_out_agrees() {
    use FeatureKind::{Corner, Edge, Mad, Variance};
    let sets: [&[FeatureKind]; 5] = [
        &[Edge, Corner],
        &[Mad, Edge],
        &[Variance, Corner, Edge],
        FeatureKind::ALL,
        &[Mad, Variance],
    ];
    let mut configs = Vec::new();
    for (turn, kinds) in sets.iter().enumerate() {
        for &combine in Combine::ALL {
            let spatial = kinds.iter().map(|&kind| feature(kind, 2)).collect();
            let mut config = Config::from(CameraConfig { spatial, ..CameraConfig::default() });
            config.camera.region.size = [8, 5, 4][turn % 3];
            config.camera.region.neighborhood = Neighborhood::ALL[turn % 2];
            config.camera.decision.combine = combine;
            config.camera.temporal.reference = Reference::ALL[(turn + 1) % 2];
            config.camera.render.payload = Payload::ALL[turn / 2 % 2];
            configs.push(config);
        }
    }
    for (turn, bits) in [1, 10, 12, 16, 1, 16].into_iter().enumerate() {
        let mut config = Config::default();
        config.camera.frame.pixel_bits = bits;
        let kinds = [[Edge, Mad], [Corner, Variance]][turn % 2];
        config.camera.spatial = kinds.map(|kind| feature(kind, 4)).to_vec();
        for spatial in &mut config.camera.spatial {
            spatial.level = matches!(spatial.feature, Edge | Corner).then_some(1);
            spatial.min_score = Some(Decimal::whole(0));
        }
        config.camera.temporal.level = Some(u32::from(bits > 1));
        config.camera.region.neighborhood = Neighborhood::ALL[turn / 2 % 2];
        config.camera.temporal.reference = Reference::ALL[turn % 2];
        configs.push(config);
    }
    for (turn, size) in [2, 3, 7, 2, 3, 7, 2, 64, 64].into_iter().enumerate() {
        let spatial = vec![feature([Edge, Mad, Corner, Variance][turn % 4], size % 3)];
        let mut config = Config::from(CameraConfig { spatial, ..CameraConfig::default() });
        config.camera.region.size = size;
        config.camera.spatial[0].min_score = Some(Decimal::whole(2));
        config.camera.temporal.min_count = 2;
        config.camera.region.neighborhood = Neighborhood::ALL[turn / 3 % 2];
        config.camera.temporal.reference = Reference::ALL[turn % 2];
        config.camera.render.payload = Payload::ALL[turn / 2 % 2];
        configs.push(config);
    }
    for (turn, &kind) in FeatureKind::ALL.iter().cycle().take(8).enumerate() {
        let mut config = Config::from(CameraConfig {
            spatial: vec![feature(kind, 3)],
            ..CameraConfig::default()
        });
        config.hardware.thresholds = Thresholds::Constant;
        config.camera.region.size = [4, 5][turn / 4];
        config.camera.denoise.filter = Filter::ALL[turn % 2];
        config.camera.temporal.reference = Reference::ALL[turn / 2 % 2];
        configs.push(config);
    }
    for (turn, config) in configs.iter_mut().enumerate() {
        config.hardware.pipelining = Some(pipelining(turn));
    }
    check_all(&configs);
}
