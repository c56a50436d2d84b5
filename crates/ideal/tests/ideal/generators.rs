// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random cameras and clips.

use crate::largest_thresholds::largest_thresholds;
use foveate_camera::{
    Camera, CameraConfig, Decimal, DenoiseFilter, FeatureKind, IrrelevantRendering, KeenConfig,
    KeenPeripheryConfig, KeenSpatialConfig, KeenTemporalConfig, Neighborhood, Payload,
    ReferencePolicy, RegionClass, SpatialConfig, VoteCombination, ZonesConfig,
};
use foveate_pixels::Frame;
use proptest::prelude::*;
use proptest::sample::{select, subsequence};

/// The filters that do not round.
const EXACT_FILTERS: &[DenoiseFilter] =
    &[DenoiseFilter::None, DenoiseFilter::Median3x3, DenoiseFilter::Switching3x3];

/// The changes that make each frame of a clip from the one before.
pub(crate) type ChangeScript = Vec<FrameChange>;

#[derive(Clone, Copy, Debug)]
pub(crate) enum FrameChange {
    Noise,
    Still,
    Flat,
    Binary,
    Fade,
    /// A square of new noise, with its corner at this pixel modulo the size of the frame.
    Patch(u32, u32),
}

pub(crate) fn scripts() -> impl Strategy<Value = ChangeScript> {
    let change = prop_oneof![
        2 => Just(FrameChange::Noise),
        2 => Just(FrameChange::Still),
        1 => Just(FrameChange::Flat),
        1 => Just(FrameChange::Binary),
        2 => Just(FrameChange::Fade),
        3 => (any::<u32>(), any::<u32>()).prop_map(|(x, y)| FrameChange::Patch(x, y)),
    ];
    proptest::collection::vec(change, 2..7)
}

/// Returns cameras with shared windows. With `rounded` they may have a mean with any fraction bits,
/// and odd sides, and `flow`, whose score is rounded down. Without it, cameras with a mean have a
/// side that is a power of two and an exact mean. No camera has the filter `binomial3x3`, which
/// always rounds.
pub(crate) fn cameras(rounded: bool) -> impl Strategy<Value = Camera> {
    let sides =
        if rounded { vec![2, 3, 4, 5, 7, 8, 9] } else { vec![2, 3, 4, 6, 7, 8, 16, 32, 64] };
    let bits = prop_oneof![4 => Just(8_u32), 2 => 1_u32..=7, 2 => 9_u32..=16];
    (select(sides), bits).prop_flat_map(move |(side, bits): (u32, u32)| {
        let exact = side.is_power_of_two();
        let possible: Vec<FeatureKind> = FeatureKind::ALL
            .iter()
            .copied()
            .filter(|&kind| rounded || exact || !kind.has_second_pass())
            .filter(|&kind| rounded || !kind.is_displacement())
            .collect();
        let kinds = subsequence(possible.clone(), 1..=possible.len()).prop_shuffle();
        let log2 = (0_u32..).find(|bits| 1 << bits >= side * side).unwrap();
        // All features of a camera share one mean.
        let fraction = if rounded { 0..=log2 } else { log2..=log2 };
        let features = (kinds, fraction).prop_flat_map(move |(kinds, fraction_bits)| {
            let feature = |kind| feature(kind, side, bits, fraction_bits);
            kinds.into_iter().map(feature).collect::<Vec<_>>()
        });
        let filter = select(EXACT_FILTERS);
        let (max, n) = ((1_u32 << bits) - 1, side * side);
        let size = (1..=3 * side + 2, 1..=2 * side + 3);
        let on = proptest::array::uniform4(any::<bool>());
        let blocks: Vec<u32> = [1, 2, 4].into_iter().filter(|q| side.is_multiple_of(*q)).collect();
        let periphery = proptest::option::of((select(blocks), small(max - 1)));
        (size, features, filter, small(max - 1), small(n), on, periphery).prop_map(
            move |(size, features, filter, level, min_count, on, periphery)| {
                let mut config = CameraConfig::default();
                (config.frame.width, config.frame.height) = (Some(size.0), Some(size.1));
                (config.frame.pixel_bits, config.region.size) = (bits, side);
                config.region.neighborhood = Neighborhood::Shared;
                config.spatial = features;
                (config.temporal.level, config.temporal.min_count) = (Some(level), min_count);
                config.denoise.filter = filter;
                config.decision.combine =
                    if on[0] { VoteCombination::All } else { VoteCombination::Any };
                config.temporal.reference =
                    if on[1] { ReferencePolicy::LastSent } else { ReferencePolicy::Previous };
                config.render.irrelevant =
                    if on[2] { IrrelevantRendering::Hold } else { IrrelevantRendering::Zero };
                if let Some((blocks, level)) = periphery {
                    config.render.irrelevant = IrrelevantRendering::Mean;
                    (config.periphery.blocks, config.periphery.level) = (Some(blocks), Some(level));
                }
                config.render.payload = if on[3] { Payload::Raw } else { Payload::Denoised };
                // Without another feature that votes, no region has a reference with `last-sent`.
                config.validate().unwrap_or_else(|_| {
                    config.temporal.reference = ReferencePolicy::Previous;
                    config.validate().unwrap()
                })
            },
        )
    })
}

