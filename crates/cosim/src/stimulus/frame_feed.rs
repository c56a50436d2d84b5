// SPDX-License-Identifier: MIT OR Apache-2.0
//! The way of the caller's frames to the pixel port. They are cut to the parts that the
//! simulated hardware sees ([`FramePart`]), put into the order of the port ([`FrameFeed`]),
//! perhaps damaged, for hardware that synchronizes to the start of a frame ([`FrameDelivery`]),
//! and sent with pauses between pixels and between frames ([`GapPattern`]).

use self::BeatCount::{AllButOne, One, Some as Many};
use self::FrameDelivery::{Long, Restarted, Short, Strays, Twice, Unmarked, Whole};
use super::random::Random;
use crate::error::CosimError;
use crate::level::CosimLevel;
use foveate_design::{Design, Hardware, PipelinedDesign, PixelFeed, RasterDesign, SerialDesign};
use foveate_model::{region_border, region_stream};
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

/// The damage of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FrameDelivery {
    /// The whole frame, with its first beat marked.
    Whole,
    /// The frame without its last beats.
    Short(BeatCount),
    /// The whole frame, followed by beats of no frame.
    Long(BeatCount),
    /// The whole frame with its first beat twice, both of them marked.
    Twice,
    /// The whole frame, with a second beat marked, too.
    Restarted,
    /// The whole frame without a mark.
    Unmarked,
    /// A few beats of no frame, in place of the frame.
    Strays,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BeatCount {
    One,
    Some,
    AllButOne,
}

impl FrameDelivery {
    /// A frame without its last beat.
    pub(crate) const ONE_BEAT_SHORT: Self = Short(One);
    /// A frame with one beat too many.
    pub(crate) const ONE_BEAT_LONG: Self = Long(One);

    /// Returns the beats of a frame of `count` beats: each with its start mark, and its index in
    /// the frame or `None` for a beat of no frame.
    pub(super) fn beats(self, count: usize, random: &mut Random) -> Vec<(bool, Option<usize>)> {
        let whole = |count: usize| (0..count).map(|place| (place == 0, Some(place)));
        let mut any = |most: usize| 1 + random.index(most - 1);
        let mut part = |part| match part {
            One => 1,
            Many => any(count - 1),
            AllButOne => count - 1,
        };
        match self {
            Whole => whole(count).collect(),
            Short(missing) => whole(count - part(missing)).collect(),
            Long(more) => {
                let more = part(more);
                whole(count).chain(stray_beats(more)).collect()
            }
            Twice => std::iter::once((true, Some(0))).chain(whole(count)).collect(),
            Restarted => {
                let again = any(count - 1);
                whole(count).map(|(sof, place)| (sof || place == Some(again), place)).collect()
            }
            Unmarked => whole(count).map(|(_, place)| (false, place)).collect(),
            Strays => stray_beats(any(count.min(9) - 1)).collect(),
        }
    }
}

fn stray_beats(count: usize) -> impl Iterator<Item = (bool, Option<usize>)> {
    std::iter::repeat_n((false, None), count)
}

/// The largest number of clocks of all parts that go through a single lane or core; the parts are
/// spread over the frame.
const MAX_CLOCKS: u64 = 1 << 21;

/// A part of the caller's frames, which goes through the simulated hardware as a sequence.
#[derive(Clone, Debug)]
pub(super) struct FramePart {
    /// The name of its sequence.
    pub(super) name: String,
    /// The region of the part, or its first region; `None` if the part is a whole frame or a tile.
    pub(super) region: Option<u32>,
    /// The sides of the region at the frame's border, if these are an input.
    pub(super) border: u8,
    position: PartPosition,
}

/// The position of a part. Pixels beyond the frame repeat its border.
#[derive(Clone, Copy, Debug)]
enum PartPosition {
    /// The upper left part of the frame, in the size of the simulated design.
    UpperLeft,
    /// A region with its halo.
    Region(u32),
    /// The regions of a lane, side by side, from this region on.
    Lane(u32),
    /// A tile at this place, in the size of the simulated design.
    Tile { left: u32, top: u32 },
}

impl FramePart {
    fn new(name: &str, region: Option<u32>, cut: PartPosition) -> Self {
        Self { name: name.to_owned(), region, border: 0, position: cut }
    }

    /// Returns the parts that are simulated. An array has one part. A lone unit has as many parts,
    /// evenly spread over the frames of the `whole` design, as are affordable for `frames` frames,
    /// and `most` at most. Without that limit, each region has an RPU.
    pub(super) fn all_of(
        whole: &Design,
        simulated: &Design,
        level: CosimLevel,
        frames: usize,
        most: Option<u64>,
    ) -> Vec<Self> {
        match level {
            _ if frames == 0 => Vec::new(),
            CosimLevel::Rcm { .. } | CosimLevel::Full => {
                vec![Self::new("frames", None, PartPosition::UpperLeft)]
            }
            CosimLevel::Rpu => {
                let clocks = frames as u64 * simulated.timing().clocks_per_frame();
                Self::unit_parts(whole, simulated, (MAX_CLOCKS / clocks.max(1), most))
            }
        }
    }

