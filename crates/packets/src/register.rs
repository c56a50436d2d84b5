// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registers of a core on a serial line: commands to it, and its answers. Both are REGISTER packets.

use crate::write;

/// What a REGISTER says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Register {
    /// Address in bytes.
    pub address: u16,
    /// Whether it is or was written, not read.
    pub written: bool,
    /// What is or was written, or was read; 0 in a command to read.
    pub value: u32,
}

/// Asks a board to read or write a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Command(Register);

impl Command {
    /// Reads a register.
    #[must_use]
    pub fn read(address: u16) -> Self {
        Self(Register { address, written: false, value: 0 })
    }

    /// Writes a register.
    #[must_use]
    pub fn write(address: u16, value: u32) -> Self {
        Self(Register { address, written: true, value })
    }

    /// What is sent over the line.
    #[must_use]
    pub fn bytes(self) -> Vec<u8> {
        let mut bytes = Vec::new();
        write::register(&mut bytes, self.0);
        bytes
    }

    /// Whether this answers it.
    #[must_use]
    pub fn is_answered_by(self, answer: Register) -> bool {
        let Self(asked) = self;
        answer
            == Register { value: if asked.written { asked.value } else { answer.value }, ..asked }
    }
}
