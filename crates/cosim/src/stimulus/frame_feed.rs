// SPDX-License-Identifier: MIT OR Apache-2.0
//! The order in which the pixel port takes a frame.

use crate::level::CosimLevel;
use foveate_design::{Design, Hardware, PipelinedDesign, PixelFeed, RasterDesign, SerialDesign};
use foveate_model::region_stream;
use foveate_pixels::Frame;

/// The order of the pixels of a frame at the pixel port, and the number taken at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) enum FrameFeed<'a> {
    /// One pixel at a time of a square, which is a region with its halo.
    Square(PipelinedDesign<'a>),
    /// One pixel of every region with its halo at a time.
    Regions(PipelinedDesign<'a>),
    /// One pixel of every lane at a time, slot by slot.
    Lanes(SerialDesign<'a>),
    /// One pixel at a time, in row-major order.
    Pixels(SerialDesign<'a>),
    /// One word at a time, in row-major order.
    Words(RasterDesign<'a>),
}

impl<'a> FrameFeed<'a> {
    /// Returns the feed of module `rcm`, and of an array of one unit.
    pub(crate) fn for_design(design: &'a Design) -> Self {
        match design.hardware() {
            Hardware::Pipelined(own) => Self::Regions(design.with_hardware(own)),
            Hardware::Serial(own) => match design.with_hardware(own).feed() {
                PixelFeed::Parallel => Self::Lanes(design.with_hardware(own)),
                PixelFeed::Raster => Self::Pixels(design.with_hardware(own)),
            },
            Hardware::Raster(own) => Self::Words(design.with_hardware(own)),
        }
    }

    /// Returns the feed of the hardware that is simulated at a level.
    pub(super) fn for_level(level: CosimLevel, design: &'a Design) -> Self {
        match (level, Self::for_design(design)) {
            (CosimLevel::Rpu, Self::Regions(design)) => Self::Square(design),
            (_, feed) => feed,
        }
    }

    /// Returns the number of pixels that the port takes at once.
    pub(crate) fn width(&self) -> usize {
        let width = match self {
            Self::Square(_) | Self::Pixels(_) => 1,
            Self::Regions(design) => design.regions(),
            Self::Lanes(design) => design.lanes(),
            Self::Words(design) => design.pixels_per_clock(),
        };
        width as usize
    }

    pub(super) fn design(&self) -> &'a Design {
        match self {
            Self::Square(design) | Self::Regions(design) => design.design(),
            Self::Lanes(design) | Self::Pixels(design) => design.design(),
            Self::Words(design) => design.design(),
        }
    }

    /// Returns the columns and rows of a fed frame or square.
    pub(super) fn size(&self) -> (u32, u32) {
        match self {
            Self::Square(design) => (design.stream_side(), design.stream_side()),
            Self::Regions(_) | Self::Lanes(_) | Self::Pixels(_) | Self::Words(_) => {
                (self.design().width(), self.design().height())
            }
        }
    }

    /// Returns the side of the squares that are drawn independently: a region, or a region with its
    /// halo.
    pub(super) fn square_side(&self) -> u32 {
        match self {
            Self::Square(design) => design.stream_side(),
            Self::Regions(_) | Self::Lanes(_) | Self::Pixels(_) | Self::Words(_) => {
                self.design().region_size()
            }
        }
    }

    /// Returns the beats of a frame, in order. Places without a pixel get the values of `nothing`.
    pub(crate) fn beats(&self, frame: &Frame, nothing: impl FnMut() -> u16) -> Vec<Vec<u16>> {
        match *self {
            Self::Square(_) => frame.pixels().iter().map(|&pixel| vec![pixel]).collect(),
            Self::Regions(design) => region_beats(&design, frame),
            Self::Lanes(design) => lane_beats(design, frame, nothing),
            Self::Pixels(design) => pixel_beats(design, frame),
            Self::Words(design) => word_beats(design, frame, nothing),
        }
    }
}

/// Returns the streams of all regions, one after the other.
fn region_streams(design: &Design, frame: &Frame) -> Vec<u16> {
    let mut streams = Vec::new();
    for region in 0..design.regions() {
        region_stream(design, frame, region, &mut streams);
    }
    streams
}

fn region_beats(design: &Design, frame: &Frame) -> Vec<Vec<u16>> {
    let (streams, length) = (region_streams(design, frame), design.stream_pixels() as usize);
    let beat = |at| streams.iter().skip(at).step_by(length).copied().collect();
    (0..length).map(beat).collect()
}

/// Returns the beats of slot 0 of every lane, then those of slot 1, and so on.
fn lane_beats(
    design: SerialDesign<'_>,
    frame: &Frame,
    mut nothing: impl FnMut() -> u16,
) -> Vec<Vec<u16>> {
    let (streams, length) = (region_streams(&design, frame), design.stream_pixels() as usize);
    let (lanes, fold) = (design.lanes() as usize, design.fold() as usize);
    let places = (0..fold).flat_map(|slot| (0..length).map(move |at| (slot, at)));
    let mut pixel = |place: usize| streams.get(place).copied().unwrap_or_else(&mut nothing);
    places
        .map(|(slot, at)| {
            (0..lanes).map(|lane| pixel((lane * fold + slot) * length + at)).collect()
        })
        .collect()
}

/// Returns the pixels of the padded frame in row-major order, one per beat.
fn pixel_beats(design: SerialDesign<'_>, frame: &Frame) -> Vec<Vec<u16>> {
    let side = i64::from(design.region_size());
    let (width, height) = (i64::from(design.columns()) * side, i64::from(design.rows()) * side);
    let row = |y| (0..width).map(move |x| vec![frame.get_clamped(x, y)]);
    (0..height).flat_map(row).collect()
}

/// Returns the words of a frame in row-major order. Pixels of the last word of a row that lie
/// beyond the frame get the values of `nothing`.
fn word_beats(
    design: RasterDesign<'_>,
    frame: &Frame,
    mut nothing: impl FnMut() -> u16,
) -> Vec<Vec<u16>> {
    let pixels = design.pixels_per_clock() as usize;
    let mut words = Vec::new();
    for y in 0..frame.height() {
        for word in frame.row(y).chunks(pixels) {
            let mut word = word.to_vec();
            word.resize_with(pixels, &mut nothing);
            words.push(word);
        }
    }
    words
}
