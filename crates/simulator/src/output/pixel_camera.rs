// SPDX-License-Identifier: MIT OR Apache-2.0
//! An ordinary event camera, for comparison: every pixel works independently, with a contrast
//! threshold.
//!
//! A pixel stores a level, at first that of the first frame. While its current level is at least
//! the contrast C above (below) the stored level, it sends an event of polarity 1 (0) and moves the
//! stored level by C. So one frame can give several events of a pixel. All of them have the time of
//! the frame, because nothing is known about the time between frames. There is no noise, and all
//! arithmetic on levels is in integers (millionths), so that the same frames give the same events
//! everywhere.

use foveate_camera::{Camera, Decimal};
use foveate_pixels::Frame;

use super::PixelEventOptions;
use crate::SimulatorError;

/// The number of units of one level.
const UNIT: u64 = 1_000_000;
/// The grey level (of 255) up to which a logarithmic pixel is linear. Otherwise one level of a dark
/// pixel would be a large change.
const LINEAR_UP_TO: f64 = 20.0;
/// The default contrast of a logarithmic pixel, in millionths.
const LOG_CONTRAST: i64 = 200_000;
/// The smallest contrast, in millionths. It bounds the number of events.
const SMALLEST_CONTRAST: i64 = 10_000;

/// An event of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelEvent {
    /// The column of the pixel.
    pub x: u32,
    /// The row of the pixel.
    pub y: u32,
    /// True if the pixel became brighter.
    pub brighter: bool,
}

impl PixelEvent {
    /// Appends the event, with its time, as an element of a structured array of NumPy with the
    /// fields and types of tonic: `x` and `y` (`<i2`), `t` (`<i8`) and `p` (`|b1`), 13 bytes in all.
    pub fn append_record(self, time_us: u64, bytes: &mut Vec<u8>) {
        // Coordinates stay below 2^14.
        bytes.extend(self.x.to_le_bytes().into_iter().take(2));
        bytes.extend(self.y.to_le_bytes().into_iter().take(2));
        bytes.extend(time_us.to_le_bytes());
        bytes.push(u8::from(self.brighter));
    }
}

/// The pixels of an ordinary event camera.
#[derive(Clone, Debug)]
pub struct PixelCamera {
    contrast: i64,
    /// The level of every grey value.
    levels: Vec<i64>,
    /// The stored level of every pixel. It is empty before the first frame.
    stored_levels: Vec<i64>,
}

impl PixelCamera {
    /// Makes a camera that has not taken a frame yet.
    ///
    /// # Errors
    /// Fails if the contrast is below 0.01.
    pub fn new(camera: &Camera, options: PixelEventOptions) -> Result<Self, SimulatorError> {
        let contrast = match options.contrast {
            Some(contrast) => millionths(contrast),
            None if options.is_logarithmic => LOG_CONTRAST,
            None => i64::from(camera.temporal().level + 1) * 1_000_000,
        };
        if contrast < SMALLEST_CONTRAST {
            let contrast = options.contrast.expect("those that nobody asked for are larger");
            return Err(SimulatorError::Contrast { contrast: contrast.to_string() });
        }
        let max = camera.pixel_max();
        let levels = (0..=max).map(|value| level(value, max, options.is_logarithmic)).collect();
        Ok(Self { contrast, levels, stored_levels: Vec::new() })
    }

    /// Takes the next frame and calls `send` with its events, row by row.
    pub fn step(&mut self, frame: &Frame, mut send: impl FnMut(PixelEvent)) {
        let present = frame.pixels().iter().map(|&pixel| self.levels[usize::from(pixel)]);
        if self.stored_levels.is_empty() {
            self.stored_levels = present.collect();
            return;
        }
        let places = (0..frame.height()).flat_map(|y| (0..frame.width()).map(move |x| (x, y)));
        for ((stored, present), (x, y)) in self.stored_levels.iter_mut().zip(present).zip(places) {
            let steps = (present - *stored) / self.contrast;
            *stored += steps * self.contrast;
            for _ in 0..steps.unsigned_abs() {
                send(PixelEvent { x, y, brighter: steps > 0 });
            }
        }
    }
}

fn millionths(contrast: Decimal) -> i64 {
    i64::try_from(contrast.ceil_times(UNIT)).unwrap_or(i64::MAX)
}

/// Returns the level of a grey value: the value itself, or the logarithm of its share of 255 with a
/// linear part near 0.
#[allow(clippy::cast_possible_truncation, reason = "at most 5.6 million")]
fn level(value: u32, max: u32, log: bool) -> i64 {
    if !log {
        return i64::from(value) * 1_000_000;
    }
    let grey = f64::from(value) * 255.0 / f64::from(max);
    let level =
        if grey <= LINEAR_UP_TO { grey * LINEAR_UP_TO.ln() / LINEAR_UP_TO } else { grey.ln() };
    (level * 1e6).round() as i64
}
