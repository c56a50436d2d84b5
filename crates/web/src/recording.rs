// SPDX-License-Identifier: MIT OR Apache-2.0
//! The events of a camera as `foveate simulate` writes them to `events.csv`, kept until they are
//! fetched.

use foveate_engine::{EventTable, Moment};
use serde::Serialize;

/// A recording of frames.
#[derive(Debug)]
pub(crate) struct Recording {
    table: EventTable,
    csv: Vec<u8>,
    recorded: Recorded,
}

/// The state of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Recorded {
    /// The number of frames in it.
    pub frames: u64,
    /// The length of its text in bytes.
    pub bytes: usize,
    /// True if a frame found no room. Neither this frame nor any later one is in the recording.
    pub full: bool,
}

impl Recording {
    pub(crate) fn new(table: EventTable) -> Self {
        let mut csv = table.heading().into_bytes();
        csv.push(b'\n');
        let recorded = Recorded { frames: 0, bytes: csv.len(), full: false };
        Self { table, csv, recorded }
    }

    /// Returns an empty recording with the same table.
    pub(crate) fn anew(&self) -> Self {
        Self::new(self.table.clone())
    }

    /// Adds a frame. If the text would be longer than `most` bytes, nothing of the frame is added.
    pub(crate) fn push(&mut self, moment: &Moment<'_>, most: usize) {
        if self.recorded.full {
            return;
        }
        self.table.csv(moment, &mut self.csv);
        if self.csv.len() > most {
            self.csv.truncate(self.recorded.bytes);
            self.recorded.full = true;
        } else {
            let frames = self.recorded.frames + 1;
            self.recorded = Recorded { frames, bytes: self.csv.len(), full: false };
        }
    }

    pub(crate) fn recorded(&self) -> Recorded {
        self.recorded
    }

    pub(crate) fn csv(&self) -> &[u8] {
        &self.csv
    }
}
