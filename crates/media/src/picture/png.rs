// SPDX-License-Identifier: MIT OR Apache-2.0
//! The check that a PNG is complete: every chunk has a correct checksum, there is an end chunk, and
//! the compressed data has the length of the pixels and a correct checksum. The decoder stops at
//! the last pixel, and ignores the checksums of chunks that it does not need.

use std::io::{self, Read};

use flate2::bufread::ZlibDecoder;

use super::conversion::ImageOutline;
use super::damage::PictureFault;
use crate::limits::{MAX_FILE_GIB, MAX_SIDE};

const SIGNATURE: usize = 8;

/// A chunk with its name and its data.
struct PngChunk<'a> {
    name: [u8; 4],
    data: &'a [u8],
}

/// Finds damage between the signature and the end chunk; bytes after it are ignored.
pub(super) fn check(bytes: &[u8]) -> Result<(), PictureFault> {
    let mut rest = bytes.get(SIGNATURE..).unwrap_or_default();
    let mut header = None;
    let mut pixels: Vec<&[u8]> = Vec::new();
    loop {
        let chunk = next_chunk(&mut rest)?;
        match &chunk.name {
            b"IHDR" => header = Some(chunk.data),
            b"IDAT" => pixels.push(chunk.data),
            b"IEND" => break,
            _ => {}
        }
    }
    // If there is no size, or it is beyond the limits, the decoder reports the problem.
    match header.and_then(raw_length) {
        Some(length) if length <= MAX_FILE_GIB << 30 => inflate(&pixels, length),
        _ => Ok(()),
    }
}

/// Returns the outline of a PNG. Returns `None` if its first chunk is no header.
pub(super) fn outline(bytes: &[u8]) -> Option<ImageOutline<'_>> {
    let mut rest = bytes.get(SIGNATURE..)?;
    let header = next_chunk(&mut rest).ok().filter(|chunk| &chunk.name == b"IHDR")?.data;
    while let Ok(chunk) = next_chunk(&mut rest) {
        if &chunk.name == b"IEND" {
            return Some(ImageOutline { header, after: Some(rest) });
        }
    }
    Some(ImageOutline { header, after: None })
}

/// Takes the next chunk from the front: length, name, data, checksum.
fn next_chunk<'a>(rest: &mut &'a [u8]) -> Result<PngChunk<'a>, PictureFault> {
    let short = || PictureFault::truncated("it has no end chunk (IEND)");
    let (length, body) = rest.split_first_chunk().ok_or_else(short)?;
    let length = u32::from_be_bytes(*length) as usize;
    let (name, data) = body.split_first_chunk().ok_or_else(short)?;
    let (data, after) = data.split_at_checked(length).ok_or_else(short)?;
    let (sum, after) = after.split_first_chunk().ok_or_else(short)?;
    if crc32fast::hash(&body[..4 + length]) != u32::from_be_bytes(*sum) {
        let name = name.escape_ascii();
        return Err(PictureFault::damaged(format!("the checksum of its chunk {name} is wrong")));
    }
    *rest = after;
    Ok(PngChunk { name: *name, data })
}

/// Returns the number of bytes of all rows with their filter bytes, according to the header.
fn raw_length(header: &[u8]) -> Option<u64> {
    /// The first pixel and the step of each pass of Adam7, across and down.
    const PASSES: [[u32; 4]; 7] = [
        [0, 8, 0, 8],
        [4, 8, 0, 8],
        [0, 4, 4, 8],
        [2, 4, 0, 4],
        [0, 2, 2, 4],
        [1, 2, 0, 2],
        [0, 1, 1, 2],
    ];
    let &[a, b, c, d, e, f, g, h, depth, colour, 0, 0, interlaced] = header else { return None };
    let (width, height) = (u32::from_be_bytes([a, b, c, d]), u32::from_be_bytes([e, f, g, h]));
    if width.max(height) > MAX_SIDE {
        return None;
    }
    let samples = match colour {
        0 | 3 => 1,
        2 => 3,
        4 => 2,
        6 => 4,
        _ => return None,
    };
    let length = |width: u32, height: u32| {
        let row = u64::from(width) * samples * u64::from(depth);
        if width == 0 { 0 } else { (row.div_ceil(8) + 1) * u64::from(height) }
    };
    let part = |size: u32, first: u32, step: u32| size.saturating_sub(first).div_ceil(step);
    match interlaced {
        0 => Some(length(width, height)),
        1 => Some(
            PASSES
                .iter()
                .map(|&[x, dx, y, dy]| length(part(width, x, dx), part(height, y, dy)))
                .sum(),
        ),
        _ => None,
    }
}

/// Unpacks the compressed data, and checks that it has exactly the length of the rows.
fn inflate(pixels: &[&[u8]], length: u64) -> Result<(), PictureFault> {
    let packed = pixels.concat();
    let mut rows = ZlibDecoder::new(packed.as_slice());
    // One byte more shows that there are too many.
    let unpacked = io::copy(&mut rows.by_ref().take(length + 1), &mut io::sink());
    match unpacked {
        Ok(found) if found < length => Err(PictureFault::truncated(format!(
            "it has {found} bytes of pixels, but needs {length}"
        ))),
        Ok(found) if found > length => {
            Err(PictureFault::damaged(format!("it has more than the {length} bytes of its pixels")))
        }
        Ok(_) if rows.total_in() < packed.len() as u64 => {
            Err(PictureFault::damaged("there are bytes after its compressed pixels"))
        }
        Ok(_) => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
            Err(PictureFault::truncated("its compressed pixels have no end"))
        }
        Err(error) => Err(PictureFault::damaged(format!("its compressed pixels: {error}"))),
    }
}
