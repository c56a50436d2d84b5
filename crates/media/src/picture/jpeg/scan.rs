// SPDX-License-Identifier: MIT OR Apache-2.0
//! The check of the coded data of one scan, block by block, without computing a pixel. The
//! header and the end of a JPEG, found without its codes.

use super::bits::{BitReader, HuffmanTable, marker_at};
use super::block::{BlockChecker, SpectralBand};
use super::frame::{CodingProcess, FrameHeader};
use super::segment;
use crate::picture::conversion::ImageOutline;
use crate::picture::damage::PictureFault;

/// The Huffman tables and the restart interval that the segments before a scan defined.
#[derive(Default)]
pub(super) struct HuffmanTables {
    pub(super) dc: [Option<HuffmanTable>; 4],
    pub(super) ac: [Option<HuffmanTable>; 4],
    /// The number of units between two restart markers; 0 means that there are none.
    pub(super) interval: u32,
}

struct ScanComponent {
    /// The index of the component in the frame.
    component: usize,
    dc: usize,
    ac: usize,
}

pub(super) struct ScanHeader {
    parts: Vec<ScanComponent>,
    band: SpectralBand,
}

impl ScanHeader {
    /// Reads the segment of a marker SOS.
    pub(super) fn read(frame: &FrameHeader, segment: &[u8]) -> Result<Self, PictureFault> {
        let wrong = || PictureFault::damaged("the header of a scan (SOS) is wrong");
        let (&count, rest) = segment.split_first().ok_or_else(wrong)?;
        let count = usize::from(count);
        if !(1..=frame.components.len()).contains(&count) || rest.len() < 2 * count + 3 {
            return Err(wrong());
        }
        let (named, last) = rest.split_at(2 * count);
        let mut parts: Vec<ScanComponent> = Vec::new();
        for pair in named.chunks_exact(2) {
            let component = frame.components.iter().position(|known| known.id == pair[0]);
            let component = component.ok_or_else(wrong)?;
            let (dc, ac) = (usize::from(pair[1] >> 4), usize::from(pair[1] & 15));
            if dc > 3 || ac > 3 || parts.iter().any(|part| part.component == component) {
                return Err(wrong());
            }
            parts.push(ScanComponent { component, dc, ac });
        }
        let band = match frame.process {
            CodingProcess::Sequential => {
                SpectralBand { first: 0, last: 63, previous_low_bit: 0, low_bit: 0 }
            }
            CodingProcess::Progressive => {
                let band = SpectralBand {
                    first: last[0],
                    last: last[1],
                    previous_low_bit: last[2] >> 4,
                    low_bit: last[2] & 15,
                };
                let of_one = if band.first == 0 { band.last == 0 } else { count == 1 };
                let refines =
                    band.previous_low_bit == 0 || band.previous_low_bit == band.low_bit + 1;
                if band.first > band.last
                    || band.last > 63
                    || band.low_bit > 13
                    || !of_one
                    || !refines
                {
                    return Err(wrong());
                }
                band
            }
        };
        Ok(Self { parts, band })
    }

    /// Follows the data from `at` to the marker after it. Returns the position of that marker.
    pub(super) fn follow(
        &self,
        frame: &mut FrameHeader,
        tables: &HuffmanTables,
        bytes: &[u8],
        at: usize,
    ) -> Result<usize, PictureFault> {
        self.record_sent_bits(frame)?;
        let units = match self.parts.as_slice() {
            [alone] => frame.components[alone.component].blocks,
            _ => frame.units,
        };
        let total = u64::from(units.0) * u64::from(units.1);
        let mut bits = BitReader::new(bytes, at);
        let mut block = BlockChecker::new(self.band, frame.process);
        let mut done = 0;
        let mut restarts = 0;
        for y in 0..units.1 {
            for x in 0..units.0 {
                self.follow_unit(frame, tables, (x, y), &mut block, &mut bits)?;
                done += 1;
                let due = tables.interval > 0 && done % u64::from(tables.interval) == 0;
                if due && done < total {
                    block.restart()?;
                    let next = skip_restart_marker(&mut bits, bytes, restarts)?;
                    bits.restart(next);
                    restarts = (restarts + 1) % 8;
                }
            }
        }
        block.restart()?;
        bits.end_run()
    }

