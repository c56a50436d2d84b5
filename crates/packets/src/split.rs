// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds packets in bytes. Bytes that belong to no packet are skipped one by one, so the next whole
//! packet is found wherever it begins.

use crate::layout::{MARK, WORD};
use crate::packet::Head;
use crate::{Layout, Packet};

/// The number of skipped bytes that are reported at the latest, so that endless noise is noticed.
const REPORTED: u64 = 1 << 20;

/// The next item of a stream.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Found {
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
    Nothing,
}

/// Splits the bytes of a stream into packets.
#[derive(Debug, Default)]
pub struct Splitter {
    bytes: Vec<u8>,
    /// The number of bytes at the front of `bytes` that are consumed.
    at: usize,
    /// The offset of `bytes` in the stream.
    offset: u64,
    /// The number of bytes before `at` that were skipped and are not reported yet.
    skipped: u64,
    is_complete: bool,
}

impl Splitter {
    /// Takes the next bytes of the stream.
    pub fn feed(&mut self, bytes: &[u8]) {
        self.bytes.drain(..self.at);
        self.offset += length(self.at);
        self.at = 0;
        self.bytes.extend_from_slice(bytes);
    }

    /// Returns the number of bytes of the stream that are consumed.
    #[must_use]
    pub fn position(&self) -> u64 {
        self.offset + length(self.at)
    }

    /// Marks the end of the stream: no bytes follow.
    pub fn complete(&mut self) {
        self.is_complete = true;
    }

    /// Returns the next item. Without a layout, which the first FRAME determines, only a FRAME or a
    /// REGISTER is found.
    pub fn next(&mut self, layout: Option<&Layout>) -> Found {
        while let Some(ahead) = self.bytes.get(self.at..) {
            if self.skipped >= REPORTED {
                return self.skipped();
            }
            let before = ahead.iter().position(|&byte| byte == MARK).unwrap_or(ahead.len());
            if before > 0 {
                self.pass(before);
                continue;
            }
            let whole = match Head::of(ahead, layout) {
                None if ahead.len() < WORD && !self.is_complete => return Found::Nothing,
                None => None,
                Some(head) => match ahead.get(..head.words * WORD) {
                    None if !self.is_complete => return Found::Nothing,
                    None => None,
                    Some(bytes) => Packet::of(bytes, head, layout).zip(Some(bytes.len())),
                },
            };
            match whole {
                Some(_) if self.skipped > 0 => return self.skipped(),
                Some(((frame, packet), bytes)) => {
                    self.at += bytes;
                    return Found::Packet { frame, packet };
                }
                None if ahead.is_empty() => break,
                None => self.pass(1),
            }
        }
        if self.is_complete && self.skipped > 0 { self.skipped() } else { Found::Nothing }
    }

    /// Skips this number of bytes.
    fn pass(&mut self, bytes: usize) {
        self.at += bytes;
        self.skipped += length(bytes);
    }

    /// Reports the skipped bytes.
    fn skipped(&mut self) -> Found {
        let bytes = std::mem::take(&mut self.skipped);
        Found::Skipped { offset: self.position() - bytes, bytes }
    }
}

fn length(bytes: usize) -> u64 {
    u64::try_from(bytes).unwrap_or(u64::MAX)
}
