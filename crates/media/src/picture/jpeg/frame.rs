// SPDX-License-Identifier: MIT OR Apache-2.0
//! The header of the frame of a JPEG: its process, its size, and the blocks of its components.

use crate::limits::MAX_SIDE;
use crate::picture::damage::PictureFault;

/// The way in which coefficients are distributed over scans.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CodingProcess {
    Sequential,
    Progressive,
}

/// A component of the picture, such as its luma.
pub(super) struct FrameComponent {
    pub(super) id: u8,
    /// The numbers of blocks across and down in a unit of an interleaved scan.
    pub(super) sampling: (u32, u32),
    /// The numbers of blocks across and down that have pixels.
    pub(super) blocks: (u32, u32),
    /// The number of blocks in a row, including those that complete the last unit.
    pub(super) stride: u32,
    /// One bit per coefficient that is not zero, in file order, for each block. It is empty for
    /// sequential pictures.
    pub(super) nonzero: Vec<u64>,
    /// The lowest bit that was sent of each coefficient.
    pub(super) sent: [Option<u8>; 64],
}

pub(super) struct FrameHeader {
    pub(super) process: CodingProcess,
    /// The numbers of units across and down in an interleaved scan.
    pub(super) units: (u32, u32),
    pub(super) components: Vec<FrameComponent>,
}

impl FrameHeader {
    /// Reads the segment of a marker SOF0, SOF1 or SOF2. Returns `None` for pictures that this
    /// check does not follow: other depths than 8 bits, a height that comes later, and sizes beyond
    /// the limits.
    pub(super) fn read(
        process: CodingProcess,
        segment: &[u8],
    ) -> Result<Option<Self>, PictureFault> {
        let wrong = || PictureFault::damaged("the header of its frame (SOF) is wrong");
        let [depth, h1, h0, w1, w0, count, rest @ ..] = segment else { return Err(wrong()) };
        let (height, width) = (u16::from_be_bytes([*h1, *h0]), u16::from_be_bytes([*w1, *w0]));
        let (width, height) = (u32::from(width), u32::from(height));
        if *depth != 8 || width.min(height) == 0 || width.max(height) > MAX_SIDE {
            return Ok(None);
        }
        let parts = rest.chunks_exact(3);
        if *count == 0
            || *count > 4
            || !parts.remainder().is_empty()
            || parts.len() != usize::from(*count)
        {
            return Err(wrong());
        }
        let sampling = |part: &[u8]| (u32::from(part[1] >> 4), u32::from(part[1] & 15));
        let most = parts.clone().map(sampling).fold((1, 1), |m, s| (m.0.max(s.0), m.1.max(s.1)));
        let units = (width.div_ceil(8 * most.0), height.div_ceil(8 * most.1));
        let mut components = Vec::new();
        for part in parts {
            let (across, down) = sampling(part);
            if !(1..=4).contains(&across) || !(1..=4).contains(&down) {
                return Err(wrong());
            }
            let side = |size: u32, own: u32, most: u32| (size * own).div_ceil(most).div_ceil(8);
            let stride = units.0 * across;
            let kept =
                if process == CodingProcess::Progressive { stride * units.1 * down } else { 0 };
            components.push(FrameComponent {
                id: part[0],
                sampling: (across, down),
                blocks: (side(width, across, most.0), side(height, down, most.1)),
                stride,
                nonzero: vec![0; kept as usize],
                sent: [None; 64],
            });
        }
        Ok(Some(Self { process, units, components }))
    }
}
