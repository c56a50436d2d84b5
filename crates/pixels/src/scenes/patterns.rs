// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hard cases, each a function of place and time ([`pattern_pixel`]), so any frame can be
//! made on its own.

use super::noise::{hash, pick};
use crate::scenes::{Scene, SceneParameters};

/// Number of frames from one switch of the light to the next.
const LIGHT_PERIOD: u32 = 8;

/// Returns the pixel at (`x`, `y`) of frame `t`. The street scenes are made elsewhere, so their
/// pixels are 0 here.
pub(crate) fn pattern_pixel(scene: Scene, size: &SceneParameters, t: u32, x: u32, y: u32) -> u32 {
    let max = size.pixel_max();
    match scene {
        Scene::Zero | Scene::Street | Scene::Shake | Scene::NightRain => 0,
        Scene::Max => max,
        Scene::Checkerboard => max * ((x + y + t / 2) & 1),
        Scene::HotPixels => hot_pixels(size, t, x, y),
        Scene::Ramps => ramps(size, t, x, y),
        Scene::HalfMeans => half_means(size, t, x, y),
        Scene::Flicker => (x + y) % max + (t & 1),
        Scene::Fade => fade(max, t, x, y),
        Scene::LightStep => checks(max / 2, x, y) + (max - max / 2) * ((t / LIGHT_PERIOD) & 1),
        Scene::OnePixel => one_pixel(size, t, x, y),
        Scene::LateChange => late_change(size, t, x, y),
        Scene::Random => {
            u32::try_from(hash(0xF0, t, x, y) & u64::from(max)).expect("at most the largest")
        }
    }
}

/// Returns a pixel of a checkerboard with checks of 4x4 pixels of levels 0 and `high`, which has
/// edges and corners in every region.
fn checks(high: u32, x: u32, y: u32) -> u32 {
    high * ((x / 4 + y / 4) & 1)
}

/// Returns a pixel of a half-grey frame, in which one corner pixel of every region is at an end of
/// the range. In eight frames each region has a hot and a dead pixel at each of its corners.
fn hot_pixels(size: &SceneParameters, t: u32, x: u32, y: u32) -> u32 {
    let n = size.region_size;
    let (column, row) = (x / n, y / n);
    let step = column + 3 * row + t;
    let corner = ((n - 1) * (step & 1), (n - 1) * (step >> 1 & 1));
    if (x % n, y % n) == corner {
        return size.pixel_max() * (step >> 2 & 1);
    }
    size.pixel_max() / 2
}

/// Returns a pixel of a ramp along x, along y or along the diagonal, or of a step, one for each
/// region, starting from 0. The slope grows by one level from region to region and from frame to
/// frame. So for any threshold there are a region that meets it exactly, a region one level below
/// it, and a region one level above it.
fn ramps(size: &SceneParameters, t: u32, x: u32, y: u32) -> u32 {
    let n = size.region_size;
    let (column, row) = (x / n, y / n);
    let slope = column + t;
    let (u, v) = (x % n, y % n);
    let height = match row % 4 {
        0 => slope * u,
        1 => slope * v,
        2 => slope * (u + v),
        _ => slope * u32::from(u >= n / 2),
    };
    height.min(size.pixel_max())
}

/// Returns a pixel of a region whose first pixels are one level above the others. Their number
/// makes the mean end in one half at some number of fraction bits. In the next frame their number
/// is one less than that, and in the frame after it one more.
fn half_means(size: &SceneParameters, t: u32, x: u32, y: u32) -> u32 {
    let n = size.region_size;
    let (column, row) = (x / n, y / n);
    let pixels = n * n;
    let halvings = 1 + (column + row) % pixels.ilog2();
    let half = pixels >> halvings;
    let raised = match t % 3 {
        0 => half,
        1 => half.saturating_sub(1),
        _ => half + 1,
    };
    let base = pick(0x4A1F, column, row, 0, size.pixel_max());
    base + u32::from((y % n) * n + x % n < raised)
}

/// Returns a pixel of a checkerboard of half contrast under a light that rises and falls by one
/// level per frame.
fn fade(max: u32, t: u32, x: u32, y: u32) -> u32 {
    let amplitude = max - max / 2;
    let phase = t % (2 * amplitude);
    checks(max / 2, x, y) + phase.min(2 * amplitude - phase)
}

/// Returns a pixel of a frame of a quarter of the largest level with one bright pixel, which moves
/// and is reflected at the borders.
fn one_pixel(size: &SceneParameters, t: u32, x: u32, y: u32) -> u32 {
    if (x, y) == (bouncing_position(t, size.width), bouncing_position(t, size.height)) {
        size.pixel_max()
    } else {
        size.pixel_max() / 4
    }
}

/// Returns a position that moves as 0, 1, ... `side` - 1 and back, forever.
fn bouncing_position(t: u32, side: u32) -> u32 {
    if side < 2 {
        return 0;
    }
    let phase = t % (2 * (side - 1));
    phase.min(2 * (side - 1) - phase)
}

/// Returns a pixel of a static checkerboard. In the last frame every second region is inverted.
fn late_change(size: &SceneParameters, t: u32, x: u32, y: u32) -> u32 {
    let still = checks(size.pixel_max(), x, y);
    let changed = (x / size.region_size + y / size.region_size).is_multiple_of(2);
    if t + 1 == size.frames && changed { size.pixel_max() - still } else { still }
}
