// SPDX-License-Identifier: MIT OR Apache-2.0
//! Model against emitted RTL for serial designs: one lane and small arrays. Frames take thousands
//! of clocks, so the keys are not crossed. They take turns, each with its own period.

use crate::common::serial::{serial_config, serial_config_name};
use crate::common::{
    check_agreement, design, directed_stimulus, feature, feature_sets, has_simulators, in_parallel,
    in_turn,
};
use foveate_camera::{
    Decimal, DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, Payload,
    ReferencePolicy, VoteCombination,
};
use foveate_cosim::{CosimLevel, Simulator};
use foveate_design::{
    Design, DesignConfig, LaneMemoryKind, Organization, Pipelining, PixelFeed, ThresholdSource,
};
use foveate_tools::testing::{cover, sample};

use FeatureKind::{Corner, Edge, Flow, Mad, Range, Segment, Surface, Variance};

/// A design at a level; the grid of level `rcm` is that of its frame.
struct SerialCase {
    config: DesignConfig,
    grid: (u32, u32),
    level: CosimLevel,
}

/// The work (clocks of a frame x lanes) from which on Verilator's build takes less time than it
/// saves.
const COMPILED_FROM: u64 = 1000;

impl SerialCase {
    fn lane_case(mut config: DesignConfig) -> Self {
        let fold = config.hardware.make_serial().fold;
        Self { config, grid: (fold, 1), level: CosimLevel::Rpu }
    }

    fn array_case(config: DesignConfig, (columns, rows): (u32, u32)) -> Self {
        Self { config, grid: (columns, rows), level: CosimLevel::Rcm { columns, rows } }
    }

    fn design(&self) -> Design {
        design(&self.config, self.grid)
    }

    fn simulator(&self) -> Simulator {
        let design = self.design();
        if design.timing().clocks_per_frame() * u64::from(design.as_serial().unwrap().lanes())
            >= COMPILED_FROM
        {
            Simulator::Verilator
        } else {
            Simulator::Iverilog
        }
    }
}

