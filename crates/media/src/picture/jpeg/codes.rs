// SPDX-License-Identifier: MIT OR Apache-2.0
//! The codes of a scan. Only their lengths count, and which coefficients are not zero.

use super::segment::marker_at;
use crate::picture::damage::{PictureFault, require};

/// The coded data between two markers, read bit by bit.
pub(super) struct CodedRun {
    /// The bytes without the zeros that are stuffed after FF, and with four more zeros at the end.
    bytes: Vec<u8>,
    /// The number of bits that have been read, and of those that there are.
    at: usize,
    end: usize,
    /// The position after the run in the file.
    pub(super) after: usize,
    /// The marker there, and the position after it. There is none if the file ends.
    marker: Option<(u8, usize)>,
}

impl CodedRun {
    pub(super) fn new(file: &[u8], at: usize) -> Self {
        let (mut bytes, mut after) = (Vec::new(), at);
        loop {
            let rest = &file[after..];
            let plain = rest.iter().position(|&byte| byte == 0xFF).unwrap_or(rest.len());
            bytes.extend(&rest[..plain]);
            after += plain;
            let [0xFF, 0, ..] = rest[plain..] else { break };
            bytes.push(0xFF);
            after += 2;
        }
        let end = 8 * bytes.len();
        bytes.extend([0; 4]);
        Self { bytes, at: 0, end, after, marker: marker_at(file, after) }
    }

    /// Returns the next 16 bits without reading them. Zeros follow the last bit.
    #[inline]
    fn peek(&self) -> u32 {
        let next = self.bytes[self.at / 8..].first_chunk().copied().unwrap_or_default();
        u32::from_be_bytes(next) << (self.at % 8) >> 16
    }

    #[inline]
    fn skip(&mut self, bits: u32) -> Result<(), PictureFault> {
        self.at += bits as usize;
        if self.at <= self.end { Ok(()) } else { Err(self.missing_bits_fault()) }
    }

    /// Reads a number of at most 16 bits.
    #[inline]
    fn take(&mut self, bits: u32) -> Result<u32, PictureFault> {
        let value = self.peek() >> (16 - bits);
        self.skip(bits).map(|()| value)
    }

    /// Reads a code and returns the halves of its symbol: the number of zeros before a coefficient
    /// and the number of its bits.
    #[inline]
    fn symbol(&mut self, table: &HuffmanTable) -> Result<(u32, u32), PictureFault> {
        let (length, symbol) = table.0.get(self.peek() as usize).copied().unwrap_or_default();
        require(length > 0, "its coded pixels hold a bad Huffman code")?;
        self.skip(length.into())?;
        Ok(((symbol >> 4).into(), (symbol & 15).into()))
    }

    /// Returns the fault for missing bits: the file is cut, or a marker comes too early.
    #[cold]
    fn missing_bits_fault(&self) -> PictureFault {
        match self.marker {
            None => PictureFault::truncated("its coded pixels end before the last row"),
            Some((0xD9, _)) => {
                PictureFault::damaged("coded pixels are missing before its end (EOI)")
            }
            Some((marker, _)) => PictureFault::damaged(format!(
                "coded pixels are missing before marker {marker:02X}"
            )),
        }
    }

    /// Ends the run, after which only the bits that fill its last byte may be left. Returns the
    /// marker that follows, and the position after it.
    pub(super) fn end(&self) -> Result<(u8, usize), PictureFault> {
        require(self.end < self.at + 8, "there is more coded data than its pixels need")?;
        self.marker.ok_or_else(|| PictureFault::truncated("it has no end marker (EOI)"))
    }
}

/// The length and symbol of the code with which 16 bits begin, for all 16 bits with such a code.
pub(super) struct HuffmanTable(Vec<(u8, u8)>);

impl HuffmanTable {
    /// Makes a table from the numbers of its codes of each length, 1 to 16, and its symbols.
    pub(super) fn new(counts: &[u8; 16], symbols: &[u8]) -> Result<Self, PictureFault> {
        let lengths = (1..).zip(counts).flat_map(|(length, &count)| vec![length; count.into()]);
        let mut codes = Vec::new();
        for (length, &symbol) in lengths.zip(symbols) {
            codes.resize(codes.len() + (1 << (16 - length)), (length, symbol));
        }
        require(codes.len() <= 1 << 16, "a Huffman table has too many codes").map(|()| Self(codes))
    }
}

