// SPDX-License-Identifier: MIT OR Apache-2.0
//! The levels that are Rust in this process: the clear model ([`run_model`]), the engine
//! ([`run_engine`]), the cycle-level model ([`run_cycle_level`]) and the timed model
//! ([`run_transaction_level`]). All but the first are compared with it or with the recording
//! before they are timed.

use super::benchmark_report::{BenchmarkLevel, LevelMeasurement, LevelRow};
use super::netlist_level::clock_rates;
use super::outcome_comparison;
use super::pass_timer::{InitialResidentSize, PassTimer, PassTimes};
use super::unpacked_inputs::{UnpackedInputs, compare_recording, field_of_role, for_each_clock};
use crate::codec::RecordCodec;
use crate::error::CosimError;
use crate::layout::{RecordField, RecordLayout};
use crate::recording::Recording;
use crate::timed_run::OutputAgreement;
use foveate_design::{Design, Hardware, Organization, PortRole};
use foveate_engine::{Engine, EngineOptions, FrameOutcome, InstructionSet as Instructions};
use foveate_model::{FunctionalCamera, rcm_model};
use foveate_pixels::{ByteFrame, Frame};
use foveate_timed::{
    BeatOffer, DecisionRun, FrameDelivery, ReadySink, StallList, TimedModel, Transaction, WordRun,
};
use std::hint::black_box;
use std::ops::Range;

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

/// A value at a port of a region: its clock, the number of the region, the port and the value.
type PortValue = (u64, u32, ComparedPort, u64);

/// The ports whose values are compared. Others have a meaning only with these.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum ComparedPort {
    Srs,
    Trs,
    Active,
    ForwardPixel,
}

/// Compares the model's decisions and words at their clocks with the recording, and then times it.
/// It may not skip regions that have not changed, as the engine may not.
pub(super) fn run_transaction_level(
    design: &Design,
    frames: &[Frame],
    recording: &Recording,
    vectors: &UnpackedInputs,
    timer: PassTimer<'_>,
) -> Result<LevelRow, CosimError> {
    let frames: Vec<ByteFrame> = frames.iter().map(ByteFrame::from).collect();
    let agreement = port_agreement(design, &frames, recording)?;
    let before = InitialResidentSize::measure();
    let options = EngineOptions { skips_identical_regions: false, ..EngineOptions::default() };
    let mut model = TimedModel::with_options(design, options, Box::new(ReadySink))?;
    let time = timer.time_passes(|| {
        for number in 0..vectors.streamed_frames {
            let delivery =
                FrameDelivery::whole(frame_of_number(&frames, number)?.borrowed_pixels());
            model.step(&delivery, &mut |transaction| {
                black_box(transaction);
            })?;
        }
        Ok(())
    })?;
    let peak_bytes = before.peak_bytes();
    let measured = LevelMeasurement { peak_bytes, ..clock_rates(design, vectors, time) };
    let measured = measured.with_agreement(BenchmarkLevel::Cycle, agreement);
    Ok(LevelRow::measured(BenchmarkLevel::Transactions, "TimedModel", measured))
}

/// Returns a frame of the recording, which repeats the last one.
fn frame_of_number(frames: &[ByteFrame], number: u64) -> Result<&ByteFrame, CosimError> {
    let number = usize::try_from(number).unwrap_or(usize::MAX);
    frames.get(number.min(frames.len() - 1)).ok_or(CosimError::NoFrames)
}

/// Compares every decision and every word at its clock.
fn port_agreement(
    design: &Design,
    frames: &[ByteFrame],
    recording: &Recording,
) -> Result<OutputAgreement, CosimError> {
    let traffic = RecordedTraffic::read(design, recording)?;
    let expected = recorded_values(design, recording)?;
    let mut model = TimedModel::new(design, Box::new(StallList::new(traffic.stalls)));
    let mut values = Vec::new();
    let mut visit = |transaction: &Transaction<'_>| match transaction {
        Transaction::Decisions(run) => append_decisions(run, &mut values),
        Transaction::Words(run) => append_words(design, run, &mut values),
        Transaction::Scores(_) | Transaction::Loss(_) | Transaction::SyncError { .. } => {}
    };
    for (number, offers) in (0..).zip(&traffic.offers) {
        let pixels = frame_of_number(frames, number)?.borrowed_pixels();
        model.step(&FrameDelivery { offers, ..FrameDelivery::whole(pixels) }, &mut visit)?;
    }
    model.finish(&mut visit);
    values.retain(|(clock, ..)| *clock < recording.clocks());
    values.sort_unstable();
    let is_equal = |value: &&PortValue| values.binary_search(value).is_ok();
    let equal = expected.iter().filter(is_equal).count();
    let compared = expected.len().max(values.len());
    Ok(OutputAgreement { compared: compared as u64, differing: (compared - equal) as u64 })
}

