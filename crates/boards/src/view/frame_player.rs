// SPDX-License-Identifier: MIT OR Apache-2.0
//! What pages get as bytes: the frames of an input ([`FramePlayer`]), and the frame of a stream
//! ([`frame_bytes`]). A clip waits for the page: a frame is taken when it is asked for, and none is
//! lost. A camera does not wait: the page gets the newest frame.

use foveate_camera::CameraConfig;
use foveate_design::Design;
use foveate_media::{
    ClipPlayer, InputOptions, PlaybackError, PlayedFrame, is_camera, is_read_once,
};
use foveate_pixels::FramePixels;
use foveate_simulator::ShownFrame;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InputStatus {
    Running,
    /// The input has no more frames.
    Ended,
    /// The input cannot be read any further.
    Failed,
}

impl InputStatus {
    fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Ended => "ended",
            Self::Failed => "failed",
        }
    }
}

/// A frame for the page.
#[derive(Debug)]
struct NumberedFrame {
    /// The number of the frame, which goes on when a clip begins again.
    number: u64,
    shown: PlayedFrame,
}

#[derive(Debug)]
struct PlayerState {
    status: InputStatus,
    text: String,
    newest: Option<NumberedFrame>,
    next: u64,
    /// The largest number that was asked for.
    largest_requested: u64,
    /// True if the page wants the input to begin again.
    restart_requested: bool,
    is_over: bool,
    messages: Vec<String>,
    /// The pages that have asked for a frame, the last to begin at the end. Only that one gets
    /// frames, because two pages would take frames from each other.
    viewers: Vec<String>,
}

/// The largest number of viewers that are remembered, and of bytes of the name of one.
const MAX_VIEWERS: usize = 64;

/// The status for a page whose input another page shows.
const TAKEN: &str = "taken";

impl PlayerState {
    fn new(text: String) -> Self {
        Self {
            status: InputStatus::Running,
            text,
            newest: None,
            next: 0,
            largest_requested: 0,
            restart_requested: false,
            is_over: false,
            messages: Vec::new(),
            viewers: Vec::new(),
        }
    }
}

impl PlayerState {
    /// Notes a viewer that asks for the first time. Returns true if no other has begun after it.
    fn is_last_viewer(&mut self, viewer: &str) -> bool {
        let name = viewer.get(..viewer.len().min(MAX_VIEWERS)).unwrap_or_default();
        if !self.viewers.iter().any(|known| known == name) {
            if self.viewers.len() == MAX_VIEWERS {
                self.viewers.remove(0);
            }
            self.viewers.push(name.to_owned());
        }
        self.viewers.last().is_some_and(|last| last == name)
    }
}

/// The way in which an input delivers frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FrameDelivery {
    /// Frames come when they are asked for, and the input can be read again.
    Clip,
    /// Frames come when they are asked for, and the input can be read only once.
    OneTime,
    /// Frames come at times of their own.
    Camera,
}

impl FrameDelivery {
    fn for_inputs(inputs: &[String]) -> Self {
        let any = |test: fn(&Path) -> bool| inputs.iter().any(|input| test(Path::new(input)));
        match (any(is_camera), any(is_read_once)) {
            (true, _) => Self::Camera,
            (false, true) => Self::OneTime,
            (false, false) => Self::Clip,
        }
    }
}

/// An input, and its state.
#[derive(Debug)]
pub(crate) struct FramePlayer {
    inputs: Vec<String>,
    options: InputOptions,
    kind: FrameDelivery,
    /// The name of the input, without passwords.
    name: String,
    state: Mutex<PlayerState>,
    changed: Condvar,
}

/// Returns a configuration by which frames are read as bytes. The page converts them to the depth
/// of its camera.
fn byte_camera() -> CameraConfig {
    let mut config = CameraConfig::default();
    config.frame.pixel_bits = 8;
    config
}

impl FramePlayer {
    /// Opens the input, so that an unreadable one is reported at once.
    pub(crate) fn open(
        inputs: Vec<String>,
        options: InputOptions,
    ) -> Result<(Self, ClipPlayer), PlaybackError> {
        let clip = ClipPlayer::open(&inputs, &byte_camera(), &options)?;
        let name = format!("`{}`", clip.inputs().join(", "));
        let state = PlayerState::new(name.clone());
        let player = Self {
            kind: FrameDelivery::for_inputs(&inputs),
            name,
            inputs,
            options,
            state: Mutex::new(state),
            changed: Condvar::new(),
        };
        Ok((player, clip))
    }

