// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level models: [`PipelinedRcm`], [`SerialRcm`] and [`RasterRcm`]. The recording was made by them.

use std::hint::black_box;

use foveate_cosim::{Agreement, PipelinedCodec, RasterCodec, Recording, SerialCodec};
use foveate_design::{Design, Hardware, PipelinedDesign, RasterDesign, SerialDesign};
use foveate_frame::Frame;
use foveate_model::{PipelinedRcm, RasterInput, RasterRcm, RcmInput, SerialInput, SerialRcm};

use crate::error::BenchError;
use crate::memory::Before;
use crate::outcomes;
use crate::rate::per_clock;
use crate::report::{Level, LevelRow, Measured};
use crate::timer::Timer;
use crate::vectors::{Control, Vectors, compare};

/// Compares what they decide with the functional model, and what they show when the vectors come again
/// with the recording; then times them.
pub(crate) fn cycle(
    design: &Design,
    frames: &[Frame],
    recording: &Recording,
    vectors: &Vectors,
    timer: Timer<'_>,
) -> Result<LevelRow, BenchError> {
    let decided = outcomes::agreement(design, recording, frames, vectors.streamed)?;
    let (name, again, peak_bytes, time) = match design.hardware() {
        Hardware::Pipelined(own) => {
            let design = design.on(own);
            let again = pipelined_agreement(design, recording, vectors)?;
            let before = Before::now();
            let mut rcm = PipelinedRcm::new(design);
            let time = timer.time(|| {
                for (control, pixels) in vectors.words() {
                    black_box(rcm.step(&array_input(control, pixels)));
                }
                Ok(())
            })?;
            ("PipelinedRcm", again, before.peak_bytes(), time)
        }
        Hardware::Serial(own) => {
            let design = design.on(own);
            let again = serial_agreement(design, recording, vectors)?;
            let before = Before::now();
            let mut rcm = SerialRcm::new(design);
            let time = timer.time(|| {
                for (control, pixels) in vectors.words() {
                    black_box(rcm.step(&input(control, pixels)));
                }
                Ok(())
            })?;
            ("SerialRcm", again, before.peak_bytes(), time)
        }
        Hardware::Raster(own) => {
            let design = design.on(own);
            let again = raster_agreement(design, recording, vectors)?;
            let before = Before::now();
            let mut rcm = RasterRcm::new(design);
            let time = timer.time(|| {
                for (applied, references) in vectors.words().zip(vectors.references()) {
                    black_box(rcm.step(&core_input(applied, references)));
                }
                Ok(())
            })?;
            ("RasterRcm", again, before.peak_bytes(), time)
        }
    };
    let agreement = Agreement {
        compared: decided.compared + again.compared,
        differing: decided.differing + again.differing,
    };
    let measured = Measured { peak_bytes, ..per_clock(design, vectors, time) };
    Ok(LevelRow::of(Level::Cycle, name, measured.agrees(Level::FunctionalClear, agreement)))
}

fn pipelined_agreement(
    design: PipelinedDesign<'_>,
    recording: &Recording,
    vectors: &Vectors,
) -> Result<Agreement, BenchError> {
    let (mut rcm, codec) = (PipelinedRcm::new(design), PipelinedCodec::new(design));
    let mut inputs = vectors.words();
    compare(recording, |record| {
        if let Some((control, pixels)) = inputs.next() {
            rcm.step(&array_input(control, pixels));
            let sync_error = rcm.sync_error();
            codec.outputs(recording.outputs(), rcm.outputs(), sync_error, record);
        }
    })
}

fn array_input<'a>(control: &'a Control, pixels: &'a [u16]) -> RcmInput<'a> {
    let &Control { reset, valid, sof, ref thresholds, .. } = control;
    RcmInput { reset, valid, sof, pixels, thresholds }
}

fn serial_agreement(
    design: SerialDesign<'_>,
    recording: &Recording,
    vectors: &Vectors,
) -> Result<Agreement, BenchError> {
    let (mut rcm, codec) = (SerialRcm::new(design), SerialCodec::new(design));
    let mut inputs = vectors.words();
    compare(recording, |record| {
        if let Some((control, pixels)) = inputs.next() {
            codec.outputs(recording.outputs(), rcm.step(&input(control, pixels)), record);
        }
    })
}

fn input<'a>(control: &'a Control, pixels: &'a [u16]) -> SerialInput<'a> {
    let &Control { reset, valid, sof, ref thresholds, .. } = control;
    SerialInput { reset, valid, sof, pixels, thresholds }
}

fn raster_agreement(
    design: RasterDesign<'_>,
    recording: &Recording,
    vectors: &Vectors,
) -> Result<Agreement, BenchError> {
    let (mut rcm, codec) = (RasterRcm::new(design), RasterCodec::new(design));
    let mut inputs = vectors.words().zip(vectors.references());
    compare(recording, |record| {
        if let Some((applied, references)) = inputs.next() {
            let outputs = rcm.step(&core_input(applied, references));
            codec.outputs(recording.outputs(), outputs, record);
        }
    })
}

fn core_input<'a>(
    (control, pixels): (&'a Control, &'a [u16]),
    reference_pixels: &'a [u16],
) -> RasterInput<'a> {
    let &Control { reset, valid, sof, reference_valid, forward_ready, ref thresholds } = control;
    RasterInput {
        reset,
        valid,
        sof,
        pixels,
        reference_valid,
        reference_pixels,
        forward_ready,
        thresholds,
    }
}
