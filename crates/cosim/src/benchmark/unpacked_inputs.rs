// SPDX-License-Identifier: MIT OR Apache-2.0
//! The data that all levels of a benchmark get: random frames, on which no level can skip work
//! ([`random_frames`]), and the inputs at every clock of a recording of them, unpacked into
//! memory ([`UnpackedInputs`]).

use crate::error::CosimError;
use crate::layout::{RecordField, RecordLayout};
use crate::recording::{Recording, open_buffered};
use crate::timed_run::OutputAgreement;
use foveate_camera::RegionClass;
use foveate_design::{Design, PortRole};
use foveate_model::{ClassMapInputs, CoreInput, ThresholdInputs, ZoneInputs};
use foveate_pixels::{Frame, FrameError};
use std::io::Read as _;

/// The inputs of every clock.
#[derive(Debug)]
pub(super) struct UnpackedInputs {
    controls: Vec<ClockControls>,
    pixels: Vec<u16>,
    /// The pixels at the port of references, if the core has one.
    references: Vec<u16>,
    /// The number of pixels at the port per clock.
    width: usize,
    /// The number of frames that the core takes.
    pub(super) streamed_frames: u64,
}

/// The inputs of one clock, except its pixels.
#[derive(Clone, Debug)]
struct ClockControls {
    reset: bool,
    valid: bool,
    /// The pixel is the first of a frame, if the core has a port for this.
    is_start_of_frame: bool,
    /// The reference is valid, if the core has a port for this.
    reference_valid: bool,
    /// The sink takes forwarded pixels, if the core has a port for this.
    forward_ready: bool,
    thresholds: ThresholdInputs,
    zones: Option<ClockZones>,
}

/// The inputs of one clock that only a core with zones has.
#[derive(Clone, Debug)]
struct ClockZones {
    classes: Vec<RegionClass>,
    map: ClassMapInputs,
    keen: ThresholdInputs,
    off_summary_level: u32,
}

impl UnpackedInputs {
    pub(super) fn read(design: &Design, recording: &Recording) -> Result<Self, CosimError> {
        let layout = recording.inputs();
        let pixel = field_of_role(layout, PortRole::Pixel).expect("an array takes pixels");
        let ready = field_of_role(recording.outputs(), PortRole::Ready);
        let held = (pixel.port.bits() / design.pixel_bits()) as usize;
        let reference = field_of_role(layout, PortRole::ReferencePixel);
        let (mut controls, mut pixels, mut references) = (Vec::new(), Vec::new(), Vec::new());
        let (mut is_ready, mut taken) = (true, 0);
        for_each_clock(recording, |input, expected| {
            let control = ClockControls::from_record(design, layout, input);
            taken += u64::from(control.valid && is_ready && !control.reset);
            is_ready = ready.is_none_or(|field| field.get(expected, 0) == 1);
            controls.push(control);
            let narrow = |value: u64| u16::try_from(value).expect("a pixel has at most 16 bits");
            pixels.extend(pixel.lane_pixels(input, held).map(narrow));
            let words = reference.into_iter().flat_map(|port| port.lane_pixels(input, held));
            references.extend(words.map(narrow));
        })?;
        Ok(Self {
            width: pixels.len() / controls.len().max(1),
            streamed_frames: taken / design.timing().pixels_per_frame(),
            controls,
            pixels,
            references,
        })
    }

    pub(super) fn clocks(&self) -> u64 {
        self.controls.len() as u64
    }

    /// Returns the inputs of every clock.
    pub(super) fn inputs(&self) -> impl Iterator<Item = CoreInput<'_>> {
        let reference_width = if self.references.is_empty() { 0 } else { self.width };
        let pixels = self.pixels.chunks_exact(self.width.max(1));
        self.controls.iter().zip(pixels).enumerate().map(move |(clock, (control, pixels))| {
            let references = &self.references[clock * reference_width..][..reference_width];
            control.core_input(pixels, references)
        })
    }
}

impl ClockControls {
    fn from_record(design: &Design, layout: &RecordLayout, input: &[u8]) -> Self {
        let mut thresholds = ThresholdInputs::from_camera(design);
        let mut zones = ClockZones::of_design(design);
        let (mut reset, mut valid, mut forward_ready) = (false, false, true);
        let (mut sof, mut reference_valid) = (false, false);
        let place = |kind| design.features().iter().position(|feature| feature.kind() == kind);
        let word = |value: u64| u32::try_from(value).expect("a level has at most 32 bits");
        for field in layout.fields() {
            let value = || field.get(input, 0);
            let role = match field.port.role {
                PortRole::RegionClass => {
                    zones.classes = class_lanes(field, input);
                    continue;
                }
                role => role,
            };
            let (role, thresholds) = match own_role(role) {
                Some(own) => (own, &mut zones.keen),
                None => (role, &mut thresholds),
            };
            match role {
                PortRole::Reset => reset = value() == 1,
                PortRole::Valid => valid = value() == 1,
                PortRole::StartOfFrame => sof = value() == 1,
                PortRole::ReferenceValid => reference_valid = value() == 1,
                PortRole::ForwardReady => forward_ready = value() == 1,
                PortRole::Level(kind) => {
                    if let Some(place) = place(kind) {
                        thresholds.level[place] = word(value());
                    }
                }
                PortRole::MinScore(kind) => {
                    if let Some(place) = place(kind) {
                        thresholds.min_score[place] = value();
                    }
                }
                PortRole::TemporalLevel => thresholds.temporal_level = word(value()),
                PortRole::TemporalMinCount => thresholds.temporal_min_count = word(value()),
                PortRole::SummaryLevel => thresholds.summary_level = word(value()),
                PortRole::ClassWrite => zones.map.write = value() == 1,
                PortRole::ClassAddress => zones.map.address = word(value()),
                PortRole::ClassWord => zones.map.word = word(value()),
                PortRole::ClassCommit => zones.map.commit = value() == 1,
                PortRole::OffSummaryLevel => zones.off_summary_level = word(value()),
                // Pixels are read separately, outputs are not applied, and the borders belong to a
                // single RPU.
                _ => {}
            }
        }
        Self {
            reset,
            valid,
            is_start_of_frame: sof,
            reference_valid,
            forward_ready,
            thresholds,
            zones: design.zones().map(|_| zones),
        }
    }