    /// Returns the parts that go through a lone unit, `affordable` and `most` at most.
    fn unit_parts(
        whole: &Design,
        simulated: &Design,
        (affordable, most): (u64, Option<u64>),
    ) -> Vec<Self> {
        let limited = most.map_or(affordable, |most| most.min(affordable));
        let spread = |all: u32, count: u64| {
            let count = count.clamp(1, all.into());
            let nth = move |number| number * u64::from(all) / count;
            (0..count).map(move |number| u32::try_from(nth(number)).expect("less than all"))
        };
        match whole.hardware() {
            // A region takes one clock per pixel, and each region has an RPU of its own.
            Hardware::Pipelined(_) => spread(whole.regions(), most.map_or(u64::MAX, |_| limited))
                .map(|region| {
                    let part = Self::new("frames", Some(region), PartPosition::Region(region));
                    Self { border: region_border(whole, region), ..part }
                })
                .collect(),
            Hardware::Serial(own) => {
                let fold = whole.with_hardware(own).fold();
                spread(whole.with_hardware(own).lanes(), limited)
                    .map(|lane| {
                        Self::new("frames", Some(lane * fold), PartPosition::Lane(lane * fold))
                    })
                    .collect()
            }
            Hardware::Raster(_) => {
                let (width, height) = (simulated.width(), simulated.height());
                let columns = whole.width().div_ceil(width);
                spread(columns * whole.height().div_ceil(height), limited)
                    .map(|tile| {
                        let (left, top) = (tile % columns * width, tile / columns * height);
                        let name = format!("frames from x {left}, y {top} on");
                        Self::new(&name, None, PartPosition::Tile { left, top })
                    })
                    .collect()
            }
        }
    }

    /// Cuts the part out of a frame of the `whole` design.
    pub(super) fn extract(
        &self,
        whole: &Design,
        simulated: &Design,
        frame: &Frame,
    ) -> Result<Frame, CosimError> {
        let (side, columns) = (whole.region_size(), whole.columns());
        let size = (simulated.width(), simulated.height());
        let part = |(width, height): (u32, u32), place: &dyn Fn(u32, u32) -> (u32, u32)| {
            Frame::from_fn(width, height, whole.pixel_bits(), |x, y| {
                let (x, y) = place(x, y);
                frame.get_clamped(x.into(), y.into())
            })
        };
        let part = match self.position {
            PartPosition::UpperLeft => part(size, &|x, y| (x, y)),
            PartPosition::Tile { left, top } => part(size, &|x, y| (left + x, top + y)),
            PartPosition::Lane(first) => part(size, &|x, y| {
                let region = (first + x / side).min(whole.regions() - 1);
                (region % columns * side + x % side, region / columns * side + y)
            }),
            PartPosition::Region(region) => {
                let (mut stream, side) = (Vec::new(), whole.stream_side());
                region_stream(whole, frame, region, &mut stream);
                Frame::new(side, side, whole.pixel_bits(), stream)
            }
        };
        Ok(part?)
    }
}

/// The pattern of pauses between pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GapPattern {
    /// A pixel comes at every clock, and frames follow at once.
    None,
    /// Pauses are random, and most frames follow at once.
    Random,
    /// Pixels come in bursts, with pauses of many clocks; frames are often far enough apart for a
    /// flush.
    Bursts,
    /// One clock passes before the last of so many pixels.
    Periodic(usize),
}

impl GapPattern {
    /// The patterns that sequences take in turn.
    pub(super) const IN_TURN: [Self; 3] = [Self::None, Self::Random, Self::Bursts];

    /// Returns the number of clocks without a pixel before the one at this place of a frame.
    pub(super) fn before_pixel(self, place: usize, random: &mut Random) -> u64 {
        match self {
            Self::None => 0,
            Self::Random if random.one_in(3) => 1 + random.up_to(2),
            Self::Bursts if random.one_in(40) => 1 + random.up_to(30),
            Self::Random | Self::Bursts => 0,
            Self::Periodic(period) => u64::from(place % period == period - 1),
        }
    }

    /// Returns the number of clocks without a pixel between two frames; after `settle` clocks
    /// everything has settled.
    pub(super) fn between_frames(self, settle: u64, random: &mut Random) -> u64 {
        match self {
            Self::None | Self::Periodic(_) => 0,
            Self::Random => match random.up_to(3) {
                0 => 1,
                1 => random.up_to(settle),
                _ => 0,
            },
            Self::Bursts => match random.up_to(2) {
                0 => 0,
                1 => random.up_to(settle),
                _ => settle,
            },
        }
    }
}