fn append_decisions(run: &DecisionRun<'_>, values: &mut Vec<PortValue>) {
    let FrameOutcome { srs, trs, active, .. } = run.outcome;
    for (clock, region) in run.regions.iter() {
        let bits =
            [(ComparedPort::Srs, srs), (ComparedPort::Trs, trs), (ComparedPort::Active, active)];
        values.extend(bits.map(|(port, bits)| (clock, region, port, bits[region as usize].into())));
    }
}

fn append_words(design: &Design, run: &WordRun<'_>, values: &mut Vec<PortValue>) {
    let port_pixels = match design.hardware() {
        Hardware::Pipelined(_) | Hardware::Serial(_) => 1,
        Hardware::Raster(own) => own.pixels_per_clock as usize,
    };
    let mut pixels = Vec::new();
    for (clock, region) in run.senders() {
        pixels.clear();
        run.append_values(region, &mut pixels);
        let words = pixels.chunks_exact((pixels.len() / run.words as usize).max(1));
        values.extend((0..).zip(words).map(|(place, word)| {
            // The left pixel has the lowest bits. A mean is on all pixels of the port.
            let shifts = (0..).step_by(design.pixel_bits() as usize);
            let pixels = shifts.zip(word.iter().cycle().take(port_pixels));
            let value = pixels.map(|(shift, &pixel)| u64::from(pixel) << shift).sum();
            (clock + place * run.word_step, region, ComparedPort::ForwardPixel, value)
        }));
    }
}

/// Returns the decisions and the words of a recording.
fn recorded_values(design: &Design, recording: &Recording) -> Result<Vec<PortValue>, CosimError> {
    let (mut clock, mut values, mut is_word_waiting) = (0, Vec::new(), false);
    let sink = field_of_role(recording.inputs(), PortRole::ForwardReady);
    for_each_clock(recording, |input, record| {
        let record = OutputRecord { design, layout: recording.outputs(), record };
        record.append_decisions(clock, &mut values);
        // A word stays on the ports until the sink takes it.
        let is_taken = sink.is_none_or(|field| field.get(input, 0) == 1);
        if is_taken || !is_word_waiting {
            record.append_words(clock, &mut values);
        }
        is_word_waiting = record.value(PortRole::ForwardValid, 0) == Some(1);
        clock += 1;
    })?;
    Ok(values)
}

/// The outputs at one clock of a recording.
struct OutputRecord<'a> {
    design: &'a Design,
    layout: &'a RecordLayout,
    record: &'a [u8],
}

impl OutputRecord<'_> {
    /// Returns the value of an output, or `None` if the core does not have it.
    fn value(&self, role: PortRole, lane: u32) -> Option<u64> {
        field_of_role(self.layout, role).map(|field| field.get(self.record, lane))
    }

    /// Returns the value of an output that has the number of a region or of a slot.
    fn number(&self, role: PortRole) -> Option<u32> {
        self.value(role, 0).and_then(|number| u32::try_from(number).ok())
    }

    fn append_decisions(&self, clock: u64, values: &mut Vec<PortValue>) {
        if self.value(PortRole::DecisionValid, 0) != Some(1) {
            return;
        }
        let number = self.number(PortRole::Region);
        // Without a port for the number of the region, all regions are decided together.
        let lanes = if number.is_some() { 1 } else { self.design.regions() };
        for lane in 0..lanes {
            let ports = [
                (ComparedPort::Srs, PortRole::Srs),
                (ComparedPort::Trs, PortRole::Trs),
                (ComparedPort::Active, PortRole::Active),
            ];
            let region = number.unwrap_or(lane);
            let value = |role| self.value(role, lane).unwrap_or_default();
            values.extend(ports.map(|(port, role)| (clock, region, port, value(role))));
        }
    }

    fn append_words(&self, clock: u64, values: &mut Vec<PortValue>) {
        let lanes = field_of_role(self.layout, PortRole::ForwardValid);
        for lane in 0..lanes.map_or(0, |field| field.port.lanes) {
            if self.value(PortRole::ForwardValid, lane) == Some(1) {
                let slot = self.number(PortRole::ForwardSlot).unwrap_or_default();
                let region = self.number(PortRole::ForwardRegion);
                let region = region.unwrap_or(lane * self.design.slots() + slot);
                let value = self.value(PortRole::ForwardPixel, lane).unwrap_or_default();
                values.push((clock, region, ComparedPort::ForwardPixel, value));
            }
        }
    }
}