    fn follow_unit(
        &self,
        frame: &mut FrameHeader,
        tables: &HuffmanTables,
        (x, y): (u32, u32),
        block: &mut BlockChecker,
        bits: &mut BitReader<'_>,
    ) -> Result<(), PictureFault> {
        for (place, part) in self.parts.iter().enumerate() {
            let component = &mut frame.components[part.component];
            let (across, down) = if self.parts.len() == 1 { (1, 1) } else { component.sampling };
            let tables = (tables.dc[part.dc].as_ref(), tables.ac[part.ac].as_ref());
            for row in 0..down {
                for column in 0..across {
                    let at = (y * down + row) * component.stride + x * across + column;
                    let mut none = 0;
                    let nonzero = component.nonzero.get_mut(at as usize).unwrap_or(&mut none);
                    block.follow(place, tables, nonzero, bits)?;
                }
            }
        }
        Ok(())
    }

    /// Records which bits of the coefficients this scan sends. Each coefficient is sent once or, in
    /// a progressive picture, from its high bits to its low bits.
    fn record_sent_bits(&self, frame: &mut FrameHeader) -> Result<(), PictureFault> {
        let SpectralBand { first, last, previous_low_bit: high, low_bit: low } = self.band;
        for part in &self.parts {
            let sent = &mut frame.components[part.component].sent;
            let mut known = sent[usize::from(first)..=usize::from(last)].iter_mut();
            let fits = |before: &Option<u8>| match high {
                0 => before.is_none(),
                high => *before == Some(high),
            };
            if !known.all(|before| {
                let fits = fits(before);
                *before = Some(low);
                fits
            }) {
                return Err(PictureFault::damaged("a scan does not continue the earlier scans"));
            }
        }
        Ok(())
    }
}

/// Skips the restart marker with this number. Returns the position after it.
fn skip_restart_marker(
    bits: &mut BitReader<'_>,
    bytes: &[u8],
    number: u8,
) -> Result<usize, PictureFault> {
    match marker_at(bytes, bits.end_run()?) {
        Some((marker, next)) if marker == 0xD0 + number => Ok(next),
        Some((marker, _)) => Err(PictureFault::damaged(format!(
            "marker {marker:02X} stands where restart marker {:02X} should be",
            0xD0 + number
        ))),
        None => Err(PictureFault::truncated("it has no end marker (EOI)")),
    }
}

/// The segment that announces further pictures in a file, such as the second one of a stereo photo.
const MULTI_PICTURE: (u8, &[u8]) = (0xE2, b"MPF\0");

/// Returns the outline of a JPEG. Returns `None` if it has no header, and for a photo with further
/// pictures.
pub(in crate::picture) fn outline(bytes: &[u8]) -> Option<ImageOutline<'_>> {
    let mut header = None;
    // The start marker SOI has two bytes.
    let mut at = 2;
    while let Some((marker, next)) = marker_at(bytes, at) {
        at = next;
        match marker {
            0xD9 => return Some(ImageOutline { header: header?, after: bytes.get(at..) }),
            0x01 | 0xD0..=0xD7 => continue,
            0xD8 => break,
            _ => {}
        }
        let Ok(content) = segment(bytes, at) else { break };
        let start = at;
        at += 2 + content.len();
        match marker {
            _ if marker == MULTI_PICTURE.0 && content.starts_with(MULTI_PICTURE.1) => return None,
            // DHT, JPG and DAC lie between the headers of frames.
            0xC4 | 0xC8 | 0xCC => {}
            // The header tells the kind of JPEG by its marker.
            0xC0..=0xCF => header = bytes.get(start - 1..at),
            0xDA => {
                let is_marker =
                    |pair: &[u8]| pair[0] == 0xFF && !matches!(pair[1], 0 | 0xFF | 0xD0..=0xD7);
                let Some(length) = bytes[at..].windows(2).position(is_marker) else { break };
                at += length;
            }
            _ => {}
        }
    }
    Some(ImageOutline { header: header?, after: None })
}
