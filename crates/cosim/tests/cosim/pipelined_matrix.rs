// SPDX-License-Identifier: MIT OR Apache-2.0
//! Model against emitted RTL at RPU level: every feature x region size x filter x neighborhood x
//! reference, with the other keys sampled, and extreme cases outside the matrix.

use crate::common::{
    check_agreement, config_name, design, directed_stimulus, feature, feature_sets, has_simulators,
    in_parallel, in_turn,
};
use foveate_camera::{
    CameraConfig, Decimal, DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, Payload,
    ReferencePolicy, VoteCombination,
};
use foveate_cosim::{CosimLevel, Simulator};
use foveate_design::{DesignConfig, Organization, Pipelining, ThresholdSource};
use foveate_tools::testing::{cover, sample};

/// The number of pixels per region from which on Verilator's build takes less time than it saves.
const COMPILED_FROM: u32 = 16 * 16;

fn simulator(config: &DesignConfig) -> Simulator {
    if config.camera.region.size * config.camera.region.size >= COMPILED_FROM {
        Simulator::Verilator
    } else {
        Simulator::Iverilog
    }
}

fn check_all(configs: &[DesignConfig]) {
    if !has_simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let failures = in_parallel(configs, |config| {
        let (name, design) = (config_name(config), design(config, (1, 1)));
        let folder = output.path().join(design.fingerprint());
        let stimulus = directed_stimulus(CosimLevel::Rpu, 1);
        check_agreement(&name, &design, simulator(config), stimulus, &folder)
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// Returns plain or deep, in an order without a common period with those of the other keys.
fn pipelining_in_turn(turn: usize) -> Pipelining {
    in_turn(Pipelining::ALL, turn.count_ones() as usize)
}

/// Sets the irrelevant action in turn and, for `mean`, the number of blocks and the level.
fn set_irrelevant_in_turn(camera: &mut CameraConfig, turn: usize) {
    camera.render.irrelevant = IrrelevantRendering::ALL[turn % IrrelevantRendering::ALL.len()];
    let fits = |blocks: &u32| camera.region.size.is_multiple_of(*blocks);
    let blocks: Vec<_> = [1, 2, 4].into_iter().filter(fits).collect();
    let turn = turn / IrrelevantRendering::ALL.len();
    match camera.render.irrelevant {
        IrrelevantRendering::Zero | IrrelevantRendering::Hold => {}
        IrrelevantRendering::Mean => {
            camera.periphery.blocks = Some(blocks[turn % blocks.len()]);
            camera.periphery.level = [None, Some(0), Some(1)][turn / 2 % 3];
        }
    }
}

/// Returns the designs of five axes. Keys outside them take turns.
fn matrix() -> Vec<DesignConfig> {
    let mut configs = Vec::new();
    for kind in Organization::Pipelined.feature_kinds() {
        for size in [4, 5, 8, 16, 32] {
            for &filter in DenoiseFilter::ALL {
                for &neighborhood in Neighborhood::ALL {
                    for &reference in ReferencePolicy::ALL {
                        let turn = configs.len();
                        let fraction = u32::try_from(turn / 4 % 5).unwrap();
                        let mut config = DesignConfig::from(CameraConfig {
                            spatial: vec![feature(kind, fraction)],
                            ..CameraConfig::default()
                        });
                        config.camera.region.size = size;
                        config.camera.region.neighborhood = neighborhood;
                        config.camera.denoise.filter = filter;
                        config.camera.temporal.reference = reference;
                        set_irrelevant_in_turn(&mut config.camera, turn / 2);
                        config.camera.render.payload = in_turn(Payload::ALL, turn / 3);
                        config.hardware.pipelining = pipelining_in_turn(turn);
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
    check_all(&cover(matrix(), |config| design(config, (1, 1)).config().to_toml()));
}

/// Summaries agree for blocks of one pixel and of sides that are no power of two, the most blocks,
/// the most and fewest bits, raw pixels, a second pass and constant thresholds.
#[test]
fn summaries_agree() {
    let median = "filter = \"median3x3\"";
    let none = "filter = \"none\"";
    let (edge, mad) = ("feature = \"edge\"", "feature = \"mad\"");
    let mut configs = Vec::new();
    for (turn, (size, blocks, bits, filter, feature, more)) in [
        (2, 2, 8, none, edge, "min_score = 1\n[temporal]\nmin_count = 2\n"),
        (4, 4, 8, median, edge, "[temporal]\nreference = \"last-sent\"\n"),
        (2, 2, 8, none, mad, "[temporal]\nmin_count = 1\n"),
        (4, 4, 4, none, mad, "[temporal]\nlevel = 1\nmin_count = 2\n"),
        (3, 1, 8, none, edge, "[temporal]\nmin_count = 2\n"),
        (6, 2, 8, median, edge, "[region]\nneighborhood = \"shared\"\n"),
        (12, 4, 8, median, mad, "[temporal]\nreference = \"last-sent\"\n"),
        (10, 2, 8, none, edge, ""),
        (8, 4, 8, median, mad, "[region]\nneighborhood = \"shared\"\n"),
        (8, 2, 1, median, edge, "level = 1\n[temporal]\nlevel = 0\n"),
        (6, 2, 1, none, mad, "min_score = 0.1\n[temporal]\nlevel = 0\n"),
        (8, 2, 16, none, edge, "[hardware]\nthresholds = \"constant\"\n"),
        (12, 2, 16, median, mad, ""),
        (8, 2, 8, median, edge, "[hardware]\nthresholds = \"constant\"\n"),
        (6, 1, 8, none, mad, "[hardware]\nthresholds = \"constant\"\n"),
        (64, 1, 16, none, edge, ""),
    ]
    .into_iter()
    .enumerate()
    {
        let toml = format!("[[spatial]]\n{feature}\n{more}[denoise]\n{filter}\n");
        // The widest possible sums are tested once, because such regions take long.
        let all = if size == 64 { &[Pipelining::Deep] } else { Pipelining::ALL };
        for &pipelining in all {
            let mut config = DesignConfig::from_toml(&toml).unwrap();
            config.camera.frame.pixel_bits = bits;
            config.camera.region.size = size;
            config.camera.render.irrelevant = IrrelevantRendering::Mean;
            let raw = turn.is_multiple_of(2) ^ (pipelining == Pipelining::Deep);
            config.camera.render.payload = if raw { Payload::Raw } else { Payload::Denoised };
            config.camera.periphery.blocks = Some(blocks);
            config.camera.periphery.level = [None, Some(0)][turn / 2 % 2];
            config.hardware.pipelining = pipelining;
            configs.push(config);
        }
    }
    check_all(&sample(configs, 8));
}

/// Designs with several features, other depths, other sizes or constant thresholds agree.
#[test]
fn designs_outside_the_matrix_agree() {
    let sets = feature_sets(Organization::Pipelined);
    let mut configs = Vec::new();
    for (turn, kinds) in sets.iter().enumerate() {
        for &combine in VoteCombination::ALL {
            let spatial = kinds.iter().map(|&kind| feature(kind, 2)).collect();
            let mut config =
                DesignConfig::from(CameraConfig { spatial, ..CameraConfig::default() });
            config.camera.region.size = [8, 5, 4][turn % 3];
            config.camera.region.neighborhood = in_turn(Neighborhood::ALL, turn);
            config.camera.decision.combine = combine;
            config.camera.temporal.reference = in_turn(ReferencePolicy::ALL, turn + 1);
            config.camera.render.payload = in_turn(Payload::ALL, turn / 2);
            set_irrelevant_in_turn(&mut config.camera, turn + 1);
            configs.push(config);
        }
    }
    for (turn, bits) in [1, 10, 12, 16, 1, 16].into_iter().enumerate() {
        let mut config = DesignConfig::default();
        config.camera.frame.pixel_bits = bits;
        let kinds = &sets[turn % sets.len()];
        config.camera.spatial = kinds.iter().map(|&kind| feature(kind, 4)).collect();
        for spatial in &mut config.camera.spatial {
            spatial.level = spatial.feature.score_unit().is_count().then_some(1);
            spatial.min_score = Some(Decimal::from_whole(0));
        }
        config.camera.temporal.level = Some(u32::from(bits > 1));
        config.camera.region.neighborhood = in_turn(Neighborhood::ALL, turn / 2);
        config.camera.temporal.reference = in_turn(ReferencePolicy::ALL, turn);
        configs.push(config);
    }
    for (turn, size) in [2, 3, 7, 2, 3, 7, 2, 64, 64].into_iter().enumerate() {
        let spatial =
            vec![feature(in_turn(&Organization::Pipelined.feature_kinds(), turn), size % 3)];
        let mut config = DesignConfig::from(CameraConfig { spatial, ..CameraConfig::default() });
        config.camera.region.size = size;
        config.camera.spatial[0].min_score = Some(Decimal::from_whole(2));
        config.camera.temporal.min_count = 2;
        config.camera.region.neighborhood = in_turn(Neighborhood::ALL, turn / 3);
        config.camera.temporal.reference = in_turn(ReferencePolicy::ALL, turn);
        config.camera.render.payload = in_turn(Payload::ALL, turn / 2);
        set_irrelevant_in_turn(&mut config.camera, turn + turn / 3);
        configs.push(config);
    }
    let kinds = Organization::Pipelined.feature_kinds();
    for (turn, &kind) in kinds.iter().cycle().take(2 * kinds.len()).enumerate() {
        let mut config = DesignConfig::from(CameraConfig {
            spatial: vec![feature(kind, 3)],
            ..CameraConfig::default()
        });
        config.hardware.thresholds = ThresholdSource::Constant;
        config.camera.region.size = [4, 5][turn / FeatureKind::COUNT];
        config.camera.denoise.filter = in_turn(DenoiseFilter::ALL, turn);
        config.camera.temporal.reference = in_turn(ReferencePolicy::ALL, turn / 2);
        configs.push(config);
    }
    for (turn, config) in configs.iter_mut().enumerate() {
        config.hardware.pipelining = pipelining_in_turn(turn);
    }
    check_all(&sample(configs, 8));
}
