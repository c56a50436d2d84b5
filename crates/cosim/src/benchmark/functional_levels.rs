// SPDX-License-Identifier: MIT OR Apache-2.0
//! The levels that take whole frames: the clear model, and the engine that must give the same
//! results.

use std::hint::black_box;

use foveate_design::Design;
use foveate_engine::{Engine, EngineOptions, InstructionSet as Instructions};
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;

use super::benchmark_report::{BenchmarkLevel, LevelMeasurement, LevelRow};
use super::pass_timer::{PassTimer, PassTimes};
use super::peak_memory::InitialResidentSize;
use crate::error::CosimError;
use crate::timed_run::OutputAgreement;

/// Times [`FunctionalCamera`], the reference of all comparisons.
pub(super) fn run_model(
    design: &Design,
    frames: &[Frame],
    timer: PassTimer<'_>,
) -> Result<LevelRow, CosimError> {
    let before = InitialResidentSize::measure();
    let mut camera = FunctionalCamera::new(design);
    let time = timer.time_passes(|| {
        for frame in frames {
            black_box(camera.step(frame)?);
        }
        Ok(())
    })?;
    let measured =
        LevelMeasurement { peak_bytes: before.peak_bytes(), ..frame_rates(design, frames, time) };
    Ok(LevelRow::measured(BenchmarkLevel::FunctionalClear, "FunctionalCamera", measured))
}

/// Compares and times [`Engine`] on one thread. It may not skip regions that have not changed,
/// because the same frames are repeated, and a single frame would cost nothing.
pub(super) fn run_engine(
    design: &Design,
    frames: &[Frame],
    timer: PassTimer<'_>,
) -> Result<LevelRow, CosimError> {
    let agreement = engine_agreement(design, frames, frames)?;
    let before = InitialResidentSize::measure();
    let options =
        EngineOptions { threads: 1, skips_identical_regions: false, level: Instructions::detect() };
    let mut engine = Engine::with_options(design, options)?;
    let time = timer.time_passes(|| {
        for frame in frames {
            black_box(engine.step(frame)?);
        }
        Ok(())
    })?;
    let measured =
        LevelMeasurement { peak_bytes: before.peak_bytes(), ..frame_rates(design, frames, time) };
    Ok(LevelRow::measured(
        BenchmarkLevel::FunctionalFast,
        "Engine",
        measured.with_agreement(BenchmarkLevel::FunctionalClear, agreement),
    ))
}

/// Compares every result of every region and every pixel of the screen. The engine takes `fast`,
/// and the model takes `clear`.
fn engine_agreement(
    design: &Design,
    clear: &[Frame],
    fast: &[Frame],
) -> Result<OutputAgreement, CosimError> {
    let (mut camera, mut engine) = (FunctionalCamera::new(design), Engine::new(design));
    let mut agreement = OutputAgreement::default();
    for (clear, fast) in clear.iter().zip(fast) {
        let expected = camera.step(clear)?;
        let got = engine.step(fast)?;
        count_values(&mut agreement, &expected.srs, &got.srs);
        count_values(&mut agreement, &expected.trs, &got.trs);
        count_values(&mut agreement, &expected.active, &got.active);
        count_values(&mut agreement, &expected.actions, &got.actions);
        count_values(&mut agreement, &expected.temporal_count, &got.temporal_count);
        for (expected, got) in expected.scores.iter().zip(&got.scores) {
            count_values(&mut agreement, expected, got);
        }
        count_values(&mut agreement, expected.rendered.pixels(), &engine.rendered().to_words());
    }
    Ok(agreement)
}

fn count_values<T: PartialEq>(agreement: &mut OutputAgreement, expected: &[T], got: &[T]) {
    agreement.compared += expected.len() as u64;
    agreement.differing += expected.iter().zip(got).filter(|(a, b)| a != b).count() as u64;
    agreement.differing += expected.len().abs_diff(got.len()) as u64;
}

#[allow(clippy::cast_precision_loss, reason = "rates need no 53 bits")]
fn frame_rates(design: &Design, frames: &[Frame], time: PassTimes) -> LevelMeasurement {
    let frames_per_second = (time.passes * frames.len() as u64) as f64 / time.seconds;
    let pixels = f64::from(design.width()) * f64::from(design.height());
    LevelMeasurement {
        frames_per_second,
        pixels_per_second: frames_per_second * pixels,
        passes: time.passes,
        seconds: time.seconds,
        ..LevelMeasurement::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::benchmark::random_frames;
    use foveate_design::DesignConfig;

    #[test]
    fn an_engine_that_sees_something_else_is_noticed() {
        let design = DesignConfig::default().validate().unwrap();
        let frames = random_frames(&design, 1, 3).unwrap();
        let same = engine_agreement(&design, &frames, &frames).unwrap();
        assert_eq!(same.differing, 0);
        assert!(same.compared > 3 * 784 * 5, "{same:?}");
        let mut other = frames.clone();
        other.swap(0, 1);
        assert!(engine_agreement(&design, &frames, &other).unwrap().differing > 0);
    }
}
