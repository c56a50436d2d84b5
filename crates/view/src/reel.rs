// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames of an input, for a page that asks for one after the other. A clip waits for the page:
//! a frame is read when it is asked for, and none is lost. A camera does not wait: the page gets
//! the newest frame.

use std::path::Path;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use foveate_camera::CameraConfig;
use foveate_footage::{FootageError, InputOptions, Source, is_camera, is_read_once, open};
use foveate_frame::{Plane, Raster};
use serde_json::json;

/// The status of the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Status {
    Running,
    /// All frames were shown.
    Ended,
    /// The input cannot be read any further.
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
    /// The number of the frame, which goes on when a clip begins again.
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
    /// The largest number that was asked for.
    wanted: u64,
    /// True if the page wants the input to begin again.
    begins_again: bool,
    is_over: bool,
    news: Vec<String>,
}

impl State {
    fn new(text: String) -> Self {
        Self {
            status: Status::Running,
            text,
            newest: None,
            next: 0,
            wanted: 0,
            begins_again: false,
            is_over: false,
            news: Vec::new(),
        }
    }
}

/// The way in which frames come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Frames come when they are asked for, and the input can be read again.
    Clip,
    /// Frames come when they are asked for, and the input can be read only once.
    Once,
    /// Frames come at times of their own.
    Camera,
}

impl Kind {
    fn of(inputs: &[String]) -> Self {
        let any = |test: fn(&Path) -> bool| inputs.iter().any(|input| test(Path::new(input)));
        match (any(is_camera), any(is_read_once)) {
            (true, _) => Self::Camera,
            (false, true) => Self::Once,
            (false, false) => Self::Clip,
        }
    }
}

/// An input, and its state.
#[derive(Debug)]
pub(crate) struct Reel {
    inputs: Vec<String>,
    options: InputOptions,
    kind: Kind,
    /// The name of the input, without passwords.
    name: String,
    state: Mutex<State>,
    changed: Condvar,
}

/// Returns a configuration by which frames are read as bytes. The page converts them to the depth
/// of its camera.
fn bytes() -> CameraConfig {
    let mut config = CameraConfig::default();
    config.frame.pixel_bits = 8;
    config
}

impl Reel {
    /// Opens the input, so that an unreadable one is reported at once.
    pub(crate) fn open(
        inputs: Vec<String>,
        options: InputOptions,
    ) -> Result<(Self, Box<dyn Source>), FootageError> {
        let source = open(&inputs, &bytes(), &options)?;
        let name = format!("`{}`", source.inputs().join(", "));
        let state = State::new(name.clone());
        let reel = Self {
            kind: Kind::of(&inputs),
            name,
            inputs,
            options,
            state: Mutex::new(state),
            changed: Condvar::new(),
        };
        Ok((reel, source))
    }