fn check_all(cases: &[SerialCase]) {
    if !has_simulators() {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let failures = in_parallel(cases, |case| {
        let (name, design) = (serial_config_name(&case.config, case.grid), case.design());
        let folder = output.path().join(format!("{}-{}", design.fingerprint(), case.level));
        let stimulus = directed_stimulus(case.level, 1);
        check_agreement(&name, &design, case.simulator(), stimulus, &folder)
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// Checks the cases that cover a matrix, every sixth one in most runs. The grid counts as a key.
fn check_covering(matrix: Vec<SerialCase>) {
    let toml =
        |case: &SerialCase| format!("grid = {:?}\n{}", case.grid, case.design().config().to_toml());
    check_all(&sample(cover(matrix, toml), 6));
}

/// Sets the keys that are no axis of a test, in turn.
fn with_keys_in_turn(mut config: DesignConfig, turn: usize) -> DesignConfig {
    config.camera.render.irrelevant =
        IrrelevantRendering::ALL[turn / 2 % IrrelevantRendering::ALL.len()];
    config.camera.render.payload = in_turn(Payload::ALL, turn / 3);
    config.camera.decision.combine = in_turn(VoteCombination::ALL, turn / 5);
    config
}

/// Sets the radius of `flow`, in turn. With `last-sent`, sets its minimum to 0 if no other feature
/// could send a region first.
fn with_flow_in_turn(mut config: DesignConfig, turn: usize) -> DesignConfig {
    let camera = &mut config.camera;
    let is_alone = camera.spatial.len() == 1 || camera.decision.combine == VoteCombination::All;
    let is_stuck = is_alone && camera.temporal.reference == ReferencePolicy::LastSent;
    for spatial in camera.spatial.iter_mut().filter(|spatial| spatial.feature == Flow) {
        spatial.radius = Some([1, 3, 2][turn % 3]);
        if is_stuck {
            spatial.min_score = Some(Decimal::from_whole(0));
        }
    }
    config
}

/// One lane agrees for every feature x filter x neighborhood x reference, with sizes, feeds and
/// folds in turn.
#[test]
fn one_lane_agrees_for_every_feature_filter_neighborhood_and_reference() {
    let mut cases = Vec::new();
    for &kind in FeatureKind::ALL {
        for &filter in DenoiseFilter::ALL {
            for &neighborhood in Neighborhood::ALL {
                for &reference in ReferencePolicy::ALL {
                    let turn = cases.len();
                    let fraction = u32::try_from(turn % 5).unwrap();
                    let mut config =
                        with_keys_in_turn(serial_config(&[feature(kind, fraction)]), turn);
                    config.camera.denoise.filter = filter;
                    config.camera.region.neighborhood = neighborhood;
                    config.camera.temporal.reference = reference;
                    config.camera.region.size = [4, 5, 4, 8][turn / 3 % 4];
                    config.hardware.make_serial().fold = [1, 2, 1, 3][turn % 4];
                    config.hardware.make_serial().feed =
                        Some(in_turn(PixelFeed::ALL, turn / 2 + turn / 8));
                    cases.push(SerialCase::lane_case(with_flow_in_turn(config, turn)));
                }
            }
        }
    }
    check_covering(cases);
}

/// Small arrays agree for every feed x neighborhood x fold. Some folds leave empty slots, and some
/// put every region into one lane. Features are alone and together.
#[test]
fn arrays_agree_for_every_feed_neighborhood_and_fold() {
    let sets = feature_sets(Organization::Serial);
    let mut cases = Vec::new();
    for &feed in PixelFeed::ALL {
        for &neighborhood in Neighborhood::ALL {
            for (grid, fold) in [
                ((3, 2), 1),
                ((2, 2), 2),
                ((5, 1), 2),
                ((2, 2), 3),
                ((3, 2), 4),
                ((1, 3), 3),
                ((1, 1), 1),
            ] {
                let turn = cases.len();
                let kinds = &sets[turn % sets.len()];
                let features: Vec<_> = kinds.iter().map(|&kind| feature(kind, 2)).collect();
                let mut config = with_keys_in_turn(serial_config(&features), turn);
                config.hardware.make_serial().feed = Some(feed);
                config.hardware.make_serial().fold = fold;
                config.camera.region.neighborhood = neighborhood;
                config.camera.region.size = [4, 5, 4, 4, 5][turn % 5];
                config.camera.denoise.filter = in_turn(DenoiseFilter::ALL, turn / 2);
                config.camera.temporal.reference = in_turn(ReferencePolicy::ALL, turn + turn / 7);
                cases.push(SerialCase::array_case(with_flow_in_turn(config, turn), grid));
            }
        }
    }
    check_covering(cases);
}

/// Other depths and sizes, block memory and constant thresholds agree.
#[test]
fn depths_sizes_memories_and_constants_agree() {
    let (sets, mut cases) = (feature_sets(Organization::Serial), Vec::new());
    for (turn, bits) in [1, 10, 12, 16, 1, 16, 1, 12, 1, 16, 10].into_iter().enumerate() {
        let kinds = &sets[turn % sets.len()];
        let features: Vec<_> = kinds.iter().map(|&kind| feature(kind, 4)).collect();
        let mut config = serial_config(&features);
        config.camera.frame.pixel_bits = bits;
        for spatial in &mut config.camera.spatial {
            spatial.level = spatial.feature.score_unit().is_count().then_some(1);
            spatial.min_score = Some(Decimal::from_whole(0));
        }
        config.camera.temporal.level = Some(u32::from(bits > 1));
        config.camera.region.size = 4;
        config.camera.region.neighborhood = in_turn(Neighborhood::ALL, turn / 2);
        config.camera.temporal.reference = in_turn(ReferencePolicy::ALL, turn);
        config.hardware.make_serial().feed = Some(in_turn(PixelFeed::ALL, turn / 3));
        config.hardware.make_serial().fold = 1 + u32::try_from(turn % 2).unwrap();
        cases.push(SerialCase::array_case(with_flow_in_turn(config, turn), (2, 1)));
    }
    // The memory is distributed up to 128 LUTs, so it is block memory for the larger regions and
    // folds.
    for (turn, (size, fold)) in
        [(8, 1), (8, 6), (16, 1), (16, 2), (5, 5), (7, 2), (8, 1), (7, 2), (8, 1), (16, 2), (7, 3)]
            .into_iter()
            .enumerate()
    {
        let kinds = &sets[(turn + 4) % sets.len()];
        let features: Vec<_> = kinds.iter().map(|&kind| feature(kind, 3)).collect();
        let mut config = with_keys_in_turn(serial_config(&features), turn);
        config.camera.region.size = size;
        config.hardware.make_serial().fold = fold;
        config.hardware.make_serial().feed = Some(in_turn(PixelFeed::ALL, turn));
        config.camera.region.neighborhood = in_turn(Neighborhood::ALL, turn + 1);
        config.camera.temporal.reference = in_turn(ReferencePolicy::ALL, turn / 2);
        config.camera.denoise.filter = in_turn(DenoiseFilter::ALL, turn / 2 + turn);
        cases.push(SerialCase::array_case(with_flow_in_turn(config, turn), (3, 2)));
    }
    let mut large = serial_config(&[feature(Edge, 0)]);
    large.camera.region.size = 32;
    large.camera.denoise.filter = DenoiseFilter::None;
    large.camera.temporal.reference = ReferencePolicy::LastSent;
    cases.push(SerialCase::lane_case(large));
    let mut odd = serial_config(&[feature(Flow, 0)]);
    odd.camera.region.size = 17;
    odd.camera.frame.pixel_bits = 1;
    odd.camera.temporal.level = Some(0);
    odd.camera.spatial[0].radius = Some(3);
    cases.push(SerialCase::array_case(odd, (2, 1)));
    for (turn, &kind) in FeatureKind::ALL.iter().enumerate() {
        let mut config = with_keys_in_turn(serial_config(&[feature(kind, 3)]), turn);
        config.hardware.thresholds = ThresholdSource::Constant;
        config.camera.region.size = [4, 5][turn % 2];
        config.hardware.make_serial().fold = [1, 2][turn / 2 % 2];
        config.camera.denoise.filter = in_turn(DenoiseFilter::ALL, turn);
        config.camera.temporal.reference = in_turn(ReferencePolicy::ALL, turn / 2);
        cases.push(SerialCase::array_case(with_flow_in_turn(config, turn), (2, 2)));
    }
    check_all(&sample(cases, 7));
}

/// Deep arrays agree for every filter x reference x feed x memory, with features whose words have a
/// register and without.
#[test]
fn deep_arrays_agree() {
    let sets: [&[FeatureKind]; 10] = [
        &[Edge],
        FeatureKind::ALL,
        &[Corner],
        &[Variance],
        &[Mad, Edge],
        &[Range],
        &[Segment],
        &[Surface],
        &[Edge, Flow],
        &[Flow, Mad, Range],
    ];
    let mut cases = Vec::new();
    for &filter in DenoiseFilter::ALL {
        for &reference in ReferencePolicy::ALL {
            for &feed in PixelFeed::ALL {
                for &memory in LaneMemoryKind::ALL {
                    let turn = cases.len();
                    let kinds = &sets[turn % sets.len()];
                    let features: Vec<_> = kinds.iter().map(|&kind| feature(kind, 2)).collect();
                    let mut config = with_keys_in_turn(serial_config(&features), turn);
                    config.hardware.pipelining = Pipelining::Deep;
                    config.hardware.make_serial().memory = Some(memory);
                    config.hardware.make_serial().feed = Some(feed);
                    config.hardware.make_serial().fold = [2, 1, 3][turn % 3];
                    config.camera.denoise.filter = filter;
                    config.camera.temporal.reference = reference;
                    config.camera.region.size = [4, 5, 4][turn / 2 % 3];
                    config.camera.region.neighborhood =
                        in_turn(Neighborhood::ALL, turn / 4 + turn / 2 + turn);
                    cases.push(SerialCase::array_case(with_flow_in_turn(config, turn), (3, 2)));
                }
            }
        }
    }
    check_covering(cases);
}

/// Summaries agree in special cases: blocks of one pixel, of 3x3 pixels and of the whole region,
/// many words, features with and without sums, and raw pixels, with each feed and each memory.
#[test]
fn summaries_agree() {
    let (distributed, block) = (LaneMemoryKind::Distributed, LaneMemoryKind::Block);
    let (plain, deep) = (Pipelining::Plain, Pipelining::Deep);
    let mut cases = Vec::new();
    for (turn, (size, blocks, bits, kinds, fold, memory, pipelining)) in [
        (4, 4, 8, &[Edge][..], 1, block, deep),
        (6, 2, 8, &[Edge, Corner], 2, distributed, plain),
        (12, 4, 8, &[Mad], 4, distributed, deep),
        (5, 1, 16, &[Corner], 6, block, plain),
        (8, 1, 8, &[Variance], 1, distributed, deep),
        (8, 1, 1, &[Edge], 3, block, plain),
        (6, 1, 10, &[Variance], 2, block, deep),
        (4, 2, 16, &[Edge], 6, distributed, deep),
        (4, 1, 8, &[Range], 2, distributed, deep),
        (6, 2, 8, &[Segment], 2, distributed, plain),
        (4, 1, 8, &[Surface, Segment], 3, block, deep),
        (4, 2, 8, &[Flow, Edge], 2, distributed, plain),
        (6, 1, 8, &[Flow], 3, block, deep),
    ]
    .into_iter()
    .enumerate()
    {
        let features: Vec<_> = kinds.iter().map(|&kind| feature(kind, 2)).collect();
        let mut config = serial_config(&features);
        if bits == 1 {
            config.camera.spatial[0].level = Some(1);
            config.camera.temporal.level = Some(0);
        }
        config.camera.region.size = size;
        config.camera.frame.pixel_bits = bits;
        config.camera.render.irrelevant = IrrelevantRendering::Mean;
        config.camera.periphery.blocks = Some(blocks);
        config.camera.render.payload = in_turn(Payload::ALL, turn / 2);
        config.camera.denoise.filter = in_turn(DenoiseFilter::ALL, turn + turn / 4);
        config.camera.temporal.reference = in_turn(ReferencePolicy::ALL, turn % 3);
        config.camera.region.neighborhood = in_turn(Neighborhood::ALL, turn / 3);
        config.hardware.thresholds = in_turn(ThresholdSource::ALL, turn / 6);
        config.hardware.make_serial().feed = Some(in_turn(PixelFeed::ALL, turn));
        config.hardware.make_serial().memory = Some(memory);
        config.hardware.pipelining = pipelining;
        config.hardware.make_serial().fold = fold;
        cases.push(SerialCase::array_case(with_flow_in_turn(config, turn), (3, 2)));
    }
    check_all(&sample(cases, 7));
}

/// A memory that the configuration names agrees if the rule would choose the other kind: for every
/// filter x reference x feed, block memory for small regions and distributed memory for large ones.
#[test]
fn a_configured_memory_kind_agrees() {
    let mut cases = Vec::new();
    for &filter in DenoiseFilter::ALL {
        for &reference in ReferencePolicy::ALL {
            for &feed in PixelFeed::ALL {
                let turn = cases.len();
                for (memory, size, fold) in [
                    (LaneMemoryKind::Block, [4, 5][turn % 2], 2),
                    (LaneMemoryKind::Distributed, 8, 9),
                ] {
                    let kinds = [[Edge, Variance], [Mad, Corner], [Corner, Edge]][turn / 2 % 3];
                    let mut config =
                        with_keys_in_turn(serial_config(&kinds.map(|kind| feature(kind, 3))), turn);
                    config.camera.denoise.filter = filter;
                    config.camera.temporal.reference = reference;
                    config.hardware.make_serial().feed = Some(feed);
                    config.hardware.make_serial().fold = fold;
                    config.camera.region.size = size;
                    config.camera.region.neighborhood = in_turn(Neighborhood::ALL, turn / 4 + turn);
                    let ruled = design(&config, (5, 2)).as_serial().unwrap().lane_memory().kind;
                    assert_ne!(ruled, memory, "the rule would choose it, too");
                    config.hardware.make_serial().memory = Some(memory);
                    cases.push(SerialCase::array_case(config, (5, 2)));
                }
            }
        }
    }
    check_covering(cases);
}
