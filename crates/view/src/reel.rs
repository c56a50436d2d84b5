// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames of an input, for a page that asks for one after the other. A clip waits for the page: it reads a frame when
//! that is asked for, and none is lost. A camera does not wait: the page gets the newest.

use std::path::Path;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use foveate_camera::CameraConfig;
use foveate_footage::{FootageError, InputOptions, Source, is_camera, is_read_once, open};
use foveate_frame::{Plane, Raster};
use serde_json::json;

/// What becomes of the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Status {
    Running,
    /// All its frames were shown.
    Ended,
    /// It cannot be read further.
    Failed,
}

impl Status {
    fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Ended => "ended",
            Self::Failed => "failed",
        }
    }
}

/// A frame for the page.
#[derive(Clone, Debug)]
struct Shot {
    /// Counts on where a clip begins again.
    number: u64,
    time_us: u64,
    frame: Raster,
}

#[derive(Debug)]
struct State {
    status: Status,
    text: String,
    newest: Option<Shot>,
    /// The number of the next frame.
    next: u64,
    /// Frames before this number were asked for.
    wanted: u64,
    /// The page wants to begin again.
    begins_again: bool,
    is_over: bool,
    news: Vec<String>,
}

/// An input, and how far it was read.
#[derive(Debug)]
pub(crate) struct Reel {
    inputs: Vec<String>,
    options: InputOptions,
    is_camera: bool,
    is_read_once: bool,
    state: Mutex<State>,
    changed: Condvar,
}

/// Frames are given as bytes; the page brings them to the depth of its camera.
fn bytes() -> CameraConfig {
    let mut config = CameraConfig::default();
    config.frame.pixel_bits = 8;
    config
}

impl Reel {
    /// Opens the input, so that what cannot be read is known at once.
    pub(crate) fn open(
        inputs: Vec<String>,
        options: InputOptions,
    ) -> Result<(Self, Box<dyn Source>), FootageError> {
        let source = open(&inputs, &bytes(), &options)?;
        let once = |test: fn(&Path) -> bool| inputs.iter().any(|input| test(Path::new(input)));
        let text = format!("`{}`", source.inputs().join(", "));
        let state = State {
            status: Status::Running,
            text,
            newest: None,
            next: 0,
            wanted: 0,
            begins_again: false,
            is_over: false,
            news: Vec::new(),
        };
        let reel = Self {
            is_camera: once(is_camera),
            is_read_once: once(is_read_once),
            inputs,
            options,
            state: Mutex::new(state),
            changed: Condvar::new(),
        };
        Ok((reel, source))
    }

    /// Reads until all is over.
    pub(crate) fn run(&self, source: Box<dyn Source>) {
        let mut source = Some(source);
        loop {
            let opened = match source.take() {
                Some(source) => Ok(source),
                None => open(&self.inputs, &bytes(), &self.options),
            };
            let (status, problem) = match opened.and_then(|mut source| self.play(&mut *source)) {
                Ok(problem) => (Status::Ended, problem),
                Err(error) => (Status::Failed, Some(error.to_string())),
            };
            let mut state = self.lock();
            if !state.begins_again {
                state.news.extend(problem.clone());
                state.text = problem.unwrap_or_else(|| "the clip has ended".to_owned());
                state.status = status;
                self.changed.notify_all();
            }
            while !state.begins_again && !state.is_over {
                state = self.wait(state);
            }
            if state.is_over {
                return;
            }
            state.begins_again = false;
            state.status = Status::Running;
            state.text = format!("`{}`", self.inputs.join(", "));
        }
    }

    /// Shows the frames of a source until it ends, is to begin again, or nobody looks any more; says why it ended too
    /// early, if it did.
    fn play(&self, source: &mut dyn Source) -> Result<Option<String>, FootageError> {
        loop {
            let mut state = self.lock();
            // A frame is read when it is asked for.
            while !self.is_camera && state.next > state.wanted && !self.is_stopped(&state) {
                state = self.wait(state);
            }
            if self.is_stopped(&state) {
                return Ok(None);
            }
            drop(state);
            let Some(read) = source.next_frame()? else { return Ok(source.problem()) };
            let mut state = self.lock();
            if self.is_stopped(&state) {
                return Ok(None);
            }
            let shot = Shot { number: state.next, time_us: read.time_us, frame: read.frame };
            state.newest = Some(shot);
            state.next += 1;
            self.changed.notify_all();
        }
    }

    fn is_stopped(&self, state: &State) -> bool {
        state.is_over || state.begins_again
    }

    /// The frame after frame `after`, or none within `patience`: the bytes of a JSON text as a number of 32 bits, the text,
    /// and a byte per pixel.
    pub(crate) fn frame(&self, after: Option<u64>, patience: Duration) -> Vec<u8> {
        let until = Instant::now() + patience;
        let first = after.map_or(0, |after| after.saturating_add(1));
        let mut state = self.lock();
        state.wanted = state.wanted.max(first);
        self.changed.notify_all();
        let is_new = |state: &State| state.newest.as_ref().is_some_and(|shot| shot.number >= first);
        while !is_new(&state) && state.status == Status::Running && !state.is_over {
            let Some(left) = until.checked_duration_since(Instant::now()) else { break };
            let waited = self.changed.wait_timeout(state, left);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        let shot = state.newest.as_ref().filter(|_| is_new(&state));
        // A frame that is there is shown before it is said that it was the last.
        let status = if shot.is_some() { Status::Running } else { state.status };
        let text = json!({
            "status": status.name(),
            "text": state.text,
            "live": self.is_camera,
            "number": shot.map(|shot| shot.number),
            "t_us": shot.map(|shot| shot.time_us),
            "width": shot.map(|shot| shot.frame.width()),
            "height": shot.map(|shot| shot.frame.height()),
        });
        let text = text.to_string();
        let length = u32::try_from(text.len()).unwrap_or(u32::MAX);
        let pixels = match shot.map(|shot| shot.frame.plane()) {
            Some(Plane::Bytes(pixels)) => pixels,
            // The source was asked for bytes.
            Some(Plane::Words(_)) | None => &[],
        };
        [&length.to_le_bytes(), text.as_bytes(), pixels].concat()
    }

    /// Begins again, if the input can be read a second time.
    pub(crate) fn restart(&self) -> Result<(), String> {
        if self.is_camera {
            return Ok(());
        }
        if self.is_read_once {
            return Err("standard input comes once; start `foveate live` again".to_owned());
        }
        let mut state = self.lock();
        state.begins_again = true;
        state.newest = None;
        state.wanted = state.next;
        self.changed.notify_all();
        Ok(())
    }

    /// Everything ends.
    pub(crate) fn end(&self) {
        self.lock().is_over = true;
        self.changed.notify_all();
    }

    pub(crate) fn frames(&self) -> u64 {
        self.lock().next
    }

    pub(crate) fn news(&self) -> Vec<String> {
        std::mem::take(&mut self.lock().news)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, state: MutexGuard<'a, State>) -> MutexGuard<'a, State> {
        self.changed.wait(state).unwrap_or_else(PoisonError::into_inner)
    }
}
