// SPDX-License-Identifier: MIT OR Apache-2.0
//! The check of the codes of a block of 8x8 coefficients.

use super::bits::{BitReader, HuffmanTable};
use super::frame::CodingProcess;
use crate::picture::damage::PictureFault;

/// The coefficients that a scan sends, and the range of their bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpectralBand {
    /// The first coefficient; the field `last` is the last one.
    pub(super) first: u8,
    pub(super) last: u8,
    /// The lowest bit that earlier scans sent, or 0 if none did; the field `low` is the lowest bit
    /// that this scan sends.
    pub(super) previous_low_bit: u8,
    pub(super) low_bit: u8,
}

/// The largest absolute DC coefficient of a block of 8-bit pixels, with a margin of a factor of
/// two.
const LARGEST_DC: i32 = 2047;

/// The state between the blocks of a scan.
pub(super) struct BlockChecker {
    band: SpectralBand,
    process: CodingProcess,
    /// The last DC coefficient of every component.
    predicted: [i32; 4],
    /// The number of blocks to come that have no code of their own.
    empty_blocks: u32,
    /// The number of blocks whose codes are all zero bits although none of their coefficients is
    /// zero.
    erased_blocks: u32,
}

type TablePair<'a> = (Option<&'a HuffmanTable>, Option<&'a HuffmanTable>);

impl BlockChecker {
    pub(super) fn new(band: SpectralBand, process: CodingProcess) -> Self {
        Self { band, process, predicted: [0; 4], empty_blocks: 0, erased_blocks: 0 }
    }

    /// Ends a run of blocks and resets the predictions.
    pub(super) fn restart(&mut self) -> Result<(), PictureFault> {
        if self.empty_blocks > 0 {
            return Err(PictureFault::damaged("a run of empty blocks goes beyond its last block"));
        }
        self.predicted = [0; 4];
        Ok(())
    }

    /// Follows a block of the component at index `place` of the scan.
    #[inline]
    pub(super) fn follow(
        &mut self,
        place: usize,
        (dc, ac): TablePair<'_>,
        nonzero: &mut u64,
        bits: &mut BitReader<'_>,
    ) -> Result<(), PictureFault> {
        let table = |table: Option<_>| {
            table.ok_or_else(|| PictureFault::damaged("a scan has no Huffman table"))
        };
        match (self.process, self.band.first, self.band.previous_low_bit) {
            (CodingProcess::Sequential, ..) => {
                self.follow_dc(place, table(dc)?, bits)?;
                let full = coefficients(table(ac)?, bits)?;
                if full { self.count_full_block(bits) } else { Ok(()) }
            }
            (CodingProcess::Progressive, 0, 0) => self.follow_dc(place, table(dc)?, bits),
            (CodingProcess::Progressive, 0, _) => bits.skip(1),
            (CodingProcess::Progressive, _, 0) => self.follow_first_pass(table(ac)?, nonzero, bits),
            (CodingProcess::Progressive, ..) => self.follow_refinement(table(ac)?, nonzero, bits),
        }
    }

    /// Counts a block without a zero coefficient. With the usual table of codes, an erased part of
    /// the file decodes as such blocks with all coefficients -1, and no real picture has two of
    /// them.
    #[cold]
    fn count_full_block(&mut self, bits: &BitReader<'_>) -> Result<(), PictureFault> {
        self.erased_blocks += u32::from(bits.follows_zeros());
        if self.erased_blocks > 1 {
            return Err(PictureFault::damaged("zeros stand where its coded pixels should be"));
        }
        Ok(())
    }

    /// Follows the code of the DC coefficient.
    #[inline]
    fn follow_dc(
        &mut self,
        place: usize,
        table: &HuffmanTable,
        bits: &mut BitReader<'_>,
    ) -> Result<(), PictureFault> {
        let length = u32::from(table.symbol(bits)?);
        if length > 11 {
            return Err(PictureFault::damaged("the mean of a block has more than 11 bits"));
        }
        let value = i32::try_from(bits.take(length)?).unwrap_or(0);
        let negative = length > 0 && value < 1 << (length - 1);
        let change = if negative { value - (1 << length) + 1 } else { value };
        let mean = &mut self.predicted[place];
        *mean += change;
        if (*mean << self.band.low_bit).abs() > LARGEST_DC {
            return Err(PictureFault::damaged(
                "the mean of a block is beyond that of 8-bit pixels",
            ));
        }
        Ok(())
    }

