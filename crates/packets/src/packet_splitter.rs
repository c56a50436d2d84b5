// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds packets in bytes. Bytes that belong to no packet are skipped one by one, so the next whole
//! packet is found wherever it begins.

use crate::packet::PacketHead;
use crate::packet_layout::{MARK, WORD_BYTES};
use crate::{Packet, PacketLayout};

/// The number of skipped bytes from which they are reported, although more may follow, so that
/// endless noise is noticed.
const REPORTED_BYTES: u64 = 1 << 20;

/// The next item of a stream.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StreamItem {
    /// A packet.
    Packet {
        /// The number of its frame.
        frame: u32,
        /// The packet.
        packet: Packet,
    },
    /// Bytes that belong to no packet.
    Skipped {
        /// The offset of the first byte in the stream.
        offset: u64,
        /// The number of bytes.
        bytes: u64,
    },
    /// The splitter needs more bytes, or the stream has ended.
    Pending,
}

/// Splits the bytes of a stream into packets.
#[derive(Debug, Default)]
pub struct PacketSplitter {
    bytes: Vec<u8>,
    /// The number of bytes at the front of `bytes` that are consumed.
    consumed: usize,
    /// The offset of `bytes` in the stream.
    offset: u64,
    /// The number of consumed bytes that were skipped and are not reported yet.
    skipped: u64,
    is_complete: bool,
}

impl PacketSplitter {
    /// Takes the next bytes of the stream.
    pub fn feed(&mut self, bytes: &[u8]) {
        self.bytes.drain(..self.consumed);
        self.offset += length(self.consumed);
        self.consumed = 0;
        self.bytes.extend_from_slice(bytes);
    }

    /// Returns the number of bytes of the stream that are consumed.
    #[must_use]
    pub fn consumed_bytes(&self) -> u64 {
        self.offset + length(self.consumed)
    }

    /// Marks the end of the stream: no bytes follow.
    pub fn mark_complete(&mut self) {
        self.is_complete = true;
    }

    /// Returns the next item. Without a layout, which the first FRAME determines, only a FRAME or a
    /// REGISTER is found.
    pub fn next(&mut self, layout: Option<&PacketLayout>) -> StreamItem {
        while let Some(remaining) = self.bytes.get(self.consumed..) {
            if self.skipped >= REPORTED_BYTES {
                return self.take_skipped();
            }
            let before = remaining.iter().position(|&byte| byte == MARK).unwrap_or(remaining.len());
            if before > 0 {
                self.skip(before);
                continue;
            }
            let parsed = match PacketHead::of(remaining, layout) {
                None if remaining.len() < WORD_BYTES && !self.is_complete => {
                    return StreamItem::Pending;
                }
                None => None,
                Some(head) => match remaining.get(..head.words * WORD_BYTES) {
                    None if !self.is_complete => return StreamItem::Pending,
                    None => None,
                    Some(bytes) => Packet::of(bytes, head, layout).zip(Some(bytes.len())),
                },
            };
            match parsed {
                Some(_) if self.skipped > 0 => return self.take_skipped(),
                Some(((frame, packet), bytes)) => {
                    self.consumed += bytes;
                    return StreamItem::Packet { frame, packet };
                }
                None if remaining.is_empty() => break,
                None => self.skip(1),
            }
        }
        if self.is_complete && self.skipped > 0 { self.take_skipped() } else { StreamItem::Pending }
    }

    /// Skips this number of bytes.
    fn skip(&mut self, bytes: usize) {
        self.consumed += bytes;
        self.skipped += length(bytes);
    }

    /// Reports the skipped bytes.
    fn take_skipped(&mut self) -> StreamItem {
        let bytes = std::mem::take(&mut self.skipped);
        StreamItem::Skipped { offset: self.consumed_bytes() - bytes, bytes }
    }
}

fn length(bytes: usize) -> u64 {
    u64::try_from(bytes).unwrap_or(u64::MAX)
}
