// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level model of the array, which also made the recording.

use std::hint::black_box;

use foveate_design::{Design, Organization};
use foveate_model::rcm_model;
use foveate_pixels::Frame;

use super::benchmark_report::{BenchmarkLevel, LevelMeasurement, LevelRow};
use super::clock_rates::clock_rates;
use super::outcome_comparison;
use super::pass_timer::PassTimer;
use super::peak_memory::InitialResidentSize;
use super::unpacked_inputs::{UnpackedInputs, compare_recording};
use crate::codec::RecordCodec;
use crate::error::CosimError;
use crate::recording::Recording;
use crate::timed_run::OutputAgreement;

/// Compares the model's decisions with the functional model and its outputs for the recorded inputs
/// with the recording, and then times it.
pub(super) fn run_cycle_level(
    design: &Design,
    frames: &[Frame],
    recording: &Recording,
    vectors: &UnpackedInputs,
    timer: PassTimer<'_>,
) -> Result<LevelRow, CosimError> {
    let decided =
        outcome_comparison::outcome_agreement(design, recording, frames, vectors.streamed_frames)?;
    let again = replay_agreement(design, recording, vectors)?;
    let before = InitialResidentSize::measure();
    let mut core = rcm_model(design);
    let time = timer.time_passes(|| {
        for input in vectors.inputs() {
            black_box(&mut core).clock(&input);
        }
        Ok(())
    })?;
    let peak_bytes = before.peak_bytes();
    let agreement = OutputAgreement {
        compared: decided.compared + again.compared,
        differing: decided.differing + again.differing,
    };
    let measured = LevelMeasurement { peak_bytes, ..clock_rates(design, vectors, time) };
    let measured = measured.with_agreement(BenchmarkLevel::FunctionalClear, agreement);
    Ok(LevelRow::measured(BenchmarkLevel::Cycle, type_name(design.organization()), measured))
}

/// Returns the name of the model's type.
fn type_name(organization: Organization) -> &'static str {
    match organization {
        Organization::Pipelined => "PipelinedRcm",
        Organization::Serial => "SerialRcm",
        Organization::Raster => "RasterRcm",
    }
}

fn replay_agreement(
    design: &Design,
    recording: &Recording,
    vectors: &UnpackedInputs,
) -> Result<OutputAgreement, CosimError> {
    let (mut core, mut codec) = (rcm_model(design), RecordCodec::new(design));
    let mut inputs = vectors.inputs();
    compare_recording(recording, |record| {
        if let Some(input) = inputs.next() {
            core.clock(&input);
            codec.encode_outputs(recording.outputs(), &*core, record);
        }
    })
}
