// SPDX-License-Identifier: MIT OR Apache-2.0
//! Follows the codes of a block of 8x8 coefficients.

use super::bits::BitReader;
use super::frame::Process;
use super::huffman::HuffmanTable;
use crate::picture::fault::PictureFault;

/// The coefficients that a scan sends, and which bits of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpectralBand {
    /// The first and the last coefficient.
    pub(super) first: u8,
    pub(super) last: u8,
    /// The lowest bit that scans before sent, 0 for none, and the lowest that this one sends.
    pub(super) high: u8,
    pub(super) low: u8,
}

/// Largest mean of a block of 8-bit pixels, with a factor of two to spare.
const LARGEST_DC: i32 = 2047;

/// State between the blocks of a scan.
pub(super) struct Block {
    band: SpectralBand,
    process: Process,
    /// The last DC coefficient of every component.
    predicted: [i32; 4],
    /// Blocks to come without a code of their own.
    empty: u32,
    /// Blocks whose codes are zeros alone, although no coefficient is zero.
    erased: u32,
}

type TablePair<'a> = (Option<&'a HuffmanTable>, Option<&'a HuffmanTable>);

impl Block {
    pub(super) fn new(band: SpectralBand, process: Process) -> Self {
        Self { band, process, predicted: [0; 4], empty: 0, erased: 0 }
    }

    /// Ends a run of blocks, after which nothing is remembered.
    pub(super) fn restart(&mut self) -> Result<(), PictureFault> {
        if self.empty > 0 {
            return Err(PictureFault::damaged("a run of empty blocks goes beyond its last block"));
        }
        self.predicted = [0; 4];
        Ok(())
    }

    /// Follows a block of the component at a place in the scan.
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
        match (self.process, self.band.first, self.band.high) {
            (Process::Sequential, ..) => {
                self.mean(place, table(dc)?, bits)?;
                let full = coefficients(table(ac)?, bits)?;
                if full { self.note_full(bits) } else { Ok(()) }
            }
            (Process::Progressive, 0, 0) => self.mean(place, table(dc)?, bits),
            (Process::Progressive, 0, _) => bits.skip(1),
            (Process::Progressive, _, 0) => self.first_pass(table(ac)?, nonzero, bits),
            (Process::Progressive, ..) => self.refine(table(ac)?, nonzero, bits),
        }
    }

    /// Notes a block in which no coefficient is zero. With the usual table of codes, an erased stretch of the
    /// file is such blocks, all their coefficients -1, which no picture has twice.
    #[cold]
    fn note_full(&mut self, bits: &BitReader<'_>) -> Result<(), PictureFault> {
        self.erased += u32::from(bits.follows_zeros());
        if self.erased > 1 {
            return Err(PictureFault::damaged("zeros stand where its coded pixels should be"));
        }
        Ok(())
    }

    /// The DC coefficient.
    #[inline]
    fn mean(
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
        if (*mean << self.band.low).abs() > LARGEST_DC {
            return Err(PictureFault::damaged(
                "the mean of a block is beyond that of 8-bit pixels",
            ));
        }
        Ok(())
    }

    /// The high bits of coefficients in a progressive picture.
    fn first_pass(
        &mut self,
        table: &HuffmanTable,
        nonzero: &mut u64,
        bits: &mut BitReader<'_>,
    ) -> Result<(), PictureFault> {
        if self.empty > 0 {
            self.empty -= 1;
            return Ok(());
        }
        let last = u32::from(self.band.last);
        let mut at = u32::from(self.band.first);
        while at <= last {
            let (run, length) = run_and_length(table.symbol(bits)?);
            match (run, length) {
                (15, 0) => at += 16,
                (run, 0) => {
                    self.empty = (1 << run) + bits.take(run)? - 1;
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

    /// A further bit of coefficients that were sent before.
    fn refine(
        &mut self,
        table: &HuffmanTable,
        nonzero: &mut u64,
        bits: &mut BitReader<'_>,
    ) -> Result<(), PictureFault> {
        let last = u32::from(self.band.last);
        let mut at = u32::from(self.band.first);
        while self.empty == 0 && at <= last {
            let (run, length) = run_and_length(table.symbol(bits)?);
            if length == 0 && run < 15 {
                self.empty = (1 << run) + bits.take(run)?;
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
        if self.empty > 0 {
            let rest = (*nonzero).checked_shr(at).unwrap_or(0) << at.min(63);
            let here = if at > last { 0 } else { rest & (u64::MAX >> (63 - last)) };
            // At most 63 of them, more than the buffer may hold at once.
            let here = here.count_ones();
            bits.skip(here / 2)?;
            bits.skip(here - here / 2)?;
            self.empty -= 1;
        }
        Ok(())
    }
}

/// All coefficients but the first. Gives whether there is one at the last place.
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

/// Zeros before a coefficient, and how many bits it has.
fn run_and_length(symbol: u8) -> (u32, u32) {
    (u32::from(symbol >> 4), u32::from(symbol & 15))
}

fn too_many() -> PictureFault {
    PictureFault::damaged("a block has more than 64 coefficients")
}
