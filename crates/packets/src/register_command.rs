// SPDX-License-Identifier: MIT OR Apache-2.0
//! Commands to a core on a serial line. A command is a REGISTER packet, and so is its answer.

use crate::{RegisterPacket, packet_encoding};

/// A command to a board to read or write a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RegisterCommand(RegisterPacket);

impl RegisterCommand {
    /// Makes a command that reads a register.
    #[must_use]
    pub fn read(address: u16) -> Self {
        Self(RegisterPacket { address, is_write: false, value: 0 })
    }

    /// Makes a command that writes a register.
    #[must_use]
    pub fn write(address: u16, value: u32) -> Self {
        Self(RegisterPacket { address, is_write: true, value })
    }

    /// Returns the bytes that are sent over the line.
    #[must_use]
    pub fn bytes(self) -> Vec<u8> {
        let mut bytes = Vec::new();
        packet_encoding::append_register(&mut bytes, self.0);
        bytes
    }

    /// Returns whether `answer` answers this command.
    #[must_use]
    pub fn is_answered_by(self, answer: RegisterPacket) -> bool {
        let Self(command) = self;
        answer
            == RegisterPacket {
                value: if command.is_write { command.value } else { answer.value },
                ..command
            }
    }
}