    fn core_input<'a>(&'a self, pixels: &'a [u16], reference_pixels: &'a [u16]) -> CoreInput<'a> {
        let &Self {
            reset,
            valid,
            is_start_of_frame: sof,
            reference_valid,
            forward_ready,
            ref thresholds,
            ref zones,
        } = self;
        let zones = zones.as_ref().map(|zones| ZoneInputs {
            classes: &zones.classes,
            map: zones.map,
            keen: &zones.keen,
            off_summary_level: zones.off_summary_level,
        });
        let idle = CoreInput::idle(pixels, thresholds);
        CoreInput {
            reset,
            valid,
            sof,
            reference_valid,
            reference_pixels,
            forward_ready,
            zones,
            ..idle
        }
    }
}

impl ClockZones {
    fn of_design(design: &Design) -> Self {
        Self {
            classes: Vec::new(),
            map: ClassMapInputs::default(),
            keen: ThresholdInputs::of_class(design, RegionClass::Keen),
            off_summary_level: ThresholdInputs::of_class(design, RegionClass::Off).summary_level,
        }
    }
}

fn class_lanes(field: &RecordField, input: &[u8]) -> Vec<RegionClass> {
    let class = |lane| {
        let code = u8::try_from(field.get(input, lane)).ok();
        code.and_then(RegionClass::from_code).expect("two bits are the code of a class")
    };
    (0..field.port.lanes).map(class).collect()
}

/// Returns the role of the threshold that a keen threshold takes the place of, or `None` for other
/// roles.
fn own_role(role: PortRole) -> Option<PortRole> {
    match role {
        PortRole::KeenLevel(kind) => Some(PortRole::Level(kind)),
        PortRole::KeenMinScore(kind) => Some(PortRole::MinScore(kind)),
        PortRole::KeenTemporalLevel => Some(PortRole::TemporalLevel),
        PortRole::KeenTemporalMinCount => Some(PortRole::TemporalMinCount),
        PortRole::KeenSummaryLevel => Some(PortRole::SummaryLevel),
        _ => None,
    }
}

pub(super) fn field_of_role(layout: &RecordLayout, role: PortRole) -> Option<&RecordField> {
    layout.fields().iter().find(|field| field.port.role == role)
}

/// Calls `look` with the inputs and the expected outputs of each clock.
pub(super) fn for_each_clock(
    recording: &Recording,
    mut look: impl FnMut(&[u8], &[u8]),
) -> Result<(), CosimError> {
    let paths = [recording.inputs_path(), recording.expected_path()];
    let (mut inputs, mut outputs) = (open_buffered(&paths[0])?, open_buffered(&paths[1])?);
    let (mut input, mut output) =
        (recording.inputs().zero_record(), recording.outputs().zero_record());
    for _ in 0..recording.clocks() {
        inputs.read_exact(&mut input).map_err(CosimError::io("read", &paths[0]))?;
        outputs.read_exact(&mut output).map_err(CosimError::io("read", &paths[1]))?;
        look(&input, &output);
    }
    Ok(())
}

/// Compares the outputs of a model with the recording. `step` writes the outputs of the next clock
/// into a record.
pub(super) fn compare_recording(
    recording: &Recording,
    mut step: impl FnMut(&mut [u8]),
) -> Result<OutputAgreement, CosimError> {
    let (mut got, mut agreement) = (recording.outputs().zero_record(), OutputAgreement::default());
    for_each_clock(recording, |_, expected| {
        step(&mut got);
        agreement.add(recording.outputs(), expected, &got);
    })?;
    Ok(agreement)
}

/// Returns `count` frames with the size and depth of the design and random pixels. Equal seeds give
/// equal frames.
///
/// # Errors
/// A valid design causes no error.
pub fn random_frames(design: &Design, seed: u64, count: u32) -> Result<Vec<Frame>, FrameError> {
    let mut state = seed ^ 0x9E37_79B9_7F4A_7C15;
    let mut pixel = |_, _| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        let mixed = (state ^ (state >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let value = (mixed ^ (mixed >> 32)) & u64::from(design.pixel_max());
        u16::try_from(value).expect("masked to the pixel's bits")
    };
    let (width, height, bits) = (design.width(), design.height(), design.pixel_bits());
    (0..count).map(|_| Frame::from_fn(width, height, bits, &mut pixel)).collect()
}
