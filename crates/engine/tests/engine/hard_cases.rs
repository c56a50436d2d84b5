// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cases that random cameras reach too seldom.

use foveate_camera::{
    Camera, CameraConfig, Decimal, FeatureKind, IrrelevantRendering, Neighborhood, ReferencePolicy,
    SpatialConfig,
};
use foveate_engine::EngineOptions;
use foveate_pixels::Frame;

use crate::clip_script::{FrameChange, clip};
use crate::properties::{check, check_all};

pub(crate) fn camera(
    width: u32,
    height: u32,
    side: u32,
    change: impl FnOnce(&mut CameraConfig),
) -> Camera {
    let mut config = CameraConfig::default();
    (config.frame.width, config.frame.height) = (Some(width), Some(height));
    config.region.size = side;
    change(&mut config);
    config.validate().unwrap()
}

fn every_feature(config: &mut CameraConfig) {
    config.spatial = FeatureKind::ALL.iter().map(|&kind| SpatialConfig::new(kind)).collect();
    // The default of `segment` is more than half of the pixels of a small region.
    entry(config, FeatureKind::Segment).min_score = Some(Decimal::from_whole(2));
}

fn entry(config: &mut CameraConfig, kind: FeatureKind) -> &mut SpatialConfig {
    config.spatial.iter_mut().find(|entry| entry.feature == kind).unwrap()
}

/// Regions of 64 x 64 extreme pixels give the largest sums, in both types of pixels.
#[test]
fn the_largest_sums_stay_inside_their_lanes() {
    for bits in [8, 16] {
        let camera = camera(128, 128, 64, |config| {
            every_feature(config);
            config.frame.pixel_bits = bits;
            for kind in [FeatureKind::Edge, FeatureKind::Corner, FeatureKind::Segment] {
                entry(config, kind).level = Some(0);
            }
            for kind in [FeatureKind::Mad, FeatureKind::Segment] {
                entry(config, kind).mean_fraction_bits = Some(12);
            }
        });
        let max = u16::try_from(camera.pixel_max()).unwrap();
        let full = Frame::filled(128, 128, bits, max).unwrap();
        let stripes = |x: u32, _| if (x / 2).is_multiple_of(2) { 0 } else { max };
        let stripes = Frame::from_fn(128, 128, bits, stripes).unwrap();
        let halves = Frame::from_fn(128, 128, bits, |_, y| if y < 32 { 0 } else { max }).unwrap();
        check(&camera, &[full, stripes, halves], EngineOptions::default());
    }
}

/// A still scene is skipped with every kind of reference and screen, and the results are right when
/// it moves again.
#[test]
fn still_scenes_are_skipped_with_exact_results() {
    use FrameChange::{Noise, Patch, Spot, Still};
    let script = [
        Still,
        Still,
        Still,
        Spot(0.5, 0.5),
        Still,
        Patch(0.2, 0.6),
        Still,
        Still,
        Noise,
        Still,
        Still,
        Still,
        Still,
        Still,
        Still,
        Still,
        Spot(0.99, 0.0),
        Still,
    ];
    for neighborhood in [Neighborhood::Isolated, Neighborhood::Shared] {
        for reference in [ReferencePolicy::Previous, ReferencePolicy::LastSent] {
            for irrelevant in [IrrelevantRendering::Zero, IrrelevantRendering::Hold] {
                for min_count in [0, 1, 40] {
                    let camera = camera(250, 70, 8, |config| {
                        every_feature(config);
                        config.region.neighborhood = neighborhood;
                        config.temporal.reference = reference;
                        config.temporal.min_count = min_count;
                        config.render.irrelevant = irrelevant;
                        config.spatial[0].level = Some(400);
                    });
                    let frames = clip(&camera, 77, &script);
                    let options = |(threads, skip)| EngineOptions {
                        threads,
                        skips_identical_regions: skip,
                        ..EngineOptions::default()
                    };
                    let option_sets = [(1, true), (1, false), (2, true), (2, false)].map(options);
                    let [alone, alone_all, two, two_all] = check_all(&camera, &frames, option_sets);
                    assert!(alone > 1000 && two > 1000, "skipped: {alone}, {two}");
                    assert_eq!([alone_all, two_all], [0, 0]);
                }
            }
        }
    }
}

