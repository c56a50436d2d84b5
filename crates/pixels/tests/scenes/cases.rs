// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that every scene shows the case that it is named after.

use foveate_pixels::{Frame, Scene, SceneParameters};

fn frames(scene: Scene, frames: u32) -> Vec<Frame> {
    scene
        .frames(SceneParameters { width: 64, height: 48, bits: 8, region_size: 8, frames })
        .collect()
}

/// Returns the differences between successive frames, pixel by pixel.
fn steps(frames: &[Frame]) -> Vec<Vec<i32>> {
    let difference = |a: &Frame, b: &Frame| {
        a.pixels().iter().zip(b.pixels()).map(|(&a, &b)| i32::from(b) - i32::from(a)).collect()
    };
    frames.iter().zip(frames.iter().skip(1)).map(|(a, b)| difference(a, b)).collect()
}

/// Returns the pixels of one region in row-major order.
fn region(frame: &Frame, column: u32, row: u32, side: u32) -> Vec<u16> {
    let at = |i| frame.get(column * side + i % side, row * side + i / side);
    (0..side * side).map(at).collect()
}

#[test]
fn zero_and_max_are_flat() {
    assert!(frames(Scene::Zero, 3).iter().all(|f| f.pixels().iter().all(|&p| p == 0)));
    assert!(frames(Scene::Max, 3).iter().all(|f| f.pixels().iter().all(|&p| p == 255)));
}

#[test]
fn checkerboard_swings_fully_between_neighbors_and_every_second_frame() {
    let frames = frames(Scene::Checkerboard, 4);
    for y in 0..48 {
        for x in 1..64 {
            assert_eq!(frames[0].get(x, y).abs_diff(frames[0].get(x - 1, y)), 255);
        }
    }
    let steps = steps(&frames);
    assert!(steps[0].iter().all(|&step| step == 0));
    assert!(steps[1].iter().all(|&step| step.abs() == 255));
}

#[test]
fn hot_pixels_are_hot_and_dead_at_each_corner_of_every_region() {
    let frames = frames(Scene::HotPixels, 8);
    for row in 0..6 {
        for column in 0..8 {
            let mut odd_pixels: Vec<(usize, u16)> = Vec::new();
            for frame in &frames {
                let odd: Vec<(usize, u16)> = region(frame, column, row, 8)
                    .into_iter()
                    .enumerate()
                    .filter(|&(_, pixel)| pixel != 127)
                    .collect();
                assert_eq!(odd.len(), 1, "one odd pixel per region");
                odd_pixels.extend(odd);
            }
            odd_pixels.sort_unstable();
            let corners = [0, 7, 56, 63].into_iter().flat_map(|at| [(at, 0), (at, 255)]);
            assert_eq!(odd_pixels, corners.collect::<Vec<_>>());
        }
    }
}

#[test]
fn ramps_grow_by_one_level_from_region_to_region_and_frame_to_frame() {
    let frames = frames(Scene::Ramps, 3);
    for (t, frame) in (0..).zip(&frames) {
        for column in 0..8 {
            let slope = u16::try_from(column + t).unwrap();
            assert_eq!(frame.get(8 * column + 1, 0) - frame.get(8 * column, 0), slope);
            assert_eq!(frame.get(8 * column, 9) - frame.get(8 * column, 8), slope);
            assert_eq!(frame.get(8 * column + 1, 17) - frame.get(8 * column, 16), 2 * slope);
            assert_eq!(frame.get(8 * column + 4, 24) - frame.get(8 * column + 3, 24), slope);
        }
    }
}

#[test]
fn half_means_end_in_one_half_then_just_below_then_just_above() {
    let frames = frames(Scene::HalfMeans, 3);
    let mut halvings_found = [false; 6];
    for row in 0..6 {
        for column in 0..8 {
            let sums = frames
                .iter()
                .map(|frame| region(frame, column, row, 8).into_iter().map(u32::from).sum::<u32>());
            let sums: Vec<u32> = sums.collect();
            assert_eq!((sums[1] + 1, sums[2]), (sums[0], sums[0] + 1));
            // The value 2^f * sum / 64 ends in one half for the f at which the remainder is 32.
            let f = (0..6_usize).find(|f| (sums[0] << f) % 64 == 32).unwrap();
            halvings_found[f] = true;
        }
    }
    assert_eq!(halvings_found, [true; 6], "every number of fraction bits has its half");
}

#[test]
fn flicker_and_fade_change_every_pixel_by_exactly_one_level() {
    let signs = |step: &Vec<i32>| (step.iter().all(|&s| s == 1), step.iter().all(|&s| s == -1));
    for (t, step) in steps(&frames(Scene::Flicker, 6)).iter().enumerate() {
        assert_eq!(signs(step), (t % 2 == 0, t % 2 == 1), "flicker {t}");
    }
    // The light rises for 128 frames, falls for 128 frames, and so on.
    for (t, step) in steps(&frames(Scene::Fade, 600)).iter().enumerate() {
        assert_eq!(signs(step), (t % 256 < 128, t % 256 >= 128), "fade {t}");
    }
}

