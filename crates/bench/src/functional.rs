// SPDX-License-Identifier: MIT OR Apache-2.0
//! The levels that take whole frames: the clear model, and the engine that must give the same
//! results.

use std::hint::black_box;

use foveate_cosim::Agreement;
use foveate_design::Design;
use foveate_engine::{Engine, Level as Instructions, Options};
use foveate_frame::Frame;
use foveate_model::FunctionalCamera;

use crate::error::BenchError;
use crate::memory::Before;
use crate::report::{Level, LevelRow, Measured};
use crate::timer::{Time, Timer};

/// Times [`FunctionalCamera`], the reference of all comparisons.
pub(crate) fn clear(
    design: &Design,
    frames: &[Frame],
    timer: Timer<'_>,
) -> Result<LevelRow, BenchError> {
    let before = Before::now();
    let mut camera = FunctionalCamera::new(design);
    let time = timer.time(|| {
        for frame in frames {
            black_box(camera.step(frame)?);
        }
        Ok(())
    })?;
    let measured = Measured { peak_bytes: before.peak_bytes(), ..per_frame(design, frames, time) };
    Ok(LevelRow::of(Level::FunctionalClear, "FunctionalCamera", measured))
}

/// Compares and times [`Engine`] on one thread. It may not skip regions that have not changed,
/// because the same frames are repeated, and a single frame would cost nothing.
pub(crate) fn fast(
    design: &Design,
    frames: &[Frame],
    timer: Timer<'_>,
) -> Result<LevelRow, BenchError> {
    let agreement = agreement(design, frames, frames)?;
    let before = Before::now();
    let options = Options { threads: 1, skip: false, level: Instructions::detect() };
    let mut engine = Engine::with_options(design, options)?;
    let time = timer.time(|| {
        for frame in frames {
            black_box(engine.step(frame)?);
        }
        Ok(())
    })?;
    let measured = Measured { peak_bytes: before.peak_bytes(), ..per_frame(design, frames, time) };
    Ok(LevelRow::of(
        Level::FunctionalFast,
        "Engine",
        measured.agrees(Level::FunctionalClear, agreement),
    ))
}

/// Compares every result of every region and every pixel of the screen. The engine takes `fast`,
/// and the model takes `clear`.
fn agreement(design: &Design, clear: &[Frame], fast: &[Frame]) -> Result<Agreement, BenchError> {
    let (mut camera, mut engine) = (FunctionalCamera::new(design), Engine::new(design));
    let mut agreement = Agreement::default();
    for (clear, fast) in clear.iter().zip(fast) {
        let expected = camera.step(clear)?;
        let got = engine.step(fast)?;
        count(&mut agreement, &expected.srs, &got.srs);
        count(&mut agreement, &expected.trs, &got.trs);
        count(&mut agreement, &expected.active, &got.active);
        count(&mut agreement, &expected.actions, &got.actions);
        count(&mut agreement, &expected.temporal_count, &got.temporal_count);
        for (expected, got) in expected.scores.iter().zip(&got.scores) {
            count(&mut agreement, expected, got);
        }
        count(&mut agreement, expected.rendered.pixels(), &engine.rendered().to_words());
    }
    Ok(agreement)
}

fn count<T: PartialEq>(agreement: &mut Agreement, expected: &[T], got: &[T]) {
    agreement.compared += expected.len() as u64;
    agreement.differing += expected.iter().zip(got).filter(|(a, b)| a != b).count() as u64;
    agreement.differing += expected.len().abs_diff(got.len()) as u64;
}

#[allow(clippy::cast_precision_loss, reason = "rates need no 53 bits")]
fn per_frame(design: &Design, frames: &[Frame], time: Time) -> Measured {
    let frames_per_second = (time.passes * frames.len() as u64) as f64 / time.seconds;
    let pixels = f64::from(design.width()) * f64::from(design.height());
    Measured {
        frames_per_second,
        pixels_per_second: frames_per_second * pixels,
        passes: time.passes,
        seconds: time.seconds,
        ..Measured::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::random_frames;
    use foveate_design::Config;

    #[test]
    fn an_engine_that_sees_something_else_is_noticed() {
        let design = Config::default().validate().unwrap();
        let frames = random_frames(&design, 1, 3).unwrap();
        let same = agreement(&design, &frames, &frames).unwrap();
        assert_eq!(same.differing, 0);
        assert!(same.compared > 3 * 784 * 5, "{same:?}");
        let mut other = frames.clone();
        other.swap(0, 1);
        assert!(agreement(&design, &frames, &other).unwrap().differing > 0);
    }
}
