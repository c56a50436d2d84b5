// SPDX-License-Identifier: MIT OR Apache-2.0
//! The events of a camera as `foveate simulate` writes them to `events.csv`, kept until somebody takes them.

use foveate_engine::{EventTable, Moment};
use serde::Serialize;

/// Frames that were recorded.
#[derive(Debug)]
pub(crate) struct Recording {
    table: EventTable,
    csv: Vec<u8>,
    recorded: Recorded,
}

/// How far a recording is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Recorded {
    /// Frames in it.
    pub frames: u64,
    /// Bytes of its text.
    pub bytes: usize,
    /// Whether a frame found no room: neither it nor those after it are in the recording.
    pub full: bool,
}

impl Recording {
    pub(crate) fn new(table: EventTable) -> Self {
        let mut csv = table.heading().into_bytes();
        csv.push(b'\n');
        let recorded = Recorded { frames: 0, bytes: csv.len(), full: false };
        Self { table, csv, recorded }
    }

    /// The same, before the first frame.
    pub(crate) fn anew(&self) -> Self {
        Self::new(self.table.clone())
    }

    /// Adds a frame; where it would be more than `most` bytes, none of it.
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
