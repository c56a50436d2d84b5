// SPDX-License-Identifier: MIT OR Apache-2.0
//! The decoder of JPEG and its check that a file is complete. Decoders are lenient with this format:
//! they fill missing or wrong data with grey, or draw the wrong codes. This check follows the
//! segments and the codes of every scan without computing a pixel, and refuses what the format does
//! not allow.
//!
//! A JPEG has no checksums. Damage is found if it leaves a code that is in no table, a block with
//! too many coefficients, a restart marker out of order, or missing or excess data at the end of a
//! scan. Damage that leaves the same number of valid codes cannot be found.

mod codes;
mod pixels;
mod scan;
mod segment;

use self::codes::HuffmanTable;
pub(super) use self::pixels::{decode, orientation, width};
use self::scan::{Frame, ScanTables};
use self::segment::Segment;
pub(super) use self::segment::outline;
use super::damage::PictureFault;

/// Finds damage between the start marker and the end marker; bytes after the end marker are
/// ignored. Kinds of JPEG that the decoder does not support either, such as lossless ones, are left
/// to the decoder.
pub(super) fn check(bytes: &[u8]) -> Result<(), PictureFault> {
    let damaged = |problem: &str| Err(PictureFault::damaged(problem));
    let mut tables = ScanTables::default();
    let mut frame: Option<Frame> = None;
    // The start marker SOI has two bytes.
    let mut at = 2;
    loop {
        let Segment { marker, content, end } = Segment::at(bytes, at)?;
        at = end;
        match (marker, &mut frame) {
            (0xD9, None) => return damaged("it has no frame (SOF)"),
            (0xD9, Some(frame)) if frame.is_complete() => return Ok(()),
            (0xD9, _) => return damaged("a scan is missing before its end (EOI)"),
            (0xD8, _) => return damaged("a second picture begins inside it (SOI)"),
            (0xC0..=0xC2, Some(_)) => return damaged("it has a second header of a frame (SOF)"),
            (0xC0..=0xC2, None) => match Frame::read(marker, content)? {
                None => return Ok(()),
                read => frame = read,
            },
            // These are lossless, hierarchical and arithmetic-coded files.
            (0xC3 | 0xC5..=0xC7 | 0xC9..=0xCF | 0xDE | 0xDF, _) => return Ok(()),
            (0xC4, _) => huffman_tables(content, &mut tables)?,
            (0xDD, _) => match content.first_chunk() {
                Some(interval) => tables.interval = u16::from_be_bytes(*interval).into(),
                None => return damaged("its restart interval (DRI) is wrong"),
            },
            (0xDA, None) => return damaged("a scan comes before the frame (SOF)"),
            (0xDA, Some(frame)) => {
                at = frame.follow(content, &tables, bytes, at)?;
            }
            // These are quantization tables, application data and comments. A restart marker may
            // also end the last run, and TEM has no content.
            _ => {}
        }
    }
}

/// Reads the tables of a DHT segment.
fn huffman_tables(mut segment: &[u8], tables: &mut ScanTables) -> Result<(), PictureFault> {
    let wrong = || PictureFault::damaged("a segment of Huffman tables (DHT) is wrong");
    while let Some((&name, rest)) = segment.split_first() {
        let (counts, rest) = rest.split_first_chunk().ok_or_else(wrong)?;
        let total = counts.iter().map(|&count| usize::from(count)).sum();
        let (symbols, rest) =
            rest.split_at_checked(total).filter(|_| total <= 256).ok_or_else(wrong)?;
        let class = tables.classes.get_mut(usize::from(name >> 4)).ok_or_else(wrong)?;
        let place = class.get_mut(usize::from(name & 15)).ok_or_else(wrong)?;
        *place = Some(HuffmanTable::new(counts, symbols)?);
        segment = rest;
    }
    Ok(())
}
