// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frame of a JPEG and its scans, which are followed block by block without computing a pixel.

use super::codes::{BlockChecker, CodedRun, HuffmanTable, SpectralBand};
use crate::limits::MAX_SIDE;
use crate::picture::damage::{PictureFault, require};

/// The Huffman tables and the restart interval that the segments before a scan defined.
#[derive(Default)]
pub(super) struct ScanTables {
    /// The tables of the first coefficient, and those of the others.
    pub(super) classes: [[Option<HuffmanTable>; 4]; 2],
    /// The number of units between two restart markers; 0 means that there are none.
    pub(super) interval: usize,
}

/// A component of the picture, such as its luma. Sizes are across and down.
struct FrameComponent {
    id: u8,
    /// The blocks in a unit of an interleaved scan.
    sampling: [usize; 2],
    /// The blocks that have pixels.
    blocks: [usize; 2],
    /// The number of blocks in a row, including those that complete the last unit.
    stride: usize,
    /// One bit per coefficient that is not zero, in file order, for each block.
    nonzero: Vec<u64>,
    /// The lowest bit that was sent of each coefficient.
    sent: [Option<u8>; 64],
}

/// The index of a component in the frame, and the names of its tables in each class.
type ScanComponent = (usize, [usize; 2]);

pub(super) struct Frame {
    is_progressive: bool,
    /// The numbers of units across and down in an interleaved scan.
    units: [usize; 2],
    components: Vec<FrameComponent>,
}

impl Frame {
    /// Reads the segment of a marker SOF0, SOF1 or SOF2. Returns `None` for pictures that this
    /// check does not follow: other depths than 8 bits, a height that comes later, and sizes beyond
    /// the limits.
    pub(super) fn read(marker: u8, segment: &[u8]) -> Result<Option<Self>, PictureFault> {
        let wrong = || PictureFault::damaged("the header of its frame (SOF) is wrong");
        let &[depth, h1, h0, w1, w0, count, ref parts @ ..] = segment else { return Err(wrong()) };
        let size = [[w1, w0], [h1, h0]].map(|side| usize::from(u16::from_be_bytes(side)));
        if depth != 8 || size.iter().any(|side| !(1..=MAX_SIDE as usize).contains(side)) {
            return Ok(None);
        }
        if !(1..=4).contains(&count) || parts.len() != 3 * usize::from(count) {
            return Err(wrong());
        }
        let parts = parts.chunks_exact(3);
        let sampling = |part: &[u8]| [part[1] >> 4, part[1] & 15].map(usize::from);
        if parts.clone().flat_map(sampling).any(|blocks| !(1..=4).contains(&blocks)) {
            return Err(wrong());
        }
        let most = [0, 1].map(|axis| parts.clone().map(|part| sampling(part)[axis]).max());
        let most = most.map(|most| most.unwrap_or(1));
        let units = [0, 1].map(|axis| size[axis].div_ceil(8 * most[axis]));
        let component = |part: &[u8]| {
            let own = sampling(part);
            let stride = units[0] * own[0];
            FrameComponent {
                id: part[0],
                sampling: own,
                blocks: [0, 1].map(|axis| (size[axis] * own[axis]).div_ceil(8 * most[axis])),
                stride,
                nonzero: vec![0; stride * units[1] * own[1]],
                sent: [None; 64],
            }
        };
        let components = parts.map(component).collect();
        Ok(Some(Self { is_progressive: marker == 0xC2, units, components }))
    }

    /// Returns true if every component has been sent down to its lowest bits.
    pub(super) fn is_complete(&self) -> bool {
        let sent = |component: &FrameComponent| {
            component.sent[0].is_some() && component.sent.iter().flatten().all(|&low| low == 0)
        };
        self.components.iter().all(sent)
    }

    /// Follows the scan with this header, whose data begin at `at`. Returns the position of the
    /// marker after it.
    pub(super) fn follow(
        &mut self,
        header: &[u8],
        tables: &ScanTables,
        bytes: &[u8],
        at: usize,
    ) -> Result<usize, PictureFault> {
        let (parts, band) = self.read_scan(header)?;
        let units = match parts.as_slice() {
            [(alone, _)] => self.components[*alone].blocks,
            _ => self.units,
        };
        let mut block = BlockChecker::new(band, CodedRun::new(bytes, at));
        for unit in 0..units[0] * units[1] {
            let restarts = unit.checked_div(tables.interval).unwrap_or(0);
            if restarts > 0 && unit % tables.interval == 0 {
                let (marker, next) = block.end_run()?;
                let due = [0xD7, 0xD0, 0xD1, 0xD2, 0xD3, 0xD4, 0xD5, 0xD6][restarts % 8];
                if marker != due {
                    return Err(PictureFault::damaged(format!(
                        "marker {marker:02X} stands where restart marker {due:02X} should be"
                    )));
                }
                block.run = CodedRun::new(bytes, next);
            }
            for &(component, names) in &parts {
                let component = &mut self.components[component];
                let [across, down] = if parts.len() == 1 { [1, 1] } else { component.sampling };
                let tables = [0, 1].map(|class| tables.classes[class][names[class]].as_ref());
                for inner in 0..across * down {
                    let x = unit % units[0] * across + inner % across;
                    let y = unit / units[0] * down + inner / across;
                    let nonzero = &mut component.nonzero[y * component.stride + x];
                    block.follow(tables, nonzero)?;
                }
            }
        }
        block.end_run().map(|_| block.run.after)
    }

    /// Reads the segment of a marker SOS, and records what the scan sends.
    fn read_scan(
        &mut self,
        segment: &[u8],
    ) -> Result<(Vec<ScanComponent>, SpectralBand), PictureFault> {
        let wrong = || PictureFault::damaged("the header of a scan (SOS) is wrong");
        let (&count, rest) = segment.split_first().ok_or_else(wrong)?;
        let (named, band) = rest.split_at_checked(2 * usize::from(count)).ok_or_else(wrong)?;
        let &[first, last, bits, ..] = band else { return Err(wrong()) };
        let band = if self.is_progressive {
            SpectralBand { first, last, previous_low_bit: bits >> 4, low_bit: bits & 15 }
        } else {
            SpectralBand { first: 0, last: 63, previous_low_bit: 0, low_bit: 0 }
        };
        let SpectralBand { first, last, previous_low_bit, low_bit } = band;
        let of_one = if first == 0 { last == 0 } else { count == 1 };
        let refines = previous_low_bit == 0 || previous_low_bit == low_bit + 1;
        let fits = first <= last && last <= 63 && low_bit <= 13;
        if count == 0 || self.is_progressive && !(of_one && refines && fits) {
            return Err(wrong());
        }
        let mut parts: Vec<ScanComponent> = Vec::new();
        for pair in named.chunks_exact(2) {
            let index = self.components.iter().position(|known| known.id == pair[0]);
            let index = index.ok_or_else(wrong)?;
            let tables = [pair[1] >> 4, pair[1] & 15].map(usize::from);
            if tables.iter().any(|&name| name > 3) || parts.iter().any(|part| part.0 == index) {
                return Err(wrong());
            }
            // Each coefficient is sent once or, in a progressive picture, bit by bit.
            for sent in &mut self.components[index].sent[first.into()..=last.into()] {
                let due = sent.map_or(0, |low| if low == 0 { 16 } else { low });
                require(previous_low_bit == due, "a scan does not continue the earlier scans")?;
                *sent = Some(low_bit);
            }
            parts.push((index, tables));
        }
        Ok((parts, band))
    }
}