/// The pauses of the source and the stalls of the sink in a recording.
#[derive(Debug, Default)]
struct RecordedTraffic {
    /// The pauses of each frame. The last frame may be cut.
    offers: Vec<Vec<BeatOffer>>,
    stalls: Vec<Range<u64>>,
}

impl RecordedTraffic {
    fn read(design: &Design, recording: &Recording) -> Result<Self, CosimError> {
        let input = |role| field_of_role(recording.inputs(), role);
        let [valid, reset, sink] =
            [PortRole::Valid, PortRole::Reset, PortRole::ForwardReady].map(input);
        let ready = field_of_role(recording.outputs(), PortRole::Ready);
        let beats = design.timing().pixels_per_frame();
        let (mut traffic, mut clock, mut taken) = (Self::default(), 0, 0);
        // The source pauses if it offers nothing although the core would take a beat.
        let (mut is_ready, mut has_paused) = (true, true);
        for_each_clock(recording, |input, output| {
            let is_high = |field: Option<&RecordField>, default| {
                field.map_or(default, |field| field.get(input, 0) == 1)
            };
            if !is_high(sink, true) {
                traffic.stalls.push(clock..clock + 1);
            }
            let is_in_reset = is_high(reset, false);
            if is_ready && is_high(valid, true) && !is_in_reset {
                if taken % beats == 0 {
                    traffic.offers.push(Vec::new());
                }
                if let Some(offers) = traffic.offers.last_mut()
                    && has_paused
                {
                    offers.push(BeatOffer { beat: taken % beats, clock });
                }
                taken += 1;
                has_paused = false;
            } else {
                has_paused |= is_ready;
            }
            is_ready = ready.is_none_or(|field| field.get(output, 0) == 1);
            clock += 1;
        })?;
        if let (rest @ 1.., Some(offers)) = (taken % beats, traffic.offers.last_mut()) {
            offers.push(BeatOffer { beat: rest, clock: u64::MAX });
        }
        Ok(traffic)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::benchmark::random_frames;
    use crate::level::CosimLevel;
    use crate::stimulus::Stimulus;
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

    #[test]
    fn decisions_and_words_of_other_frames_are_noticed() {
        for keys in [
            "frame={width=16,height=16}",
            "frame={width=16,height=16}\nhardware={organization='serial',fold=2}",
            "frame={width=40,height=30}\nhardware={organization='raster',sync=true}",
        ] {
            let design = DesignConfig::from_toml(keys).unwrap().validate().unwrap();
            let frames = random_frames(&design, 1, 3).unwrap();
            let stimulus = Stimulus {
                level: CosimLevel::Full,
                rounds: 0,
                frames: frames.clone(),
                ..Stimulus::default()
            };
            let recording = stimulus.record(&design, &mut |_, _| {}).unwrap();
            let mut frames: Vec<ByteFrame> = frames.iter().map(ByteFrame::from).collect();
            let same = port_agreement(&design, &frames, &recording).unwrap();
            assert_eq!((same.differing, same.compared > 500), (0, true), "{same:?}, {keys}");
            frames.swap(0, 1);
            let other = port_agreement(&design, &frames, &recording).unwrap();
            assert!(other.differing > 0, "{keys}");
        }
    }
}
