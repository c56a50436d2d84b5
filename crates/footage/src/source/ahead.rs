// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames read on a thread of their own, a few ahead of whoever works on them: reading and working
//! go on side by side, and memory stays as it is. Buffers go back to the source and are used again.

use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread;

use super::{Origin, Source, SourceFrame};
use crate::FootageError;

/// Frames that wait; beside them one is read and one is worked on.
const AHEAD: usize = 3;

/// A frame, and where it was in its input.
type Read = Result<(SourceFrame, Option<Origin>), FootageError>;

/// The frames of a source that is read ahead.
pub struct Frames {
    frames: Receiver<Read>,
    used: Sender<SourceFrame>,
}

impl Frames {
    /// The next frame and where it was in its input, as of [`Source::origin`], or `None` after the last.
    ///
    /// # Errors
    /// When the source cannot be read further.
    pub fn next(&self) -> Result<Option<(SourceFrame, Option<Origin>)>, FootageError> {
        self.frames.recv().ok().transpose()
    }

    /// Gives the memory of a frame back.
    pub fn give_back(&self, frame: SourceFrame) {
        // A source that has ended needs none.
        let _ = self.used.send(frame);
    }
}

/// Does `work` on the frames of a source. Once it returns, no more are read.
///
/// # Errors
/// Those of `work`, and when the system gives no thread.
pub fn read_ahead<T, E: From<FootageError>>(
    source: &mut dyn Source,
    work: impl FnOnce(Frames) -> Result<T, E>,
) -> Result<T, E> {
    let (sender, frames) = sync_channel(AHEAD);
    let (used, returned) = channel();
    thread::scope(|scope| {
        let reader = thread::Builder::new().name("reader".to_owned());
        let reader = reader.spawn_scoped(scope, move || read(source, &sender, &returned));
        reader.map_err(|error| FootageError::Thread { reason: error.to_string() })?;
        work(Frames { frames, used })
    })
}

fn read(source: &mut dyn Source, sender: &SyncSender<Read>, returned: &Receiver<SourceFrame>) {
    while let Some(next) = source.next_frame().transpose() {
        let last = next.is_err();
        let next = next.map(|frame| (frame, source.origin()));
        // Nobody listens any more once the work is done.
        if sender.send(next).is_err() || last {
            return;
        }
        returned.try_iter().for_each(|frame| source.give_back(frame));
    }
}
