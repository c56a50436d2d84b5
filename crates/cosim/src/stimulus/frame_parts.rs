// SPDX-License-Identifier: MIT OR Apache-2.0
//! The caller's frames, cut to the parts that the simulated hardware sees.

use crate::error::CosimError;
use crate::level::CosimLevel;
use foveate_design::{Design, Hardware};
use foveate_model::{region_border, region_stream};
use foveate_pixels::Frame;

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
    /// evenly spread over the frames of the `whole` design, as are affordable for `frames` frames, and
    /// `most` at most. Without that limit, each region has an RPU.
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
