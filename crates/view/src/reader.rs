// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thread that reads the stream to its end, and shows each frame at its time.

use std::io::{ErrorKind, Read};
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::thread::sleep;
use std::time::{Duration, Instant};

use foveate_design::Config;
use foveate_simulator::{Received, Register, ShownFrame, Stream};

use crate::Play;
use crate::board::Board;
use crate::input::{Input, Source};
use crate::live::{Live, Status};

/// The number of bytes that are read at once.
const CHUNK: usize = 1 << 16;
/// The time between two attempts to open a port that is gone.
const AGAIN: Duration = Duration::from_secs(1);
/// The longest pause between two frames that are shown at their times. A longer pause is cut to
/// this.
const PAUSE: Duration = Duration::from_secs(10);
/// The wait from which on the page says when the next frame is due.
const LONG: Duration = Duration::from_secs(2);
/// The longest wait before the end of the view is checked again.
const NAP: Duration = Duration::from_millis(50);

/// The state of the thread that reads a stream.
pub(crate) struct Reader {
    pub(crate) input: Input,
    pub(crate) config: Config,
    pub(crate) play: Play,
    pub(crate) answers: SyncSender<Register>,
    pub(crate) board: Arc<Board>,
    pub(crate) live: Arc<Live>,
}

impl Reader {
    /// Reads until the view ends. If a port is gone, it waits for the port. `first` is a source
    /// that is open already.
    pub(crate) fn run(self, mut first: Option<Source>) {
        let name = self.input.name();
        while !self.live.is_over() {
            let source = match first.take().map_or_else(|| self.input.open(), Ok) {
                Ok(source) => source,
                // It has been reported that the port is gone.
                Err(_) if self.input.is_port() => {
                    sleep(AGAIN);
                    continue;
                }
                Err(error) => return self.live.status(Status::Ended, error.to_string()),
            };
            if self.live.frames() == 0 || self.input.is_port() {
                let text = format!("`{name}` is open; no frame has come yet");
                self.live.status(Status::Waiting, text);
            }
            if source.port.is_some() {
                self.board.attach(source.port);
            }
            let problem = self.read(source.reader);
            self.board.attach(None);
            match (problem, self.input.is_port(), self.play) {
                (problem, true, _) => {
                    let why = problem.map_or_else(|| "unplugged".to_owned(), |why| why.to_string());
                    let text = format!("`{name}` is gone ({why}); waiting for it to come back");
                    self.live.status(Status::Gone, text);
                    sleep(AGAIN);
                }
                (None, false, Play::Looped) if self.live.frames() > 0 => {}
                (None, false, _) => {
                    let frames = self.live.frames();
                    let text = format!("the stream has ended; frames shown: {frames}");
                    return self.live.status(Status::Ended, text);
                }
                (Some(why), false, _) => {
                    let text = format!("cannot read `{name}` any further: {why}");
                    return self.live.status(Status::Ended, text);
                }
            }
        }
    }

    /// Reads to the end of the stream. Returns the error that ended it, if there was one.
    fn read(&self, mut reader: Box<dyn Read + Send>) -> Option<std::io::Error> {
        let mut stream = Stream::new(&self.config);
        let (mut chunk, mut pace) = (vec![0; CHUNK], Pace::default());
        loop {
            let read = match reader.read(&mut chunk) {
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                read => read,
            };
            match &read {
                Ok(bytes @ 1..) => stream.feed(&chunk[..*bytes]),
                Ok(0) | Err(_) => stream.complete(),
            }
            self.live.heard();
            self.take(&mut stream, &mut pace);
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
    fn take(&self, stream: &mut Stream, pace: &mut Pace) {
        while !self.live.is_over() {
            match stream.receive() {
                Ok(None) => return,
                Ok(Some(Received::Loss(loss))) => self.live.lose(&loss),
                // The channel is full or closed if the board is not asked, or if it answers more
                // than it was asked for.
                Ok(Some(Received::Register(answer))) => {
                    let _ = self.answers.try_send(answer);
                }
                Ok(Some(Received::Frame(frame))) => {
                    if self.play != Play::AtOnce {
                        pace.wait(&frame, &self.live);
                    }
                    let bytes = stream.position() - pace.position;
                    pace.position = stream.position();
                    if self.live.is_over() {
                        return;
                    }
                    if let Some(design) = stream.design() {
                        self.live.show(&frame, design, bytes);
                    }
                }
                Err(error) => self.live.refuse(error.to_string()),
            }
        }
    }
}

/// The times of a stream that is shown at the times of its frames.
#[derive(Default)]
struct Pace {
    /// The moment at which the first frame was shown, and the frame's own time.
    start: Option<(Instant, u64)>,
    last_us: u64,
    /// The sum of the parts of pauses that were cut.
    cut: Duration,
    /// The position in the stream, in bytes, behind the last frame.
    position: u64,
}

impl Pace {
    /// Waits until the time of a frame has come, but no longer than [`PAUSE`] after the frame
    /// before.
    fn wait(&mut self, frame: &ShownFrame, live: &Live) {
        let Some(time_us) = frame.time_us else { return };
        let (start, start_us) = *self.start.get_or_insert((Instant::now(), time_us));
        let gap = Duration::from_micros(time_us.saturating_sub(self.last_us.max(start_us)));
        self.last_us = time_us;
        if let Some(more) = gap.checked_sub(PAUSE).filter(|more| !more.is_zero()) {
            if self.cut.is_zero() {
                live.tell(format!(
                    "frame {} comes {} s after the frame before; pauses of more than {} s are cut to that",
                    frame.number,
                    gap.as_secs(),
                    PAUSE.as_secs()
                ));
            }
            self.cut = self.cut.saturating_add(more);
        }
        let due = Duration::from_micros(time_us.saturating_sub(start_us)).saturating_sub(self.cut);
        let left = || due.saturating_sub(start.elapsed());
        if left() > LONG {
            live.expect(frame.number, left());
        }
        while !left().is_zero() && !live.is_over() {
            sleep(left().min(NAP));
        }
    }
}
