// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fast cycle-level model, [`PipelinedArray`], over the same clocks.

use std::hint::black_box;

use foveate_array::PipelinedArray;
use foveate_cosim::{Agreement, PipelinedCodec, Recording};
use foveate_design::PipelinedDesign;
use foveate_model::{FrameSync, RpuOutput};

use crate::error::BenchError;
use crate::memory::Before;
use crate::rate::per_clock;
use crate::report::{Level, Measured, Row};
use crate::timer::Timer;
use crate::vectors::{Vectors, compare};

pub(crate) const NAME: &str = "PipelinedArray";

/// Compares every port at every clock, then times it.
pub(crate) fn fast(
    design: PipelinedDesign<'_>,
    recording: &Recording,
    vectors: &Vectors,
    timer: Timer<'_>,
) -> Result<Row, BenchError> {
    let agreement = agreement(design, recording, vectors)?;
    let before = Before::now();
    let (mut array, mut sync) = (PipelinedArray::new(design), FrameSync::new(&design));
    let time = timer.time(|| {
        match vectors.bytes() {
            Some(clocks) => {
                for (control, pixels) in clocks {
                    let (reset, valid) = (control.reset, control.reaches(&mut sync));
                    black_box(array.step_u8(reset, valid, pixels, &control.thresholds));
                }
            }
            None => {
                for (control, pixels) in vectors.words() {
                    let (reset, valid) = (control.reset, control.reaches(&mut sync));
                    black_box(array.step(reset, valid, pixels, &control.thresholds));
                }
            }
        }
        Ok(())
    })?;
    let peak_bytes = before.peak_bytes();
    let measured = Measured { peak_bytes, ..per_clock(&design, vectors, time) };
    Ok(Row::of(Level::CycleFast, NAME, measured.agrees(Level::CycleClear, agreement)))
}

fn agreement(
    design: PipelinedDesign<'_>,
    recording: &Recording,
    vectors: &Vectors,
) -> Result<Agreement, BenchError> {
    let (mut array, codec) = (PipelinedArray::new(design), PipelinedCodec::new(design));
    let (mut words, mut bytes) = (vectors.words(), vectors.bytes());
    let mut sync = FrameSync::new(&design);
    let mut rpus: Vec<RpuOutput> = Vec::new();
    compare(recording, |record| {
        // The same calls as those that are timed.
        let shown = match &mut bytes {
            Some(bytes) => bytes.next().map(|(control, pixels)| {
                let valid = control.reaches(&mut sync);
                array.step_u8(control.reset, valid, pixels, &control.thresholds)
            }),
            None => words.next().map(|(control, pixels)| {
                let valid = control.reaches(&mut sync);
                array.step(control.reset, valid, pixels, &control.thresholds)
            }),
        };
        if let Some(shown) = shown {
            rpus.clear();
            rpus.extend((0..design.regions() as usize).map(|region| shown.rpu(region)));
            codec.outputs(recording.outputs(), &rpus, sync.is_error(), record);
        }
    })
}
