// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random cameras, the inputs of the comparison of engine and model.

use crate::largest_thresholds::largest_thresholds;
use foveate_camera::{
    Camera, CameraConfig, Decimal, DenoiseFilter, FeatureKind, IrrelevantRendering, KeenConfig,
    KeenPeripheryConfig, KeenSpatialConfig, KeenTemporalConfig, Neighborhood, Payload,
    ReferencePolicy, SpatialConfig, VoteCombination, ZonesConfig,
};
use proptest::prelude::*;
use proptest::sample::{select, subsequence};

/// Returns cameras of every kind, with frames of one block of elements, of several blocks, and
/// ragged ones.
pub(crate) fn cameras() -> impl Strategy<Value = Camera> {
    let side = prop_oneof![
        4 => select(vec![2u32, 4, 8, 16, 32, 64]),
        3 => select(vec![3u32, 5, 6, 7, 12, 20, 33, 63]),
        1 => 2u32..=64,
    ];
    let bits = prop_oneof![5 => Just(8u32), 1 => 1u32..=7, 2 => 9u32..=16];
    (side, bits).prop_flat_map(|(side, bits)| {
        let width = prop_oneof![1..=3 * side, 60u32..=70, 120u32..=260, 190u32..=194];
        let height = 1..=3 * side + 1;
        // All features of a camera share one mean.
        let fraction_max = (0u32..).find(|bits| 1 << bits >= side * side).unwrap();
        let kinds = subsequence(FeatureKind::ALL.to_vec(), 1..=FeatureKind::COUNT).prop_shuffle();
        let features = (kinds, 0..=fraction_max).prop_flat_map(move |(kinds, fraction_bits)| {
            let feature = |kind| feature(kind, side, bits, fraction_bits);
            kinds.into_iter().map(feature).collect::<Vec<_>>()
        });
        let filter = select(DenoiseFilter::ALL);
        let max = (1u32 << bits) - 1;
        let temporal = (small(max - 1).prop_map(Some), small(side * side));
        let switches = proptest::array::uniform5(any::<bool>());
        let blocks: Vec<u32> = [1, 2, 4].into_iter().filter(|q| side.is_multiple_of(*q)).collect();
        let periphery = proptest::option::of((select(blocks), small(max - 1)));
        (width, height, features, filter, temporal, switches, periphery).prop_map(
            move |(width, height, features, filter, temporal, on, periphery)| {
                let mut config = CameraConfig::default();
                (config.frame.width, config.frame.height) = (Some(width), Some(height));
                (config.frame.pixel_bits, config.region.size) = (bits, side);
                config.spatial = features;
                (config.temporal.level, config.temporal.min_count) = temporal;
                if on[0] {
                    config.region.neighborhood = Neighborhood::Shared;
                }
                config.denoise.filter = filter;
                if on[1] {
                    config.decision.combine = VoteCombination::All;
                }
                if on[2] {
                    config.temporal.reference = ReferencePolicy::LastSent;
                }
                if on[3] {
                    config.render.irrelevant = IrrelevantRendering::Hold;
                }
                if let Some((blocks, level)) = periphery {
                    config.render.irrelevant = IrrelevantRendering::Mean;
                    (config.periphery.blocks, config.periphery.level) = (Some(blocks), Some(level));
                }
                if on[4] {
                    config.render.payload = Payload::Raw;
                }
                // Without another feature that votes, no region has a reference with `last-sent`.
                config.validate().unwrap_or_else(|_| {
                    config.temporal.reference = ReferencePolicy::Previous;
                    config.validate().unwrap_or_else(|error| panic!("{error}\n{config:?}"))
                })
            },
        )
    })
}

/// Returns cameras of [`cameras`] with zones.
pub(crate) fn zoned_cameras() -> impl Strategy<Value = Camera> {
    cameras().prop_flat_map(|camera| {
        let (side, bits, max) = (camera.region_size(), camera.pixel_bits(), camera.pixel_max());
        let keen = |own: &SpatialConfig| {
            feature(own.feature, side, bits, own.mean_fraction_bits.unwrap_or(0))
        };
        let features: Vec<_> = camera.config().spatial.iter().map(keen).collect();
        let temporal = (small(max - 1), small(side * side));
        let levels = (small(max - 1), small(max));
        (features, temporal, levels).prop_map(move |(features, temporal, levels)| {
            let mut config = camera.config().clone();
            let summaries = |level| camera.periphery().map(|_| level);
            let entry = |one: SpatialConfig| KeenSpatialConfig {
                feature: one.feature,
                level: one.level,
                min_score: one.min_score,
            };
            config.zones = Some(ZonesConfig {
                off_level: summaries(levels.1),
                keen: KeenConfig {
                    spatial: features.into_iter().map(entry).collect(),
                    temporal: KeenTemporalConfig {
                        level: Some(temporal.0),
                        min_count: Some(temporal.1),
                    },
                    periphery: KeenPeripheryConfig { level: summaries(levels.0) },
                },
                ..ZonesConfig::default()
            });
            config.validate().unwrap_or_else(|error| panic!("{error}\n{config:?}"))
        })
    })
}

/// Returns mostly small numbers up to `max`, so that scores lie on both sides of thresholds.
fn small(max: u32) -> impl Strategy<Value = u32> {
    prop_oneof![2 => 0..=max.min(4), 2 => 0..=max / 4, 1 => 0..=max]
}

fn feature(
    kind: FeatureKind,
    side: u32,
    bits: u32,
    fraction_bits: u32,
) -> BoxedStrategy<SpatialConfig> {
    (1..=3.min(side - 1))
        .prop_flat_map(move |radius| {
            let entry = SpatialConfig {
                mean_fraction_bits: kind.has_second_pass().then_some(fraction_bits),
                radius: kind.is_displacement().then_some(radius),
                ..SpatialConfig::new(kind)
            };
            let (level_max, min_max) = largest_thresholds(&entry, side, bits);
            (small(level_max.unwrap_or(0)), small(min_max)).prop_map(move |(level, minimum)| {
                SpatialConfig {
                    level: level_max.map(|_| level),
                    min_score: Some(Decimal::from_whole(minimum.into())),
                    ..entry.clone()
                }
            })
        })
        .boxed()
}
