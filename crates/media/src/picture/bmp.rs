// SPDX-License-Identifier: MIT OR Apache-2.0
//! The check of run-length coded BMP files: the runs must fill the rows. The decoder draws black
//! for missing pixels, and does not require the end code.

use super::damage::PictureFault;

/// Follows the runs of a file whose header the decoder has read. Files without runs have nothing to
/// check.
pub(super) fn check(bytes: &[u8]) -> Result<(), PictureFault> {
    let Some(RunLengthReader { width, height, is_four_bit: half, mut codes }) =
        run_length_reader(bytes)
    else {
        return Ok(());
    };
    let short = || PictureFault::truncated("its runs of pixels have no end");
    let (mut x, mut y) = (0_u32, 0_u32);
    // A jump leaves pixels out on purpose.
    let mut jumped = false;
    loop {
        let ([count, value], rest) = codes.split_first_chunk().ok_or_else(short)?;
        codes = rest;
        let filled = y >= height || x >= width || jumped;
        match (count, value) {
            (0, 1) if y + 1 < height || !filled => {
                return Err(PictureFault::damaged("its runs of pixels end before the last row"));
            }
            (0, 1) => return Ok(()),
            (0, 0) if !filled => {
                return Err(PictureFault::damaged("a row ends before its last pixel"));
            }
            (0, 0) => (x, y) = (0, y + 1),
            (0, 2) => {
                let ([right, down], rest) = codes.split_first_chunk().ok_or_else(short)?;
                codes = rest;
                (x, y) = (x + u32::from(*right), y + u32::from(*down));
                jumped = true;
            }
            (0, &length) => {
                let bytes = if half { length.div_ceil(2) } else { length };
                let bytes = usize::from(bytes).next_multiple_of(2);
                codes = codes.get(bytes..).ok_or_else(short)?;
                x += u32::from(length);
            }
            (&length, _) => x += u32::from(length),
        }
        if y > height || (y == height && x > 0) {
            return Err(PictureFault::damaged("it has more rows than its header says"));
        }
    }
}

/// The run-length codes of a file, and the size of its picture.
struct RunLengthReader<'a> {
    width: u32,
    height: u32,
    /// True if a pixel has four bits instead of eight.
    is_four_bit: bool,
    codes: &'a [u8],
}

fn run_length_reader(bytes: &[u8]) -> Option<RunLengthReader<'_>> {
    let word = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
    let (offset, header, compression) = (word(10)?, word(14)?, word(30)?);
    let half = match compression {
        1 => false,
        2 => true,
        _ => return None,
    };
    // Shorter headers do not have the field `compression`.
    (header >= 40).then_some(())?;
    let height = i32::from_le_bytes(word(22)?.to_le_bytes()).unsigned_abs();
    Some(RunLengthReader {
        width: word(18)?,
        height,
        is_four_bit: half,
        codes: bytes.get(offset as usize..)?,
    })
}