/// The coefficients that a scan sends, and the range of their bits.
#[derive(Clone, Copy)]
pub(super) struct SpectralBand {
    pub(super) first: u8,
    pub(super) last: u8,
    /// The lowest bit that earlier scans sent, or 0 if none did.
    pub(super) previous_low_bit: u8,
    /// The lowest bit that this scan sends.
    pub(super) low_bit: u8,
}

/// The state between the blocks of a scan.
pub(super) struct BlockChecker {
    pub(super) band: SpectralBand,
    pub(super) run: CodedRun,
    /// The number of blocks to come that have no code of their own.
    empty_blocks: u32,
    /// The number of blocks whose codes are all zero bits although none of their coefficients is.
    erased_blocks: u32,
}

impl BlockChecker {
    pub(super) fn new(band: SpectralBand, run: CodedRun) -> Self {
        Self { band, run, empty_blocks: 0, erased_blocks: 0 }
    }

    /// Ends a run of blocks. Returns the result of [`CodedRun::end`].
    pub(super) fn end_run(&self) -> Result<(u8, usize), PictureFault> {
        require(self.empty_blocks == 0, "a run of empty blocks goes beyond its last block")?;
        self.run.end()
    }

    /// Follows a block. Each of its coefficients that is not zero has a bit in `nonzero`.
    #[inline]
    pub(super) fn follow(
        &mut self,
        [dc, ac]: [Option<&HuffmanTable>; 2],
        nonzero: &mut u64,
    ) -> Result<(), PictureFault> {
        /// The number of bytes of 63 codes of three bits each.
        const FULL_BLOCK: usize = 23;
        let no_table = || PictureFault::damaged("a scan has no Huffman table");
        match (self.band.first, self.band.previous_low_bit) {
            (0, 0) => {
                let (zeros, length) = self.run.symbol(dc.ok_or_else(no_table)?)?;
                require(zeros == 0 && length <= 11, "the mean of a block has more than 11 bits")?;
                self.run.skip(length)?;
            }
            (0, _) => self.run.skip(1)?,
            _ => {}
        }
        if self.band.last > 0 {
            self.follow_coefficients(ac.ok_or_else(no_table)?, nonzero)?;
        }
        // With the usual table of codes, an erased part of a sequential picture decodes as blocks
        // with all coefficients -1, and no real picture has two of them.
        if self.band.first == 0 && *nonzero >> 63 == 1 {
            let read = &self.run.bytes[..self.run.at / 8];
            self.erased_blocks += u32::from(read.ends_with(&[0; FULL_BLOCK]));
            require(self.erased_blocks < 2, "zeros stand where its coded pixels should be")?;
        }
        Ok(())
    }

    /// Follows the codes of the other coefficients. Those that are not zero since earlier scans
    /// have one more bit each, where the codes pass them.
    #[inline]
    fn follow_coefficients(
        &mut self,
        table: &HuffmanTable,
        nonzero: &mut u64,
    ) -> Result<(), PictureFault> {
        let last = u32::from(self.band.last);
        let refines = self.band.previous_low_bit > 0;
        let mut at = u32::from(self.band.first.max(1));
        while self.empty_blocks == 0 && at <= last {
            let (mut zeros, length) = self.run.symbol(table)?;
            if length == 0 && zeros < 15 {
                self.empty_blocks = (1 << zeros) + self.run.take(zeros)?;
                break;
            }
            require(!refines || length < 2, "a refined coefficient has more than one bit")?;
            self.run.skip(length)?;
            if refines {
                while at <= last && (zeros > 0 || *nonzero >> at & 1 == 1) {
                    let has_bit = u32::from(*nonzero >> at & 1 == 1);
                    self.run.skip(has_bit)?;
                    zeros -= 1 - has_bit;
                    at += 1;
                }
            } else {
                at += zeros;
            }
            require(at <= last, "a block has more than 64 coefficients")?;
            *nonzero |= u64::from(length > 0) << at;
            at += 1;
        }
        if self.empty_blocks > 0 {
            let rest = nonzero.checked_shr(at).unwrap_or(0) << at.min(63) << (63 - last);
            self.run.skip(rest.count_ones())?;
            self.empty_blocks -= 1;
        }
        Ok(())
    }
}
