// SPDX-License-Identifier: MIT OR Apache-2.0
//! A reader of the bits of entropy-coded data, up to the next marker. The Huffman tables of a
//! JPEG.

use crate::picture::damage::PictureFault;

/// Reads the bits of a JPEG from a position on. The zero byte that is stuffed after FF is removed.
/// The data ends at a marker, which stays unread, or at the end of the file.
pub(super) struct BitReader<'a> {
    bytes: &'a [u8],
    /// The position of the next byte that is not in `buffer`. At the end of the data it is the
    /// position of the marker.
    at: usize,
    /// The unread bits from the top down, followed by zeros.
    buffer: u64,
    /// The number of unread bits.
    count: u32,
    has_ended: bool,
}

impl<'a> BitReader<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at, buffer: 0, count: 0, has_ended: false }
    }

    /// Fills the buffer with at least 32 bits, if that many remain before the marker.
    #[inline]
    fn fill(&mut self) {
        while self.count <= 56 && !self.has_ended {
            match self.bytes.get(self.at) {
                Some(0xFF) => match self.bytes.get(self.at + 1) {
                    Some(0) => self.push(0xFF, 2),
                    _ => self.has_ended = true,
                },
                Some(&byte) => self.push(byte, 1),
                None => self.has_ended = true,
            }
        }
    }

    #[inline]
    fn push(&mut self, byte: u8, length: usize) {
        self.buffer |= u64::from(byte) << (56 - self.count);
        self.count += 8;
        self.at += length;
    }

    /// Returns the next 16 bits without reading them. Zeros follow the last bit.
    #[inline]
    pub(super) fn peek(&mut self) -> u16 {
        if self.count < 16 {
            self.fill();
        }
        let [high, low, ..] = self.buffer.to_be_bytes();
        u16::from_be_bytes([high, low])
    }

    /// Skips at most 32 bits.
    #[inline]
    pub(super) fn skip(&mut self, bits: u32) -> Result<(), PictureFault> {
        if self.count < bits {
            self.fill();
            if self.count < bits {
                return Err(self.missing_bits_fault());
            }
        }
        self.buffer <<= bits;
        self.count -= bits;
        Ok(())
    }

    /// Reads a number of at most 16 bits.
    #[inline]
    pub(super) fn take(&mut self, bits: u32) -> Result<u32, PictureFault> {
        let value = u32::from(self.peek()) >> (16 - bits);
        self.skip(bits)?;
        Ok(value)
    }

    /// Returns the fault for missing bits: the file is cut, or a marker comes too early.
    fn missing_bits_fault(&self) -> PictureFault {
        match self.marker() {
            None => PictureFault::truncated("its coded pixels end before the last row"),
            Some(0xD9) => PictureFault::damaged("coded pixels are missing before its end (EOI)"),
            Some(marker) => PictureFault::damaged(format!(
                "coded pixels are missing before marker {marker:02X}"
            )),
        }
    }

    /// Ends a run of data, after which only the bits that fill its last byte may be left. Returns
    /// the position of the marker that follows.
    pub(super) fn end_run(&mut self) -> Result<usize, PictureFault> {
        self.fill();
        if self.count >= 8 {
            return Err(PictureFault::damaged("there is more coded data than its pixels need"));
        }
        match self.marker() {
            Some(_) => Ok(self.at),
            None => Err(PictureFault::truncated("it has no end marker (EOI)")),
        }
    }

    /// Returns true if the bits that were read last, as many as a full block has, are zeros.
    pub(super) fn follows_zeros(&self) -> bool {
        /// The number of bytes of 63 codes of three bits each.
        const FULL_BLOCK: usize = 23;
        let unread = self.count.div_ceil(8) as usize;
        let read = self.at.checked_sub(unread);
        let from = read.and_then(|read| read.checked_sub(FULL_BLOCK));
        let last = from.zip(read).and_then(|(from, read)| self.bytes.get(from..read));
        last.is_some_and(|last| last.iter().all(|&byte| byte == 0))
    }

    /// Begins a new run of data.
    pub(super) fn restart(&mut self, at: usize) {
        *self = Self::new(self.bytes, at);
    }

    /// Returns the marker at the end of the data.
    fn marker(&self) -> Option<u8> {
        marker_at(self.bytes, self.at).map(|(marker, _)| marker)
    }
}

/// Returns the marker at a position, which may begin with several bytes FF, and the position after
/// it.
pub(super) fn marker_at(bytes: &[u8], at: usize) -> Option<(u8, usize)> {
    let rest = bytes.get(at..)?;
    let fill = rest.iter().take_while(|&&byte| byte == 0xFF).count();
    let marker = *rest.get(fill)?;
    (fill > 0 && marker != 0).then_some((marker, at + fill + 1))
}

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
