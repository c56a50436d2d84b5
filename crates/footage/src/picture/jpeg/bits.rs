// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bits of entropy-coded data, up to the next marker.

use crate::picture::fault::PictureFault;

/// Bits of a JPEG from a place in the file on. A stuffed zero after FF is taken out. The data ends at
/// a marker, which stays unread, or at the end of the file.
pub(super) struct BitReader<'a> {
    bytes: &'a [u8],
    /// The next byte that is not in `buffer`; at the end of the data the place of the marker.
    at: usize,
    /// Unread bits, the first at the top; zeros follow them.
    buffer: u64,
    /// How many unread bits there are.
    count: u32,
    ended: bool,
}

impl<'a> BitReader<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at, buffer: 0, count: 0, ended: false }
    }

    /// Fills the buffer with at least 32 bits, if there are as many before the marker.
    #[inline]
    fn fill(&mut self) {
        while self.count <= 56 && !self.ended {
            match self.bytes.get(self.at) {
                Some(0xFF) => match self.bytes.get(self.at + 1) {
                    Some(0) => self.push(0xFF, 2),
                    _ => self.ended = true,
                },
                Some(&byte) => self.push(byte, 1),
                None => self.ended = true,
            }
        }
    }

    #[inline]
    fn push(&mut self, byte: u8, length: usize) {
        self.buffer |= u64::from(byte) << (56 - self.count);
        self.count += 8;
        self.at += length;
    }

    /// The next 16 bits, with zeros after the last one.
    #[inline]
    pub(super) fn peek(&mut self) -> u16 {
        if self.count < 16 {
            self.fill();
        }
        let [high, low, ..] = self.buffer.to_be_bytes();
        u16::from_be_bytes([high, low])
    }

    /// Passes over at most 32 bits.
    #[inline]
    pub(super) fn skip(&mut self, bits: u32) -> Result<(), PictureFault> {
        if self.count < bits {
            self.fill();
            if self.count < bits {
                return Err(self.short());
            }
        }
        self.buffer <<= bits;
        self.count -= bits;
        Ok(())
    }

    /// A number of at most 16 bits.
    #[inline]
    pub(super) fn take(&mut self, bits: u32) -> Result<u32, PictureFault> {
        let value = u32::from(self.peek()) >> (16 - bits);
        self.skip(bits)?;
        Ok(value)
    }

    /// The fault behind missing bits: the file is cut, or a marker comes too early.
    fn short(&self) -> PictureFault {
        match self.marker() {
            None => PictureFault::truncated("its coded pixels end before the last row"),
            Some(0xD9) => PictureFault::damaged("coded pixels are missing before its end (EOI)"),
            Some(marker) => PictureFault::damaged(format!(
                "coded pixels are missing before marker {marker:02X}"
            )),
        }
    }

    /// Ends a run of data: only the bits that fill its last byte may be left. Gives the place of the
    /// marker that follows.
    pub(super) fn end(&mut self) -> Result<usize, PictureFault> {
        self.fill();
        if self.count >= 8 {
            return Err(PictureFault::damaged("there is more coded data than its pixels need"));
        }
        match self.marker() {
            Some(_) => Ok(self.at),
            None => Err(PictureFault::truncated("it has no end marker (EOI)")),
        }
    }

    /// Whether the last bits that were read, as many as a full block has, are zeros.
    pub(super) fn follows_zeros(&self) -> bool {
        /// The bits of 63 codes of three bits each.
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

    /// The marker at the end of the data.
    fn marker(&self) -> Option<u8> {
        marker_at(self.bytes, self.at).map(|(marker, _)| marker)
    }
}

/// The marker at a place, which may begin with several FF, and the place after it.
pub(super) fn marker_at(bytes: &[u8], at: usize) -> Option<(u8, usize)> {
    let rest = bytes.get(at..)?;
    let fill = rest.iter().take_while(|&&byte| byte == 0xFF).count();
    let marker = *rest.get(fill)?;
    (fill > 0 && marker != 0).then_some((marker, at + fill + 1))
}