/// Returns cameras of [`cameras`] without rounding that have zones.
pub(crate) fn zoned_cameras() -> impl Strategy<Value = Camera> {
    cameras(false).prop_flat_map(|camera| {
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
            let spatial =
                features.into_iter().map(|SpatialConfig { feature, level, min_score, .. }| {
                    KeenSpatialConfig { feature, level, min_score }
                });
            config.zones = Some(ZonesConfig {
                off_level: summaries(levels.1),
                keen: KeenConfig {
                    spatial: spatial.collect(),
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

/// Returns the classes of the regions of a camera for each frame of a clip.
pub(crate) fn maps(camera: &Camera, frames: usize, seed: u64) -> Vec<Vec<RegionClass>> {
    let mut state = seed | 1;
    let mut class = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        RegionClass::ALL[(state >> 20) as usize % RegionClass::ALL.len()]
    };
    let mut map = || (0..camera.regions()).map(|_| class()).collect();
    // Every map holds for two frames.
    let maps: Vec<Vec<_>> = (0..frames.div_ceil(2)).map(|_| map()).collect();
    (0..frames).map(|frame| maps[frame / 2].clone()).collect()
}

fn small(max: u32) -> impl Strategy<Value = u32> {
    prop_oneof![2 => 0..=max.min(4), 2 => 0..=max / 4, 1 => 0..=max]
}

fn feature(kind: FeatureKind, side: u32, bits: u32, fraction: u32) -> BoxedStrategy<SpatialConfig> {
    // Minima in grey levels have two digits after the decimal point.
    let hundredths = if kind.score_unit().is_count() { 1 } else { 100 };
    (1..=3.min(side - 1), 0..100_u32)
        .prop_flat_map(move |(radius, part)| {
            let entry = SpatialConfig {
                mean_fraction_bits: kind.has_second_pass().then_some(fraction),
                radius: kind.is_displacement().then_some(radius),
                ..SpatialConfig::new(kind)
            };
            let (level_max, min_max) = largest_thresholds(&entry, side, bits);
            (small(level_max.unwrap_or(0)), small(min_max)).prop_map(move |(level, whole)| {
                let part = if whole < min_max { part % hundredths } else { 0 };
                SpatialConfig {
                    level: level_max.map(|_| level),
                    min_score: Decimal::from_f64(
                        (f64::from(whole) * 100.0 + f64::from(part)).round() / 100.0,
                    ),
                    ..entry.clone()
                }
            })
        })
        .boxed()
}

/// Makes the clip of a script; its first frame is noise.
pub(crate) fn script_frames(camera: &Camera, seed: u64, script: &[FrameChange]) -> Vec<Frame> {
    let mut state = seed | 1;
    let max = u16::try_from(camera.pixel_max()).unwrap();
    let mut below = move |max: u16| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        u16::try_from((state >> 20) % (u64::from(max) + 1)).unwrap()
    };
    let (width, height) = (camera.width(), camera.height());
    let mut pixels: Vec<u16> = (0..width * height).map(|_| below(max)).collect();
    let frame =
        |pixels: &[u16]| Frame::new(width, height, camera.pixel_bits(), pixels.to_vec()).unwrap();
    let mut frames = vec![frame(&pixels)];
    for &change in script {
        match change {
            FrameChange::Still => {}
            FrameChange::Noise => pixels.fill_with(|| below(max)),
            FrameChange::Flat => pixels.fill(below(max)),
            FrameChange::Binary => {
                let values = [below(max), below(max)];
                pixels.fill_with(|| values[usize::from(below(1))]);
            }
            FrameChange::Fade => pixels.iter_mut().for_each(|p| *p = p.saturating_add(1).min(max)),
            FrameChange::Patch(x, y) => {
                for y in y % height..height.min(y % height + 5) {
                    for x in x % width..width.min(x % width + 5) {
                        pixels[(y * width + x) as usize] = below(max);
                    }
                }
            }
        }
        frames.push(frame(&pixels));
    }
    frames
}
