// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Huffman tables of a JPEG.

use super::bits::BitReader;
use crate::picture::damage::PictureFault;

/// The number of bits that index the short table.
const SHORT_BITS: u32 = 9;

/// A table of codes.
#[derive(Clone)]
pub(super) struct HuffmanTable {
    /// The length and symbol of every code of at most [`SHORT_BITS`] bits, indexed by the next
    /// bits. Length 0 means that there is no such code.
    short: Vec<(u8, u8)>,
    /// Two values per code length: the first code beyond the codes of this length, aligned to 16
    /// bits, and the offset from a code to the index of its symbol.
    long: [(u32, i32); 17],
    symbols: Vec<u8>,
}

impl HuffmanTable {
    /// Makes a table from the numbers of its codes of each length, 1 to 16, and its symbols.
    pub(super) fn new(counts: [u8; 16], symbols: &[u8]) -> Result<Self, PictureFault> {
        let mut short = vec![(0, 0); 1 << SHORT_BITS];
        let mut long = [(0, 0); 17];
        let (mut code, mut next) = (0_u32, 0_usize);
        for (length, count) in (1_u8..).zip(counts) {
            let bits = u32::from(length);
            let first = i32::try_from(next).unwrap_or(0) - i32::try_from(code).unwrap_or(0);
            for _ in 0..count {
                if code >> bits != 0 {
                    return Err(PictureFault::damaged("a Huffman table has too many codes"));
                }
                if bits <= SHORT_BITS {
                    let from = (code << (SHORT_BITS - bits)) as usize;
                    let entries = short.iter_mut().skip(from).take(1 << (SHORT_BITS - bits));
                    entries.for_each(|entry| *entry = (length, symbols[next]));
                }
                code += 1;
                next += 1;
            }
            long[usize::from(length)] = (code << (16 - bits), first);
            code <<= 1;
        }
        Ok(Self { short, long, symbols: symbols.to_vec() })
    }

    /// Reads a code and returns its symbol.
    #[inline]
    pub(super) fn symbol(&self, bits: &mut BitReader<'_>) -> Result<u8, PictureFault> {
        let next = u32::from(bits.peek());
        let (length, symbol) = self.short[(next >> (16 - SHORT_BITS)) as usize];
        if length > 0 {
            bits.skip(length.into())?;
            return Ok(symbol);
        }
        for length in SHORT_BITS + 1..=16 {
            let (beyond, first) = self.long[length as usize];
            if next < beyond {
                bits.skip(length)?;
                let place = i32::try_from(next >> (16 - length)).unwrap_or(0) + first;
                let symbol = usize::try_from(place).ok().and_then(|at| self.symbols.get(at));
                return symbol.copied().ok_or_else(bad_code);
            }
        }
        Err(bad_code())
    }
}

fn bad_code() -> PictureFault {
    PictureFault::damaged("its coded pixels hold a bad Huffman code")
}