    /// Reads frames until the player ends.
    pub(crate) fn run(&self, clip: ClipPlayer) {
        let mut first = Some(clip);
        loop {
            let opened = match first.take() {
                Some(clip) => Ok(clip),
                None => ClipPlayer::open(&self.inputs, &byte_camera(), &self.options),
            };
            let (status, problem) = match opened.and_then(|clip| self.read_frames(clip)) {
                Ok(problem) => (InputStatus::Ended, problem),
                Err(error) => (InputStatus::Failed, Some(error.to_string())),
            };
            let mut state = self.lock();
            if !state.restart_requested {
                state.messages.extend(problem.clone());
                state.text = problem.unwrap_or_else(|| "the clip has ended".to_owned());
                state.status = status;
                self.changed.notify_all();
            }
            while !state.restart_requested && !state.is_over {
                state = self.wait(state);
            }
            if state.is_over {
                return;
            }
            state.restart_requested = false;
        }
    }

    /// Reads the frames of a clip until it ends, must begin again, or the player ends. Returns the
    /// reason if the clip has ended too early.
    fn read_frames(&self, mut clip: ClipPlayer) -> Result<Option<String>, PlaybackError> {
        loop {
            let mut state = self.lock();
            // A frame is taken when it is asked for.
            while self.must_wait(&state) && !Self::is_stopped(&state) {
                state = self.wait(state);
            }
            if Self::is_stopped(&state) {
                return Ok(None);
            }
            drop(state);
            let Some(shown) = clip.next().transpose()? else {
                return Ok(clip.problem().map(str::to_owned));
            };
            let mut state = self.lock();
            if Self::is_stopped(&state) {
                return Ok(None);
            }
            state.newest = Some(NumberedFrame { number: state.next, shown });
            state.next += 1;
            self.changed.notify_all();
        }
    }

    /// Returns true if the next frame has not been asked for and can wait.
    fn must_wait(&self, state: &PlayerState) -> bool {
        match self.kind {
            FrameDelivery::Clip | FrameDelivery::OneTime => state.next > state.largest_requested,
            FrameDelivery::Camera => false,
        }
    }

    fn is_stopped(state: &PlayerState) -> bool {
        state.is_over || state.restart_requested
    }