/// A spot changes the windows of its neighbors up to two pixels away. Each spot is near a region's
/// border, in a scene that is skipped everywhere else.
#[test]
fn a_change_in_the_halo_of_a_skipped_region_is_found() {
    let camera = camera(200, 24, 8, |config| {
        every_feature(config);
        config.region.neighborhood = Neighborhood::Shared;
        config.spatial[0].level = Some(10);
        config.spatial[1].level = Some(3);
    });
    for x in 60u32..70 {
        for y in 5u32..11 {
            let place = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let spots = [FrameChange::Still, FrameChange::Spot(place.0 / 200.0, place.1 / 24.0)];
            let frames = clip(&camera, u64::from(100 * x + y), &spots);
            assert!(check(&camera, &frames, EngineOptions::default()) > 50);
        }
    }
}

/// Changes that lie far apart in one band are computed as several runs, none of which uses rows of
/// another.
#[test]
fn several_runs_of_one_band_do_not_mix() {
    for neighborhood in [Neighborhood::Isolated, Neighborhood::Shared] {
        for side in [8, 12] {
            let camera = camera(1000, 40, side, |config| {
                every_feature(config);
                config.region.neighborhood = neighborhood;
            });
            let mut frames = clip(&camera, 21, &[FrameChange::Still]);
            for round in 0..3 {
                let last = frames.last().unwrap().clone();
                let spots = [40 + round, 450 + round, 905 + round];
                let pixel = |x, y| match last.get(x, y) {
                    pixel if spots.contains(&x) && y % 8 == 3 => 255 - pixel,
                    pixel => pixel,
                };
                frames.push(Frame::from_fn(1000, 40, 8, pixel).unwrap());
            }
            assert!(check(&camera, &frames, EngineOptions::default()) > 500);
        }
    }
}

/// A region is sent, wiped, and then stands still. Its reference becomes invalid in a frame in
/// which its pixels do not change.
#[test]
fn a_still_region_loses_its_reference_after_a_wipe() {
    let script = [
        FrameChange::Still,
        FrameChange::Still,
        FrameChange::Wipe(0.3, 0.1),
        FrameChange::Still,
        FrameChange::Still,
        FrameChange::Patch(0.3, 0.1),
        FrameChange::Still,
    ];
    for irrelevant in [IrrelevantRendering::Zero, IrrelevantRendering::Hold] {
        let camera = camera(600, 64, 8, |config| {
            config.temporal.reference = ReferencePolicy::LastSent;
            config.render.irrelevant = irrelevant;
        });
        assert!(check(&camera, &clip(&camera, 9, &script), EngineOptions::default()) > 1000);
    }
}

/// The other columns of a block are computed again, and keep their values.
#[test]
fn regions_that_share_a_block_with_a_change_stay_exact() {
    for side in [3, 5, 6, 7, 12, 48] {
        let camera = camera(300, 3 * side, side, every_feature);
        let script = [
            FrameChange::Still,
            FrameChange::Spot(0.45, 0.5),
            FrameChange::Still,
            FrameChange::Spot(0.9, 0.1),
        ];
        check(&camera, &clip(&camera, 5, &script), EngineOptions::default());
    }
}

/// The frames are large enough to be divided among threads. Strips see their neighbors' pixels, and
/// the results are those of one thread.
#[test]
fn strips_of_several_threads_equal_the_model() {
    use FrameChange::{Noise, Patch, Spot, Still};
    let script = [Still, Still, Patch(0.4, 0.2), Still, Noise, Still, Spot(0.5, 0.5)];
    // The cases contain every pair of side, neighborhood and reference.
    for (number, side) in [5, 8, 32].into_iter().enumerate() {
        for neighborhood in [Neighborhood::Isolated, Neighborhood::Shared] {
            let is_isolated = neighborhood == Neighborhood::Isolated;
            let reference = match is_isolated == number.is_multiple_of(2) {
                true => ReferencePolicy::Previous,
                false => ReferencePolicy::LastSent,
            };
            let camera = camera(530, 270, side, |config| {
                every_feature(config);
                config.region.neighborhood = neighborhood;
                config.temporal.reference = reference;
            });
            let option_sets =
                [2, 3].map(|threads| EngineOptions { threads, ..EngineOptions::default() });
            check_all(&camera, &clip(&camera, 3, &script), option_sets);
        }
    }
}
