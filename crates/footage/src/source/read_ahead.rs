// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reading of frames on a separate thread, a few ahead of the work on them. Reading and work
//! run in parallel, and memory is bounded. Buffers return to the source and are used again.

use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread;

use super::{FrameOrigin, FrameSource, SourceFrame};
use crate::FootageError;

/// The number of frames that wait. Besides them, one is being read and one is being worked on.
const FRAMES_AHEAD: usize = 3;

/// A frame and its origin.
type ReadAheadItem = Result<(SourceFrame, Option<FrameOrigin>), FootageError>;

/// The frames of a source that is read ahead.
pub struct ReadAheadFrames {
    frames: Receiver<ReadAheadItem>,
    used: Sender<SourceFrame>,
}

impl ReadAheadFrames {
    /// Returns the next frame and its origin, as [`FrameSource::origin`] gives it, or `None` after
    /// the last frame.
    ///
    /// # Errors
    /// Fails if the source cannot be read further.
    pub fn next(&self) -> Result<Option<(SourceFrame, Option<FrameOrigin>)>, FootageError> {
        self.frames.recv().ok().transpose()
    }

    /// Gives the memory of a frame back to the source.
    pub fn recycle(&self, frame: SourceFrame) {
        // A source that has ended needs no memory.
        let _ = self.used.send(frame);
    }
}

/// Runs `work` on the frames of a source. Once it returns, no more frames are read.
///
/// # Errors
/// The errors are those of `work`, and a thread that the system cannot start.
pub fn read_ahead<T, E: From<FootageError>>(
    source: &mut dyn FrameSource,
    work: impl FnOnce(ReadAheadFrames) -> Result<T, E>,
) -> Result<T, E> {
    let (sender, frames) = sync_channel(FRAMES_AHEAD);
    let (used, returned) = channel();
    thread::scope(|scope| {
        let reader = thread::Builder::new().name("reader".to_owned());
        let reader = reader.spawn_scoped(scope, move || read(source, &sender, &returned));
        reader.map_err(|error| FootageError::Thread { reason: error.to_string() })?;
        work(ReadAheadFrames { frames, used })
    })
}

fn read(
    source: &mut dyn FrameSource,
    sender: &SyncSender<ReadAheadItem>,
    returned: &Receiver<SourceFrame>,
) {
    while let Some(next) = source.next_frame().transpose() {
        let last = next.is_err();
        let next = next.map(|frame| (frame, source.origin()));
        // After the work is done, nothing receives frames any more.
        if sender.send(next).is_err() || last {
            return;
        }
        returned.try_iter().for_each(|frame| source.recycle(frame));
    }
}