    /// Returns the answer for the frame after frame `after`: the length of a JSON text in bytes as
    /// a 32-bit number, the text, and a byte per pixel. The answer has no pixels if no such frame
    /// comes within `time_limit`, or if another page began after `viewer`.
    pub(crate) fn frame_after(
        &self,
        after: Option<u64>,
        viewer: Option<&str>,
        time_limit: Duration,
    ) -> Vec<u8> {
        let until = Instant::now() + time_limit;
        let first = after.map_or(0, |after| after.saturating_add(1));
        let mut state = self.lock();
        if viewer.is_some_and(|viewer| !state.is_last_viewer(viewer)) {
            return self.answer(&state, None, TAKEN);
        }
        // A page may give any number, but cannot ask for more than the next frame.
        state.largest_requested = state.largest_requested.max(first.min(state.next));
        self.changed.notify_all();
        let is_new = |state: &PlayerState| {
            state.newest.as_ref().is_some_and(|newest| newest.number >= first)
        };
        while !is_new(&state) && state.status == InputStatus::Running && !state.is_over {
            let Some(left) = until.checked_duration_since(Instant::now()) else { break };
            let waited = self.changed.wait_timeout(state, left);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        if viewer.is_some_and(|viewer| !state.is_last_viewer(viewer)) {
            return self.answer(&state, None, TAKEN);
        }
        let newest = state.newest.as_ref().filter(|_| is_new(&state));
        // An existing frame is shown before the end of the clip is reported.
        let status = if newest.is_some() { InputStatus::Running } else { state.status };
        self.answer(&state, newest, status.name())
    }

    /// Returns the bytes of an answer, with the pixels of a frame if there is one.
    fn answer(&self, state: &PlayerState, newest: Option<&NumberedFrame>, status: &str) -> Vec<u8> {
        let text = json!({
            "status": status,
            "text": state.text,
            "live": self.kind == FrameDelivery::Camera,
            "number": newest.map(|newest| newest.number),
            "t_us": newest.map(|newest| newest.shown.time_us),
            "width": newest.map(|newest| newest.shown.frame.width()),
            "height": newest.map(|newest| newest.shown.frame.height()),
        })
        .to_string();
        let length = u32::try_from(text.len()).unwrap_or(u32::MAX);
        let pixels = match newest.map(|newest| newest.shown.frame.borrowed_pixels()) {
            Some(FramePixels::Bytes(pixels)) => pixels,
            // The source reads frames as bytes.
            Some(FramePixels::Words(_)) | None => &[],
        };
        [&length.to_le_bytes(), text.as_bytes(), pixels].concat()
    }

    /// Begins again, if the input can be read again. A running camera goes on; a camera that has
    /// broken off is opened again.
    pub(crate) fn restart(&self) -> Result<(), String> {
        let mut state = self.lock();
        match (self.kind, state.status) {
            (FrameDelivery::OneTime, _) => {
                return Err(
                    "standard input can be read only once; start `foveate live` again".to_owned()
                );
            }
            (FrameDelivery::Camera, InputStatus::Running) => return Ok(()),
            (FrameDelivery::Camera, InputStatus::Ended | InputStatus::Failed)
            | (FrameDelivery::Clip, _) => {}
        }
        state.restart_requested = true;
        (state.status, state.text) = (InputStatus::Running, self.name.clone());
        state.newest = None;
        state.largest_requested = state.next;
        self.changed.notify_all();
        Ok(())
    }

    /// Ends all waits of the reader and of browsers.
    pub(crate) fn end(&self) {
        self.lock().is_over = true;
        self.changed.notify_all();
    }

    pub(crate) fn frame_count(&self) -> u64 {
        self.lock().next
    }

    pub(crate) fn take_messages(&self) -> Vec<String> {
        std::mem::take(&mut self.lock().messages)
    }

    fn lock(&self) -> MutexGuard<'_, PlayerState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, state: MutexGuard<'a, PlayerState>) -> MutexGuard<'a, PlayerState> {
        self.changed.wait(state).unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns the facts about a design that the page needs.
pub(crate) fn design_facts(design: &Design) -> Value {
    json!({
        "fingerprint": design.fingerprint(),
        "width": design.width(),
        "height": design.height(),
        "columns": design.columns(),
        "rows": design.rows(),
        "side": design.region_size(),
    })
}

/// Returns a byte per region, as the engine packs them, and then a byte per pixel.
pub(crate) fn frame_bytes(frame: &ShownFrame) -> Vec<u8> {
    let mut picture: Vec<u8> = frame.outcome.region_bytes().collect();
    frame.screen.borrowed_pixels().append_grey(frame.screen.bits(), &mut picture);
    picture
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    fn head(answer: &[u8]) -> Value {
        let (length, rest) = answer.split_first_chunk().unwrap();
        serde_json::from_slice(&rest[..u32::from_le_bytes(*length) as usize]).unwrap()
    }

    #[test]
    fn a_camera_that_has_broken_off_is_opened_again_and_a_running_one_goes_on() {
        let options = InputOptions { frames: Some(3), ..InputOptions::default() };
        let (mut player, source) =
            FramePlayer::open(vec!["scene:street".to_owned()], options).unwrap();
        // The scene behaves as a camera, which does not wait.
        player.kind = FrameDelivery::Camera;
        player.restart().unwrap();
        assert!(!player.lock().restart_requested);
        // The status changes at once, before the reader has noticed the request.
        for status in [InputStatus::Ended, InputStatus::Failed] {
            *player.lock() =
                PlayerState { status, restart_requested: false, ..PlayerState::new(String::new()) };
            player.restart().unwrap();
            let state = player.lock();
            assert!(state.restart_requested && state.status == InputStatus::Running);
        }
        let player = Arc::new(player);
        let reading = {
            let player = Arc::clone(&player);
            std::thread::spawn(move || player.run(source))
        };
        let time_limit = Duration::from_secs(60);
        for run in 1..=2 {
            // The first two frames are never asked for.
            let last = head(&player.frame_after(Some(3 * run - 2), None, time_limit));
            assert_eq!((&last["number"], &last["live"]), (&(3 * run - 1).into(), &true.into()));
            assert_eq!(
                head(&player.frame_after(Some(3 * run - 1), None, time_limit))["status"],
                "ended"
            );
            player.restart().unwrap();
        }
        player.end();
        reading.join().unwrap();
        assert!(player.take_messages().is_empty());
    }
}
