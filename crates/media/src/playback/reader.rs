// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reading of a source on a separate thread, a few frames ahead of the work on them. Reading
//! and work run in parallel, and memory is bounded. Buffers return to the source and are used
//! again.

use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::{Builder, JoinHandle};

use crate::{FootageError, FrameOrigin, FrameSource, SourceFrame};
use foveate_tools::Interrupt;

/// The number of frames that wait. Besides them, one is being read and one is being worked on.
const FRAMES_AHEAD: usize = 3;

pub(crate) enum ReaderMessage {
    /// The next frame, and its origin.
    Frame(SourceFrame, Option<FrameOrigin>),
    /// The end of the frames, with the problem because of which they ended too early.
    End(Option<String>),
    /// A frame that cannot be read, after which there is none.
    Failed(FootageError),
}

/// The thread that reads a source. The drop of this value ends it.
pub(crate) struct FrameReader {
    /// The messages; `None` only while it is dropped.
    messages: Option<Receiver<ReaderMessage>>,
    /// The way back for the memory of frames.
    pub(crate) used: Sender<SourceFrame>,
    /// The interrupt that ends a wait of this source alone.
    interrupt: Interrupt,
    thread: Option<JoinHandle<()>>,
}

impl FrameReader {
    /// Starts to read at most `limit` frames. `interrupt` is the one that the source was opened
    /// with.
    pub(crate) fn start(
        mut source: Box<dyn FrameSource>,
        limit: u64,
        interrupt: Interrupt,
    ) -> Result<Self, FootageError> {
        let (sender, messages) = sync_channel(FRAMES_AHEAD);
        let (used, returned) = channel();
        let read = move || read_frames(source.as_mut(), limit, &sender, &returned);
        let thread = Builder::new().name("reader".to_owned()).spawn(read);
        let thread = thread.map_err(|error| FootageError::Thread { reason: error.to_string() })?;
        Ok(Self { messages: Some(messages), used, interrupt, thread: Some(thread) })
    }

    /// Waits for the next message. No message follows an end or a failure.
    pub(crate) fn receive(&mut self) -> ReaderMessage {
        if let Some(Ok(message)) = self.messages.as_ref().map(Receiver::recv) {
            return message;
        }
        // Only a panic ends the thread without a last message.
        match self.thread.take().map(JoinHandle::join) {
            Some(Err(panic)) => resume_unwind(panic),
            Some(Ok(())) | None => ReaderMessage::End(None),
        }
    }
}

impl Drop for FrameReader {
    fn drop(&mut self) {
        // The thread may wait for its input, or for room among the messages.
        self.interrupt.stop_part();
        drop(self.messages.take());
        // It is waited for, because it ends ffmpeg.
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn read_frames(
    source: &mut dyn FrameSource,
    limit: u64,
    messages: &SyncSender<ReaderMessage>,
    returned: &Receiver<SourceFrame>,
) {
    for _ in 0..limit {
        let (message, is_last) = match source.next_frame() {
            Ok(Some(frame)) => (ReaderMessage::Frame(frame, source.origin()), false),
            Ok(None) => (ReaderMessage::End(source.problem()), true),
            Err(error) => (ReaderMessage::Failed(error), true),
        };
        // After the work is done, nothing receives frames any more.
        if messages.send(message).is_err() || is_last {
            return;
        }
        returned.try_iter().for_each(|frame| source.recycle(frame));
    }
    let _ = messages.send(ReaderMessage::End(None));
}