    /// Follows the high bits of coefficients in a progressive picture.
    fn follow_first_pass(
        &mut self,
        table: &HuffmanTable,
        nonzero: &mut u64,
        bits: &mut BitReader<'_>,
    ) -> Result<(), PictureFault> {
        if self.empty_blocks > 0 {
            self.empty_blocks -= 1;
            return Ok(());
        }
        let last = u32::from(self.band.last);
        let mut at = u32::from(self.band.first);
        while at <= last {
            let (run, length) = run_and_length(table.symbol(bits)?);
            match (run, length) {
                (15, 0) => at += 16,
                (run, 0) => {
                    self.empty_blocks = (1 << run) + bits.take(run)? - 1;
                    return Ok(());
                }
                _ => {
                    at += run;
                    if at > last {
                        return Err(too_many());
                    }
                    bits.skip(length)?;
                    *nonzero |= 1 << at;
                    at += 1;
                }
            }
        }
        if at > last + 1 { Err(too_many()) } else { Ok(()) }
    }

    /// Follows one more bit of coefficients that were sent before.
    fn follow_refinement(
        &mut self,
        table: &HuffmanTable,
        nonzero: &mut u64,
        bits: &mut BitReader<'_>,
    ) -> Result<(), PictureFault> {
        let last = u32::from(self.band.last);
        let mut at = u32::from(self.band.first);
        while self.empty_blocks == 0 && at <= last {
            let (run, length) = run_and_length(table.symbol(bits)?);
            if length == 0 && run < 15 {
                self.empty_blocks = (1 << run) + bits.take(run)?;
                break;
            }
            if length > 1 {
                return Err(PictureFault::damaged("a refined coefficient has more than one bit"));
            }
            bits.skip(length)?;
            let before = *nonzero;
            let mut zeros = run;
            while at <= last {
                if before >> at & 1 == 1 {
                    bits.skip(1)?;
                } else if zeros == 0 {
                    break;
                } else {
                    zeros -= 1;
                }
                at += 1;
            }
            if length == 1 {
                if at > last {
                    return Err(too_many());
                }
                *nonzero |= 1 << at;
            }
            at += 1;
        }
        if self.empty_blocks > 0 {
            let rest = (*nonzero).checked_shr(at).unwrap_or(0) << at.min(63);
            let here = if at > last { 0 } else { rest & (u64::MAX >> (63 - last)) };
            // There are at most 63 of these bits, which may be more than the buffer holds.
            let here = here.count_ones();
            bits.skip(here / 2)?;
            bits.skip(here - here / 2)?;
            self.empty_blocks -= 1;
        }
        Ok(())
    }
}

/// Follows all coefficients but the first. Returns true if the last coefficient is not zero.
#[inline]
fn coefficients(table: &HuffmanTable, bits: &mut BitReader<'_>) -> Result<bool, PictureFault> {
    let mut at = 1;
    while at < 64 {
        match run_and_length(table.symbol(bits)?) {
            (15, 0) => at += 16,
            (_, 0) => return Ok(false),
            (run, length) => {
                at += run + 1;
                if at > 64 {
                    return Err(too_many());
                }
                bits.skip(length)?;
            }
        }
    }
    if at > 64 { Err(too_many()) } else { Ok(true) }
}

/// Splits a symbol into the number of zeros before a coefficient and the number of its bits.
fn run_and_length(symbol: u8) -> (u32, u32) {
    (u32::from(symbol >> 4), u32::from(symbol & 15))
}

fn too_many() -> PictureFault {
    PictureFault::damaged("a block has more than 64 coefficients")
}