    /// Reads frames until the player ends.
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
        }
    }

    /// Reads the frames of a source until it ends, must begin again, or the player ends. Returns
    /// the reason if the source has ended too early.
    fn play(&self, source: &mut dyn Source) -> Result<Option<String>, FootageError> {
        loop {
            let mut state = self.lock();
            // A frame is read when it is asked for.
            while self.is_early(&state) && !Self::is_stopped(&state) {
                state = self.wait(state);
            }
            if Self::is_stopped(&state) {
                return Ok(None);
            }
            drop(state);
            let Some(read) = source.next_frame()? else { return Ok(source.problem()) };
            let mut state = self.lock();
            if Self::is_stopped(&state) {
                return Ok(None);
            }
            let shot = Shot { number: state.next, time_us: read.time_us, frame: read.frame };
            state.newest = Some(shot);
            state.next += 1;
            self.changed.notify_all();
        }
    }

    /// Returns true if the next frame has not been asked for and can wait.
    fn is_early(&self, state: &State) -> bool {
        match self.kind {
            Kind::Clip | Kind::Once => state.next > state.wanted,
            Kind::Camera => false,
        }
    }

    fn is_stopped(state: &State) -> bool {
        state.is_over || state.begins_again
    }

    /// Returns the frame after frame `after`, or no frame if none comes within `patience`: the
    /// length of a JSON text in bytes as a 32-bit number, the text, and a byte per pixel.
    pub(crate) fn frame(&self, after: Option<u64>, patience: Duration) -> Vec<u8> {
        let until = Instant::now() + patience;
        let first = after.map_or(0, |after| after.saturating_add(1));
        let mut state = self.lock();
        // At most the next frame is asked for, whatever number a page gives.
        state.wanted = state.wanted.max(first.min(state.next));
        self.changed.notify_all();
        let is_new = |state: &State| state.newest.as_ref().is_some_and(|shot| shot.number >= first);
        while !is_new(&state) && state.status == Status::Running && !state.is_over {
            let Some(left) = until.checked_duration_since(Instant::now()) else { break };
            let waited = self.changed.wait_timeout(state, left);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        let shot = state.newest.as_ref().filter(|_| is_new(&state));
        // An existing frame is shown before the end of the clip is reported.
        let status = if shot.is_some() { Status::Running } else { state.status };
        let text = json!({
            "status": status.name(),
            "text": state.text,
            "live": self.kind == Kind::Camera,
            "number": shot.map(|shot| shot.number),
            "t_us": shot.map(|shot| shot.time_us),
            "width": shot.map(|shot| shot.frame.width()),
            "height": shot.map(|shot| shot.frame.height()),
        });
        let text = text.to_string();
        let length = u32::try_from(text.len()).unwrap_or(u32::MAX);
        let pixels = match shot.map(|shot| shot.frame.plane()) {
            Some(Plane::Bytes(pixels)) => pixels,
            // The source reads frames as bytes.
            Some(Plane::Words(_)) | None => &[],
        };
        [&length.to_le_bytes(), text.as_bytes(), pixels].concat()
    }

    /// Begins again, if the input can be read again. A running camera goes on; a camera that has
    /// broken off is opened again.
    pub(crate) fn restart(&self) -> Result<(), String> {
        let mut state = self.lock();
        match (self.kind, state.status) {
            (Kind::Once, _) => {
                return Err("standard input comes once; start `foveate live` again".to_owned());
            }
            (Kind::Camera, Status::Running) => return Ok(()),
            (Kind::Camera, Status::Ended | Status::Failed) | (Kind::Clip, _) => {}
        }
        state.begins_again = true;
        (state.status, state.text) = (Status::Running, self.name.clone());
        state.newest = None;
        state.wanted = state.next;
        self.changed.notify_all();
        Ok(())
    }

    /// Ends all waits of the reader and of browsers.
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    /// Returns the head of an answer.
    fn head(answer: &[u8]) -> serde_json::Value {
        let (length, rest) = answer.split_first_chunk().unwrap();
        serde_json::from_slice(&rest[..u32::from_le_bytes(*length) as usize]).unwrap()
    }

    #[test]
    fn a_camera_that_has_broken_off_is_opened_again_and_one_that_sends_goes_on() {
        let options = InputOptions { frames: Some(3), ..InputOptions::default() };
        let (mut reel, source) = Reel::open(vec!["scene:street".to_owned()], options).unwrap();
        // The scene behaves as a camera, which does not wait.
        reel.kind = Kind::Camera;
        reel.restart().unwrap();
        assert!(!reel.lock().begins_again);
        // The status changes at once, before the reader has noticed the request.
        for status in [Status::Ended, Status::Failed] {
            *reel.lock() = State { status, begins_again: false, ..State::new(String::new()) };
            reel.restart().unwrap();
            let state = reel.lock();
            assert!(state.begins_again && state.status == Status::Running);
        }
        let reel = Arc::new(reel);
        let reading = {
            let reel = Arc::clone(&reel);
            std::thread::spawn(move || reel.run(source))
        };
        let long = Duration::from_secs(60);
        for run in 1..=2 {
            // The first two frames are never asked for.
            let last = head(&reel.frame(Some(3 * run - 2), long));
            assert_eq!((&last["number"], &last["live"]), (&(3 * run - 1).into(), &true.into()));
            assert_eq!(head(&reel.frame(Some(3 * run - 1), long))["status"], "ended");
            reel.restart().unwrap();
        }
        reel.end();
        reading.join().unwrap();
        assert!(reel.news().is_empty());
    }
}
