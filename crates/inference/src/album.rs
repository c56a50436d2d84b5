// SPDX-License-Identifier: MIT OR Apache-2.0
//! All frames of a run in memory, because tuning sees the first half many times.

use crate::InferenceError;
use crate::camera::{Kept, Seen};
use foveate_footage::Kind;

/// Bytes of pictures that are kept.
const MAX_BYTES: usize = 4 << 30;

#[derive(Debug, Default)]
pub(crate) struct Album {
    frames: Vec<Kept>,
    bytes: usize,
}

impl Album {
    pub(crate) fn keep(&mut self, seen: Seen<'_>) -> Result<(), InferenceError> {
        self.bytes += size_of_val(seen.values);
        if self.bytes > MAX_BYTES {
            return Err(InferenceError::TooLong { frames: self.frames.len() });
        }
        self.frames.push(Kept::of(seen));
        Ok(())
    }

    pub(crate) fn len(&self) -> u64 {
        self.frames.len() as u64
    }

    /// Both halves, each with at least one frame that counts.
    pub(crate) fn halves(&self, kind: Kind) -> Result<(&[Kept], &[Kept]), InferenceError> {
        // The first frame of each half of a clip does not count.
        let least = if kind == Kind::Set { 2 } else { 4 };
        if self.frames.len() < least {
            return Err(InferenceError::TooShort { frames: self.frames.len(), least });
        }
        Ok(self.frames.split_at(self.frames.len() / 2))
    }
}
