// SPDX-License-Identifier: MIT OR Apache-2.0
//! An array of any organization, seen from its ports: the beats that it takes, and the decisions
//! that it makes.

use foveate_design::{Design, Hardware, PixelFeed};
use foveate_model::{CoreInput, PipelinedRcm, RasterRcm, SerialRcm, ThresholdInputs};
use foveate_pixels::Frame;

/// The decision of an array for a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ArrayDecision {
    pub(crate) region: u32,
    pub(crate) srs: bool,
    pub(crate) trs: bool,
    pub(crate) active: bool,
}

/// An array of any organization.
pub(crate) enum AnyArray {
    Pipelined(Box<PipelinedRcm>),
    Serial(Box<SerialRcm>),
    Raster(Box<RasterRcm>),
}

/// The outputs of the array after an edge.
#[derive(Debug, Default)]
pub(crate) struct ArrayOutputs {
    pub(crate) ready: bool,
    pub(crate) sync_error: bool,
    pub(crate) decided: Vec<ArrayDecision>,
    /// Number of pixels that leave, for organizations that send them within the frame.
    pub(crate) sent_pixels: usize,
}

impl AnyArray {
    pub(crate) fn new(design: &Design) -> Self {
        match design.hardware() {
            Hardware::Pipelined(own) => {
                Self::Pipelined(Box::new(PipelinedRcm::new(design.with_hardware(own))))
            }
            Hardware::Serial(own) => {
                Self::Serial(Box::new(SerialRcm::new(design.with_hardware(own))))
            }
            Hardware::Raster(own) => {
                Self::Raster(Box::new(RasterRcm::new(design.with_hardware(own))))
            }
        }
    }

    pub(crate) fn step(
        &mut self,
        (reset, valid, sof): (bool, bool, bool),
        pixels: &[u16],
        thresholds: &ThresholdInputs,
    ) -> ArrayOutputs {
        match self {
            Self::Pipelined(rcm) => {
                let input = CoreInput { reset, valid, sof, ..CoreInput::idle(pixels, thresholds) };
                let outputs = rcm.step(&input).iter().zip(0..);
                let outputs = outputs.filter(|(output, _)| output.decision_valid);
                let decided = outputs.map(|(output, region)| ArrayDecision {
                    region,
                    srs: output.srs,
                    trs: output.trs,
                    active: output.active,
                });
                let decided = decided.collect();
                ArrayOutputs { ready: true, sync_error: rcm.sync_error(), decided, sent_pixels: 0 }
            }
            Self::Serial(rcm) => {
                let shown = rcm.step(&CoreInput {
                    reset,
                    valid,
                    sof,
                    ..CoreInput::idle(pixels, thresholds)
                });
                let decided = shown.decision_valid.then_some(ArrayDecision {
                    region: shown.region,
                    srs: shown.srs,
                    trs: shown.trs,
                    active: shown.active,
                });
                ArrayOutputs {
                    ready: shown.ready,
                    sync_error: shown.sync_error,
                    decided: decided.into_iter().collect(),
                    sent_pixels: shown.forward_valid.iter().filter(|valid| **valid).count(),
                }
            }
            Self::Raster(rcm) => {
                let shown = rcm.step(&CoreInput {
                    reset,
                    valid,
                    sof,
                    pixels,
                    reference_valid: false,
                    reference_pixels: &vec![0; pixels.len()],
                    forward_ready: true,
                    thresholds,
                    border: 0,
                    zones: None,
                });
                let decided = shown.decision_valid.then_some(ArrayDecision {
                    region: shown.region,
                    srs: shown.srs,
                    trs: shown.trs,
                    active: shown.active,
                });
                ArrayOutputs {
                    ready: shown.ready,
                    sync_error: shown.sync_error,
                    decided: decided.into_iter().collect(),
                    sent_pixels: if shown.forward_valid { pixels.len() } else { 0 },
                }
            }
        }
    }

    /// Returns true if the array has `ready_o`. Its pixels then leave within the frame.
    pub(crate) fn has_ready(&self) -> bool {
        !matches!(self, Self::Pipelined(_))
    }
}

/// Returns the number of the beat of pixel (x, y) of a frame, and the position in the beat. Regions
/// are isolated, or pixels come row by row.
fn beat_and_position(design: &Design, x: u32, y: u32) -> (u32, u32) {
    let (n, columns) = (design.region_size(), design.columns());
    let (region, position) = (y / n * columns + x / n, y % n * n + x % n);
    match design.hardware() {
        Hardware::Pipelined(_) => (position, region),
        Hardware::Serial(own) => match own.feed {
            PixelFeed::Raster => (y * columns * n + x, 0),
            PixelFeed::Parallel => {
                let (lane, slot) = (region / own.fold, region % own.fold);
                (slot * n * n + position, lane)
            }
        },
        Hardware::Raster(own) => {
            let word = own.pixels_per_clock;
            (y * design.width().div_ceil(word) + x / word, x % word)
        }
    }
}

/// Returns the number of beats of a frame and the number of pixels of a beat.
pub(crate) fn beat_shape(design: &Design) -> (usize, usize) {
    let places = (0..design.height())
        .flat_map(|y| (0..design.width()).map(move |x| (x, y)))
        .map(|(x, y)| beat_and_position(design, x, y));
    let (beats, width) =
        places.fold((0, 0), |(beats, width), (beat, at)| (beats.max(beat + 1), width.max(at + 1)));
    (beats as usize, width as usize)
}

/// Returns the frame that consists of these beats.
pub(crate) fn frame_from_beats(design: &Design, beats: &[Vec<u16>]) -> Frame {
    let pixel = |x, y| {
        let (beat, at) = beat_and_position(design, x, y);
        beats[beat as usize][at as usize]
    };
    Frame::from_fn(design.width(), design.height(), design.pixel_bits(), pixel).unwrap()
}
