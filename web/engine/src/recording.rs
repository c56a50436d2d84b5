// SPDX-License-Identifier: MIT OR Apache-2.0
//! The events of a camera as `foveate simulate` writes them to `events.csv`, kept until they are
//! fetched.

use foveate_engine::{EventFrame, EventTable};
use serde::Serialize;

/// A recording of frames.
#[derive(Debug)]
pub(crate) struct Recording {
    table: EventTable,
    csv: Vec<u8>,
    state: RecordingState,
}

/// The state of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct RecordingState {
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
        let recorded = RecordingState { frames: 0, bytes: csv.len(), full: false };
        Self { table, csv, state: recorded }
    }

    /// Returns an empty recording with the same table.
    pub(crate) fn emptied(&self) -> Self {
        Self::new(self.table.clone())
    }

    /// Adds a frame. If the text would be longer than `most` bytes, nothing of the frame is added.
    pub(crate) fn push(&mut self, moment: &EventFrame<'_>, most: usize) {
        if self.state.full {
            return;
        }
        self.table.csv(moment, &mut self.csv);
        if self.csv.len() > most {
            self.csv.truncate(self.state.bytes);
            self.state.full = true;
        } else {
            let frames = self.state.frames + 1;
            self.state = RecordingState { frames, bytes: self.csv.len(), full: false };
        }
    }

    pub(crate) fn recording_state(&self) -> RecordingState {
        self.state
    }

    pub(crate) fn csv(&self) -> &[u8] {
        &self.csv
    }
}
