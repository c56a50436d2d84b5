// SPDX-License-Identifier: MIT OR Apache-2.0
//! A pseudo-terminal in place of a serial line. The test is the board.

use std::fs::File;
use std::io::{Read, Write};
use std::path::PathBuf;

use foveate_packets::{Packet, PacketSplitter, RegisterPacket, StreamItem};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

/// The board's end of the line.
pub(crate) struct SerialLine {
    board: File,
    pub(crate) path: PathBuf,
}

impl SerialLine {
    pub(crate) fn new() -> Self {
        let board = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&board).unwrap();
        unlockpt(&board).unwrap();
        let path = ptsname(&board, Vec::new()).unwrap().into_string().unwrap().into();
        Self { board: File::from(board), path }
    }

    pub(crate) fn send(&mut self, bytes: &[u8]) {
        self.board.write_all(bytes).unwrap();
    }

    /// Returns the next command, which must be exactly a REGISTER packet.
    pub(crate) fn command(&mut self) -> RegisterPacket {
        let mut bytes = [0; 24];
        self.board.read_exact(&mut bytes).unwrap();
        let mut splitter = PacketSplitter::default();
        splitter.feed(&bytes);
        match splitter.next(None) {
            StreamItem::Packet { frame: 0, packet: Packet::Register(register) } => register,
            found => panic!("{bytes:?}: {found:?}"),
        }
    }
}
