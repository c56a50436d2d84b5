// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clips with the changes that matter between two frames: noise, no change, small changes, flat and
//! stepped areas.

use foveate_camera::Camera;
use foveate_pixels::Frame;
use proptest::prelude::*;

#[derive(Clone, Copy, Debug)]
pub(crate) enum FrameChange {
    /// Every pixel is new.
    Noise,
    /// No pixel changes.
    Still,
    /// One pixel changes, at these fractions of width and height.
    Spot(f64, f64),
    /// A square of a quarter of the width is new.
    Patch(f64, f64),
    /// A square of a quarter of the width gets one value, so that relevant regions become
    /// irrelevant.
    Wipe(f64, f64),
    /// All pixels get one value.
    Flat,
    /// The pixels get two values, so that hits and ties are many.
    Binary,
    /// Every pixel rises by one level.
    Fade,
    /// The frame moves by this many columns and rows.
    Move(i64, i64),
}

pub(crate) fn scripts() -> impl Strategy<Value = (u64, Vec<FrameChange>)> {
    let place = || (0.0..1.0f64, 0.0..1.0f64);
    let change = prop_oneof![
        2 => Just(FrameChange::Noise),
        5 => Just(FrameChange::Still),
        3 => place().prop_map(|(x, y)| FrameChange::Spot(x, y)),
        2 => place().prop_map(|(x, y)| FrameChange::Patch(x, y)),
        2 => place().prop_map(|(x, y)| FrameChange::Wipe(x, y)),
        1 => Just(FrameChange::Flat),
        1 => Just(FrameChange::Binary),
        1 => Just(FrameChange::Fade),
        2 => (-3..=3i64, -3..=3i64).prop_map(|(dx, dy)| FrameChange::Move(dx, dy)),
    ];
    (any::<u64>(), proptest::collection::vec(change, 2..9))
}

/// Returns the frames of a script. The first frame is noise.
pub(crate) fn clip(camera: &Camera, seed: u64, script: &[FrameChange]) -> Vec<Frame> {
    let mut random = RandomNumbers(seed | 1);
    let (width, height, bits) = (camera.width(), camera.height(), camera.pixel_bits());
    let max = u16::try_from(camera.pixel_max()).unwrap();
    let mut pixels: Vec<u16> = (0..width * height).map(|_| random.below(max)).collect();
    let mut frames = vec![Frame::new(width, height, bits, pixels.clone()).unwrap()];
    for &change in script {
        let area = (f64::from(width), f64::from(height));
        match change {
            FrameChange::Still => {}
            FrameChange::Noise => pixels.fill_with(|| random.below(max)),
            FrameChange::Flat => pixels.fill(random.below(max)),
            FrameChange::Binary => {
                let values = [random.below(max), random.below(max)];
                pixels.fill_with(|| values[usize::from(random.below(1))]);
            }
            FrameChange::Fade => pixels.iter_mut().for_each(|p| *p = p.saturating_add(1).min(max)),
            FrameChange::Move(dx, dy) => {
                let last = Frame::new(width, height, bits, pixels.clone()).unwrap();
                let moved = |x: u32, y: u32| last.get_clamped(i64::from(x) - dx, i64::from(y) - dy);
                pixels = Frame::from_fn(width, height, bits, moved).unwrap().pixels().to_vec();
            }
            FrameChange::Spot(x, y) | FrameChange::Patch(x, y) | FrameChange::Wipe(x, y) => {
                let wiped = matches!(change, FrameChange::Wipe(..)).then(|| random.below(max));
                let side = if matches!(change, FrameChange::Spot(..)) { 1 } else { width / 4 + 1 };
                let (x, y) = (floor_to_u32(x * area.0), floor_to_u32(y * area.1));
                for y in y..(y + side).min(height) {
                    for x in x..(x + side).min(width) {
                        let at = usize::try_from(y * width + x).unwrap();
                        pixels[at] = wiped.unwrap_or_else(|| random.below(max));
                    }
                }
            }
        }
        frames.push(Frame::new(width, height, bits, pixels.clone()).unwrap());
    }
    frames
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 <= x < width")]
fn floor_to_u32(x: f64) -> u32 {
    x as u32
}

/// A small generator of random numbers that is the same on every machine.
struct RandomNumbers(u64);

impl RandomNumbers {
    /// Returns a number in `0..=max`.
    fn below(&mut self, max: u16) -> u16 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        u16::try_from((self.0 >> 20) % (u64::from(max) + 1)).unwrap()
    }
}
