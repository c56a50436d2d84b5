// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rates of a level with clocks.

use foveate_design::Design;

use super::benchmark_report::LevelMeasurement;
use super::pass_timer::PassTimes;
use super::unpacked_inputs::UnpackedInputs;

#[allow(clippy::cast_precision_loss, reason = "rates need no 53 bits")]
pub(super) fn clock_rates(
    design: &Design,
    vectors: &UnpackedInputs,
    time: PassTimes,
) -> LevelMeasurement {
    let passes_per_second = time.passes as f64 / time.seconds;
    let frames_per_second = vectors.streamed_frames as f64 * passes_per_second;
    let pixels = f64::from(design.width()) * f64::from(design.height());
    LevelMeasurement {
        frames_per_second,
        clocks_per_second: Some(vectors.clocks() as f64 * passes_per_second),
        pixels_per_second: frames_per_second * pixels,
        passes: time.passes,
        seconds: time.seconds,
        ..LevelMeasurement::default()
    }
}