#[test]
fn the_light_switches_everywhere_at_once_and_by_half_the_range() {
    for (t, step) in steps(&frames(Scene::LightStep, 20)).iter().enumerate() {
        let expected = [0, 128, -128][usize::from(t % 16 == 7) + 2 * usize::from(t % 16 == 15)];
        assert!(step.iter().all(|&s| s == expected), "frame {t}");
    }
}

#[test]
fn a_shaking_camera_moves_the_whole_picture() {
    let frames = frames(Scene::Shake, 12);
    let moved = |a: &Frame, b: &Frame, dx: i32, dy: i32| {
        let at = |v: u32, d: i32| u32::try_from(i32::try_from(v).unwrap() + d).unwrap();
        (4..44).all(|y| (4..60).all(|x| b.get(x, y) == a.get(at(x, dx), at(y, dy))))
    };
    for pair in frames.windows(2) {
        let found = (-2..=2).any(|dx| (-2..=2).any(|dy| moved(&pair[0], &pair[1], dx, dy)));
        assert!(found, "each frame is the one before, shifted by at most two pixels");
    }
    assert!(frames.iter().any(|frame| frame != &frames[0]));
}

#[test]
fn the_object_is_one_pixel_that_moves_every_frame() {
    let frames = frames(Scene::OnePixel, 200);
    let place = |frame: &Frame| {
        let bright = |(_, pixel): &(usize, &u16)| **pixel == 255;
        let found: Vec<usize> =
            frame.pixels().iter().enumerate().filter(bright).map(|found| found.0).collect();
        assert_eq!(found.len(), 1);
        assert_eq!(frame.pixels().iter().filter(|&&pixel| pixel == 63).count(), 64 * 48 - 1);
        found[0]
    };
    let places: Vec<usize> = frames.iter().map(place).collect();
    for pair in places.windows(2) {
        let (x, y) = (pair[0] % 64, pair[0] / 64);
        let (u, v) = (pair[1] % 64, pair[1] / 64);
        assert_eq!((x.abs_diff(u), y.abs_diff(v)), (1, 1));
    }
}

#[test]
fn a_late_change_comes_after_ten_thousand_equal_frames() {
    let small = SceneParameters { width: 16, height: 8, bits: 8, region_size: 8, frames: 10_001 };
    let mut frames = Scene::LateChange.frames(small);
    let first = frames.next().unwrap();
    assert!(frames.by_ref().take(9_999).all(|frame| frame == first));
    let last = frames.next().unwrap();
    let changed = |column| region(&last, column, 0, 8) != region(&first, column, 0, 8);
    assert_eq!((changed(0), changed(1)), (true, false));
    assert!(frames.next().is_none());
}

#[test]
fn random_uses_the_whole_range_evenly() {
    let frames = frames(Scene::Random, 8);
    let mut counts = [0u32; 256];
    for &pixel in frames.iter().flat_map(Frame::pixels) {
        counts[usize::from(pixel)] += 1;
    }
    assert!(counts.iter().all(|count| (50..150).contains(count)), "{counts:?}");
}

#[test]
fn traffic_moves_in_front_of_a_street_that_stands_still() {
    let size = SceneParameters { width: 224, height: 224, bits: 8, region_size: 8, frames: 30 };
    let frames: Vec<Frame> = Scene::Street.frames(size).collect();
    let count = |rows: std::ops::Range<u32>| {
        let pixels = rows.flat_map(|y| (0..224).map(move |x| (x, y)));
        pixels.filter(|&(x, y)| frames[0].get(x, y).abs_diff(frames[29].get(x, y)) > 16).count()
    };
    assert_eq!(count(0..128), 0, "houses and sky do not move");
    assert!(count(142..206) > 2_000, "cars move");
    assert!(count(206..224) > 40, "the pedestrian moves");
    let noise = frames[0].pixels().iter().zip(frames[1].pixels()).take(224 * 128);
    let squares: u32 = noise.map(|(a, b)| u32::from(a.abs_diff(*b)).pow(2)).sum();
    assert!((60_000..140_000).contains(&squares), "two noises of 1.25 levels: {squares}");
}

#[test]
fn the_night_is_dark_noisy_and_wet() {
    let size = SceneParameters { width: 224, height: 224, bits: 8, region_size: 8, frames: 2 };
    let mean = |frame: &Frame| {
        frame.pixels().iter().map(|&p| u64::from(p)).sum::<u64>() / frame.pixels().len() as u64
    };
    let night: Vec<Frame> = Scene::NightRain.frames(size).collect();
    let day = Scene::Street.frames(size).next().unwrap();
    assert!(mean(&night[0]) * 3 < mean(&day));
    let changed = night[0].pixels().iter().zip(night[1].pixels());
    assert!(changed.filter(|(a, b)| a.abs_diff(**b) > 16).count() > 800, "rain falls");
}
