// SPDX-License-Identifier: MIT OR Apache-2.0
//! An ordinary event camera, for comparison: every pixel for itself, by a contrast threshold.
//!
//! A pixel remembers a level, at first that of the first frame. While its level now is a contrast C or
//! more above (below) that, it sends an event of polarity 1 (0) and moves what it remembers by C. So
//! one frame can bring several events of a pixel. All have the time of the frame: nothing is known
//! between frames, and nothing is made up. Without noise, in integers (millionths), so that the same
//! frames give the same events everywhere.

use foveate_camera::{Camera, Decimal};
use foveate_frame::Frame;

use super::PixelEvents;
use crate::SimulatorError;

/// Units of a level.
const UNIT: u64 = 1_000_000;
/// Below this grey level (of 255) a logarithmic pixel is linear, or one level of a dark pixel would be
/// a large change.
const LINEAR_UP_TO: f64 = 20.0;
/// The contrast of a logarithmic pixel where none is given, in millionths.
const LOG_CONTRAST: i64 = 200_000;
/// The smallest contrast, in millionths: a guard against events without end.
const SMALLEST_CONTRAST: i64 = 10_000;

/// What a pixel sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelEvent {
    /// Column of the pixel.
    pub x: u32,
    /// Row of the pixel.
    pub y: u32,
    /// Whether it became brighter.
    pub brighter: bool,
}

/// The pixels of such a camera.
#[derive(Clone, Debug)]
pub struct PixelCamera {
    contrast: i64,
    /// Level of every grey value.
    levels: Vec<i64>,
    /// What every pixel remembers; nothing before the first frame.
    remembered: Vec<i64>,
}

impl PixelCamera {
    /// A camera that has seen nothing yet.
    ///
    /// # Errors
    /// When the contrast is below 0.01.
    pub fn new(camera: &Camera, options: PixelEvents) -> Result<Self, SimulatorError> {
        let contrast = match options.contrast {
            Some(contrast) => millionths(contrast),
            None if options.log => LOG_CONTRAST,
            None => i64::from(camera.temporal().level + 1) * 1_000_000,
        };
        if contrast < SMALLEST_CONTRAST {
            let contrast = options.contrast.expect("those that nobody asked for are larger");
            return Err(SimulatorError::Contrast { contrast: contrast.to_string() });
        }
        let max = camera.pixel_max();
        let levels = (0..=max).map(|value| level(value, max, options.log)).collect();
        Ok(Self { contrast, levels, remembered: Vec::new() })
    }

    /// Takes the next frame and calls `send` with what it brings, row by row.
    pub fn step(&mut self, frame: &Frame, mut send: impl FnMut(PixelEvent)) {
        let now = frame.pixels().iter().map(|&pixel| self.levels[usize::from(pixel)]);
        if self.remembered.is_empty() {
            self.remembered = now.collect();
            return;
        }
        let places = (0..frame.height()).flat_map(|y| (0..frame.width()).map(move |x| (x, y)));
        for ((remembered, now), (x, y)) in self.remembered.iter_mut().zip(now).zip(places) {
            let steps = (now - *remembered) / self.contrast;
            *remembered += steps * self.contrast;
            for _ in 0..steps.unsigned_abs() {
                send(PixelEvent { x, y, brighter: steps > 0 });
            }
        }
    }
}

fn millionths(contrast: Decimal) -> i64 {
    i64::try_from(contrast.ceil_times(UNIT)).unwrap_or(i64::MAX)
}

/// The level of a grey value: itself, or the logarithm of its share of 255 above a linear foot.
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
