// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds packets in bytes. What is no packet is passed over byte by byte, so that the next whole packet is found
//! wherever it begins.

use crate::layout::{MARK, WORD};
use crate::packet::Head;
use crate::{Layout, Packet};

/// So many bytes that are no packet are reported, even if more of them follow: noise without end is noticed.
const REPORTED: u64 = 1 << 20;

/// What comes next in a stream.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Found {
    /// A packet.
    Packet {
        /// Number of its frame.
        frame: u32,
        /// The packet.
        packet: Packet,
    },
    /// Bytes that are no packet.
    Skipped {
        /// Where they begin.
        offset: u64,
        /// How many there are.
        bytes: u64,
    },
    /// More bytes are needed to say, or there are no more.
    Nothing,
}

/// Bytes on their way to packets.
#[derive(Debug, Default)]
pub struct Splitter {
    bytes: Vec<u8>,
    /// Bytes of them that are done with.
    at: usize,
    /// Where `bytes` begin in the stream.
    offset: u64,
    /// Bytes before `at` that are not reported yet.
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

    /// Bytes of the stream that are done with.
    #[must_use]
    pub fn position(&self) -> u64 {
        self.offset + length(self.at)
    }

    /// There are no more bytes.
    pub fn complete(&mut self) {
        self.is_complete = true;
    }

    /// What comes next. Without a layout, which the first FRAME gives, only a
    /// FRAME or a REGISTER is found.
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

    /// Passes over so many bytes.
    fn pass(&mut self, bytes: usize) {
        self.at += bytes;
        self.skipped += length(bytes);
    }

    /// Reports what was passed over.
    fn skipped(&mut self) -> Found {
        let bytes = std::mem::take(&mut self.skipped);
        Found::Skipped { offset: self.position() - bytes, bytes }
    }
}

fn length(bytes: usize) -> u64 {
    u64::try_from(bytes).unwrap_or(u64::MAX)
}
