// SPDX-License-Identifier: MIT OR Apache-2.0
//! Commands to a core on a serial line, which are REGISTER packets as its answers are.

use crate::{Register, write};

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
