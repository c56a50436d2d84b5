// SPDX-License-Identifier: MIT OR Apache-2.0
//! The decoder of JPEG and its check that a file is complete. Decoders are lenient with this format: they fill missing or
//! wrong data with grey, or draw the wrong codes. This check follows the segments and the codes of
//! every scan without computing a pixel, and refuses what the format does not allow.
//!
//! A JPEG has no checksums. Damage is found if it leaves a code that is in no table, a block with
//! too many coefficients, a restart marker out of order, or missing or excess data at the end of a
//! scan. Damage that leaves the same number of valid codes cannot be found.

mod bits;
mod block;
mod frame;
mod pixels;
mod scan;

use self::bits::{HuffmanTable, marker_at};
use self::frame::{CodingProcess, FrameComponent, FrameHeader};
pub(super) use self::pixels::{decode, orientation, width};
pub(super) use self::scan::outline;
use self::scan::{HuffmanTables, ScanHeader};
use super::damage::PictureFault;

/// Finds damage between the start marker and the end marker; bytes after the end marker are
/// ignored. Kinds of JPEG that the decoder does not support either, such as lossless ones, are left
/// to the decoder.
pub(super) fn check(bytes: &[u8]) -> Result<(), PictureFault> {
    let mut tables = HuffmanTables::default();
    let mut frame: Option<FrameHeader> = None;
    // The start marker SOI has two bytes.
    let mut at = 2;
    loop {
        let (marker, next) = match marker_at(bytes, at) {
            Some(found) => found,
            None if bytes.get(at..).is_none_or(|rest| rest.iter().all(|&byte| byte == 0xFF)) => {
                return Err(PictureFault::truncated("it has no end marker (EOI)"));
            }
            None => return Err(PictureFault::damaged("there are bytes before a marker")),
        };
        at = next;
        match marker {
            0xD9 => return check_complete(frame.as_ref()),
            // A restart marker may also end the last run, and TEM has no content.
            0x01 | 0xD0..=0xD7 => continue,
            0xD8 => return Err(PictureFault::damaged("a second picture begins inside it (SOI)")),
            _ => {}
        }
        let segment = segment(bytes, at)?;
        at += 2 + segment.len();
        match marker {
            0xC0..=0xC2 if frame.is_some() => {
                return Err(PictureFault::damaged("it has a second header of a frame (SOF)"));
            }
            0xC0..=0xC2 => {
                let progressive = marker == 0xC2;
                let process = if progressive {
                    CodingProcess::Progressive
                } else {
                    CodingProcess::Sequential
                };
                frame = FrameHeader::read(process, segment)?;
                if frame.is_none() {
                    return Ok(());
                }
            }
            // These are lossless, hierarchical and arithmetic-coded files.
            0xC3 | 0xC5..=0xC7 | 0xC9..=0xCF | 0xDE | 0xDF => return Ok(()),
            0xC4 => huffman_tables(segment, &mut tables)?,
            0xDD => {
                let interval = segment.first_chunk().copied().map(u16::from_be_bytes);
                let wrong = || PictureFault::damaged("its restart interval (DRI) is wrong");
                tables.interval = interval.ok_or_else(wrong)?.into();
            }
            0xDA => {
                let frame = frame
                    .as_mut()
                    .ok_or_else(|| PictureFault::damaged("a scan comes before the frame (SOF)"))?;
                at = ScanHeader::read(frame, segment)?.follow(frame, &tables, bytes, at)?;
            }
            // These are quantization tables, application data and comments.
            _ => {}
        }
    }
}

/// Returns the content of the segment whose length is at position `at`.
fn segment(bytes: &[u8], at: usize) -> Result<&[u8], PictureFault> {
    let short = || PictureFault::truncated("it ends inside a segment");
    let rest = bytes.get(at..).unwrap_or_default();
    let length = usize::from(u16::from_be_bytes(*rest.first_chunk().ok_or_else(short)?));
    if length < 2 {
        return Err(PictureFault::damaged(format!("a segment has the length {length}")));
    }
    rest.get(2..length).ok_or_else(short)
}

/// Reads the tables of a DHT segment.
fn huffman_tables(mut segment: &[u8], tables: &mut HuffmanTables) -> Result<(), PictureFault> {
    let wrong = || PictureFault::damaged("a segment of Huffman tables (DHT) is wrong");
    while let Some((&name, rest)) = segment.split_first() {
        let counts: [u8; 16] = *rest.first_chunk().ok_or_else(wrong)?;
        let total: usize = counts.iter().map(|&count| usize::from(count)).sum();
        let symbols = rest.get(16..16 + total).filter(|_| total <= 256).ok_or_else(wrong)?;
        let class = match name >> 4 {
            0 => &mut tables.dc,
            1 => &mut tables.ac,
            _ => return Err(wrong()),
        };
        let place = class.get_mut(usize::from(name & 15)).ok_or_else(wrong)?;
        *place = Some(HuffmanTable::new(counts, symbols)?);
        segment = &rest[16 + total..];
    }
    Ok(())
}

/// Checks at the end marker that every component has been sent down to its lowest bits.
fn check_complete(frame: Option<&FrameHeader>) -> Result<(), PictureFault> {
    let frame = frame.ok_or_else(|| PictureFault::damaged("it has no frame (SOF)"))?;
    let lacks = |component: &FrameComponent| {
        component.sent[0].is_none() || component.sent.iter().flatten().any(|&low| low > 0)
    };
    if frame.components.iter().any(lacks) {
        return Err(PictureFault::damaged("a scan is missing before its end (EOI)"));
    }
    Ok(())
}
