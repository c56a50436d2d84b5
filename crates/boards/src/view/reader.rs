// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thread that reads the stream to its end, and shows each frame at its time.

use std::io::{ErrorKind, Read};
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::thread::sleep;
use std::time::{Duration, Instant};

use foveate_design::DesignConfig;
use foveate_simulator::{PacketStream, RegisterPacket, ShownFrame, StreamItem};

use crate::view::PlayMode;
use crate::view::board::BoardRegisters;
use crate::view::input::{Input, OpenInput};
use crate::view::shared_stream::{SharedStream, StreamStatus};

/// The number of bytes that are read at once.
const CHUNK_BYTES: usize = 1 << 16;
/// The time between two attempts to open a port that is gone.
const REOPEN_INTERVAL: Duration = Duration::from_secs(1);
/// The longest pause between two frames that are shown at their times. A longer pause is cut to
/// this.
const LONGEST_PAUSE: Duration = Duration::from_secs(10);
/// The wait from which on the page says when the next frame is due.
const REPORTED_WAIT: Duration = Duration::from_secs(2);
/// The longest wait before the end of the view is checked again.
const LONGEST_SLEEP: Duration = Duration::from_millis(50);

/// The state of the thread that reads a stream.
pub(crate) struct StreamReader {
    pub(crate) input: Input,
    pub(crate) config: DesignConfig,
    pub(crate) play: PlayMode,
    pub(crate) answers: SyncSender<RegisterPacket>,
    pub(crate) board: Arc<BoardRegisters>,
    pub(crate) live: Arc<SharedStream>,
}

impl StreamReader {
    /// Reads until the view ends. If a port is gone, it waits until the port comes back. `first` is
    /// a source that is open already.
    pub(crate) fn run(self, mut first: Option<OpenInput>) {
        let name = self.input.name();
        while !self.live.is_over() {
            let source = match first.take().map_or_else(|| self.input.open(), Ok) {
                Ok(source) => source,
                // The end of the port was reported already.
                Err(_) if self.input.is_port() => {
                    sleep(REOPEN_INTERVAL);
                    continue;
                }
                Err(error) => return self.live.set_status(StreamStatus::Ended, error.to_string()),
            };
            if self.live.frames_shown() == 0 || self.input.is_port() {
                let text = format!("`{name}` is open; no frame has come yet");
                self.live.set_status(StreamStatus::Waiting, text);
            }
            if source.port.is_some() {
                self.board.set_port(source.port);
            }
            let problem = self.read(source.reader);
            self.board.set_port(None);
            match (problem, self.input.is_port(), self.play) {
                (problem, true, _) => {
                    let why = problem.map_or_else(|| "unplugged".to_owned(), |why| why.to_string());
                    let text = format!("`{name}` is gone ({why}); waiting for it to come back");
                    self.live.set_status(StreamStatus::Gone, text);
                    sleep(REOPEN_INTERVAL);
                }
                (None, false, PlayMode::Looped) if self.live.frames_shown() > 0 => {}
                (None, false, _) => {
                    let frames = self.live.frames_shown();
                    let text = format!("the stream has ended; frames shown: {frames}");
                    return self.live.set_status(StreamStatus::Ended, text);
                }
                (Some(why), false, _) => {
                    let text = format!("cannot read `{name}` any further: {why}");
                    return self.live.set_status(StreamStatus::Ended, text);
                }
            }
        }
    }

    /// Reads to the end of the stream. Returns the error that ended it, if there was one.
    fn read(&self, mut reader: Box<dyn Read + Send>) -> Option<std::io::Error> {
        let mut stream = PacketStream::new(&self.config);
        let (mut chunk, mut clock) = (vec![0; CHUNK_BYTES], PlaybackClock::default());
        loop {
            let read = match reader.read(&mut chunk) {
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                read => read,
            };
            match &read {
                Ok(bytes @ 1..) => stream.feed(&chunk[..*bytes]),
                Ok(0) | Err(_) => stream.complete(),
            }
            self.live.note_bytes();
            self.take_packets(&mut stream, &mut clock);
            match read {
                Ok(0) => return None,
                Ok(_) if self.live.is_over() => return None,
                Ok(_) => {}
                Err(error) => return Some(error),
            }
        }
    }

    /// Takes all packets that are complete. A few bytes may make many frames, so the end of the
    /// view is checked between two of them.
    fn take_packets(&self, stream: &mut PacketStream, clock: &mut PlaybackClock) {
        while !self.live.is_over() {
            match stream.receive() {
                Ok(None) => return,
                Ok(Some(StreamItem::Loss(loss))) => self.live.note_loss(&loss),
                // The channel is full or closed if the board is not asked, or if it answers more
                // than it was asked for.
                Ok(Some(StreamItem::Register(answer))) => {
                    let _ = self.answers.try_send(answer);
                }
                Ok(Some(StreamItem::Frame(frame))) => {
                    if self.play != PlayMode::AtOnce {
                        clock.wait_for_frame(&frame, &self.live);
                    }
                    let bytes = stream.position() - clock.position;
                    clock.position = stream.position();
                    if self.live.is_over() {
                        return;
                    }
                    if let Some(design) = stream.design() {
                        self.live.set_frame(&frame, design, bytes);
                    }
                }
                Err(error) => self.live.note_refusal(error.to_string()),
            }
        }
    }
}

/// The times of a stream that is shown at the times of its frames.
#[derive(Default)]
struct PlaybackClock {
    /// The moment at which the first frame was shown, and the frame's own time.
    start: Option<(Instant, u64)>,
    last_us: u64,
    /// The sum of the parts of pauses that were cut.
    cut_time: Duration,
    /// The position in the stream, in bytes, behind the last frame.
    position: u64,
}

impl PlaybackClock {
    /// Waits until the time of a frame has come, but no longer than [`LONGEST_PAUSE`] after the
    /// frame before.
    fn wait_for_frame(&mut self, frame: &ShownFrame, live: &SharedStream) {
        let Some(time_us) = frame.time_us else { return };
        let (start, start_us) = *self.start.get_or_insert((Instant::now(), time_us));
        let gap = Duration::from_micros(time_us.saturating_sub(self.last_us.max(start_us)));
        self.last_us = time_us;
        if let Some(excess) = gap.checked_sub(LONGEST_PAUSE).filter(|excess| !excess.is_zero()) {
            if self.cut_time.is_zero() {
                live.add_message(format!(
                    "frame {} comes {} s after the frame before; pauses of more than {} s are cut to that",
                    frame.number,
                    gap.as_secs(),
                    LONGEST_PAUSE.as_secs()
                ));
            }
            self.cut_time = self.cut_time.saturating_add(excess);
        }
        let due =
            Duration::from_micros(time_us.saturating_sub(start_us)).saturating_sub(self.cut_time);
        let left = || due.saturating_sub(start.elapsed());
        if left() > REPORTED_WAIT {
            live.note_wait(frame.number, left());
        }
        while !left().is_zero() && !live.is_over() {
            sleep(left().min(LONGEST_SLEEP));
        }
    }
}
