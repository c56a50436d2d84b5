// SPDX-License-Identifier: MIT OR Apache-2.0
//! An array of any organization, seen from its ports: the beats that it takes, and the decisions
//! that it makes.

use foveate_design::{Design, Hardware, PixelFeed, PortRole};
use foveate_model::{CoreInput, CycleModel};
use foveate_pixels::Frame;

/// The decision of an array for a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ArrayDecision {
    pub(crate) region: u32,
    pub(crate) srs: bool,
    pub(crate) trs: bool,
    pub(crate) active: bool,
}

/// The outputs of an array after an edge.
#[derive(Debug, Default)]
pub(crate) struct ArrayOutputs {
    pub(crate) ready: bool,
    pub(crate) sync_error: bool,
    pub(crate) decided: Vec<ArrayDecision>,
    /// Number of pixels that leave.
    pub(crate) sent_pixels: usize,
}

impl ArrayOutputs {
    /// Applies an edge to the array, and returns its outputs after it.
    pub(crate) fn of_step(model: &mut dyn CycleModel, input: &CoreInput<'_>) -> Self {
        model.clock(input);
        let values = |role| {
            let mut values = Vec::new();
            model.append_output(role, &mut values);
            values
        };
        let mut decided = Vec::new();
        if model.is_high(PortRole::DecisionValid) {
            // Without a port for the region, lane l decides region l.
            let numbers = values(PortRole::Region);
            let bits = [PortRole::Srs, PortRole::Trs, PortRole::Active].map(values);
            for (lane, &srs) in bits[0].iter().enumerate() {
                decided.push(ArrayDecision {
                    region: numbers.get(lane).map_or(lane as u32, |&number| number as u32),
                    srs: srs == 1,
                    trs: bits[1][lane] == 1,
                    active: bits[2][lane] == 1,
                });
            }
        }
        // A valid bit belongs to a lane, or to all pixels of a word.
        let words = values(PortRole::ForwardValid);
        let pixels = values(PortRole::ForwardPixel).len() / words.len().max(1);
        Self {
            ready: model.is_ready(),
            sync_error: model.is_high(PortRole::SyncError),
            decided,
            sent_pixels: words.into_iter().filter(|&valid| valid == 1).count() * pixels,
        }
    }
}

/// Returns true if the array has `ready_o`. Its pixels then leave within the frame.
pub(crate) fn has_ready(design: &Design) -> bool {
    !matches!(design.hardware(), Hardware::Pipelined(_))
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
