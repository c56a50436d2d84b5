// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level model of the array, which also made the recording.

use std::hint::black_box;

use foveate_cosim::{Agreement, Codec, Recording};
use foveate_design::{Design, Organization};
use foveate_frame::Frame;
use foveate_model::rcm;

use crate::error::BenchError;
use crate::memory::Before;
use crate::outcomes;
use crate::rate::per_clock;
use crate::report::{Level, LevelRow, Measured};
use crate::timer::Timer;
use crate::vectors::{Vectors, compare};

/// Compares the model's decisions with the functional model and its outputs for the recorded inputs
/// with the recording, and then times it.
pub(crate) fn cycle(
    design: &Design,
    frames: &[Frame],
    recording: &Recording,
    vectors: &Vectors,
    timer: Timer<'_>,
) -> Result<LevelRow, BenchError> {
    let decided = outcomes::agreement(design, recording, frames, vectors.streamed)?;
    let again = shown_agreement(design, recording, vectors)?;
    let before = Before::now();
    let mut core = rcm(design);
    let time = timer.time(|| {
        for input in vectors.inputs() {
            black_box(&mut core).clock(&input);
        }
        Ok(())
    })?;
    let peak_bytes = before.peak_bytes();
    let agreement = Agreement {
        compared: decided.compared + again.compared,
        differing: decided.differing + again.differing,
    };
    let measured = Measured { peak_bytes, ..per_clock(design, vectors, time) };
    let measured = measured.agrees(Level::FunctionalClear, agreement);
    Ok(LevelRow::of(Level::Cycle, type_name(design.organization()), measured))
}

/// Returns the name of the model's type.
fn type_name(organization: Organization) -> &'static str {
    match organization {
        Organization::Pipelined => "PipelinedRcm",
        Organization::Serial => "SerialRcm",
        Organization::Raster => "RasterRcm",
    }
}

fn shown_agreement(
    design: &Design,
    recording: &Recording,
    vectors: &Vectors,
) -> Result<Agreement, BenchError> {
    let (mut core, mut codec) = (rcm(design), Codec::new(design));
    let mut inputs = vectors.inputs();
    compare(recording, |record| {
        if let Some(input) = inputs.next() {
            core.clock(&input);
            codec.outputs(recording.outputs(), &*core, record);
        }
    })
}
