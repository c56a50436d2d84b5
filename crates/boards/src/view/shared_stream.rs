// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state of a stream that the reader, the board and the browsers share ([`SharedStream`]).
//! No part waits for another: only the newest frame is kept, so a slow browser misses frames.

use super::frame_player::{design_facts, frame_bytes};
use crate::view::input::Input;
use foveate_design::Design;
use foveate_simulator::{ShownFrame, StreamLoss};
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The time without a byte after which the page and the terminal report silence.
const SILENCE_LIMIT: Duration = Duration::from_secs(2);

/// The number of frames whose figures are kept.
const HISTORY_LENGTH: usize = 240;

/// The number of losses that the page lists, the newest ones.
const LISTED_LOSSES: usize = 50;

/// The number of losses that are reported in the terminal, the first ones. The same number applies
/// to refusals.
const REPORTED_LIMIT: u64 = 10;

/// The number of messages that wait for the terminal. Further messages are left out until they are
/// fetched.
const MESSAGE_QUEUE: usize = 100;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum StreamStatus {
    /// No frame has come yet.
    Waiting,
    /// Frames come.
    Running,
    /// The port is gone, and may come back.
    Gone,
    /// No more frames will come.
    Ended,
}

#[derive(Clone, Debug, Serialize)]
struct FrameFigures {
    /// The number of the change that added the frame.
    #[serde(skip)]
    change: u64,
    number: u32,
    /// The version of the map of classes, in a design with zones.
    #[serde(skip_serializing_if = "Option::is_none")]
    map_version: Option<u16>,
    active: usize,
    bytes: u64,
    /// The time at which the frame was shown, in milliseconds since the start.
    shown_ms: u64,
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct RegisterReading {
    pub(crate) address: u32,
    /// The value; `None` if the board did not answer.
    pub(crate) value: Option<u32>,
}

/// A count of all changes. A browser sends the count that it knows, and gets all later changes.
type ChangeCount = u64;

#[derive(Debug)]
struct StreamState {
    change: ChangeCount,
    status: StreamStatus,
    text: String,
    /// The reason why frames cannot be shown.
    refused: Option<String>,
    last_byte: Instant,
    is_silent: bool,
    design: Value,
    /// The decisions and pixels of the newest frame, and the change that added them.
    picture: (ChangeCount, Vec<u8>),
    frames: u64,
    bytes: u64,
    history: VecDeque<FrameFigures>,
    losses: BTreeMap<&'static str, u64>,
    listed_losses: VecDeque<String>,
    registers: (ChangeCount, Vec<RegisterReading>),
    /// The number of refusals that were reported.
    refusals: u64,
    messages: Vec<String>,
}

impl StreamState {
    fn push_message(&mut self, text: String) {
        match self.messages.len() {
            0..MESSAGE_QUEUE => self.messages.push(text),
            MESSAGE_QUEUE => self.messages.push("further messages were left out".to_owned()),
            _ => {}
        }
    }
}

/// The state of the stream, and the signal of its changes.
#[derive(Debug)]
pub(crate) struct SharedStream {
    state: Mutex<StreamState>,
    changed: Condvar,
    is_over: AtomicBool,
    start: Instant,
    name: String,
    is_live: bool,
}

impl SharedStream {
    pub(crate) fn new(input: &Input) -> Self {
        let state = StreamState {
            change: 1,
            status: StreamStatus::Waiting,
            text: format!("waiting for `{}`", input.name()),
            refused: None,
            last_byte: Instant::now(),
            is_silent: false,
            design: Value::Null,
            picture: (0, Vec::new()),
            frames: 0,
            bytes: 0,
            history: VecDeque::new(),
            losses: BTreeMap::new(),
            listed_losses: VecDeque::new(),
            registers: (0, Vec::new()),
            refusals: 0,
            messages: Vec::new(),
        };
        let (name, is_live) = (input.name(), input.is_live());
        Self {
            state: Mutex::new(state),
            changed: Condvar::new(),
            is_over: AtomicBool::new(false),
            start: Instant::now(),
            name,
            is_live,
        }
    }

    /// Ends all threads of the view.
    pub(crate) fn stop(&self) {
        self.is_over.store(true, Ordering::Relaxed);
        self.changed.notify_all();
    }

    pub(crate) fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    pub(crate) fn frames_shown(&self) -> u64 {
        self.lock_noting_silence().frames
    }

    pub(crate) fn take_messages(&self) -> Vec<String> {
        std::mem::take(&mut self.lock_noting_silence().messages)
    }

    /// Notes that bytes have come.
    pub(crate) fn note_bytes(&self) {
        let mut state = self.lock();
        state.last_byte = Instant::now();
        if std::mem::take(&mut state.is_silent) {
            self.note_change(&mut state);
        }
    }

    pub(crate) fn set_status(&self, status: StreamStatus, text: String) {
        let mut state = self.lock();
        state.push_message(text.clone());
        (state.status, state.text, state.is_silent) = (status, text, false);
        state.last_byte = Instant::now();
        self.note_change(&mut state);
    }

    /// Adds a message for the terminal that does not change the status.
    pub(crate) fn add_message(&self, text: String) {
        self.lock().push_message(text);
    }

    /// Notes that the next frame is due only after `left`.
    pub(crate) fn note_wait(&self, number: u32, left: Duration) {
        let mut state = self.lock();
        let seconds = left.as_secs();
        state.text = format!("showing `{}`; frame {number} is due in {seconds} s", self.name);
        self.note_change(&mut state);
    }

    /// Notes that a FRAME packet cannot be read. This is reported once until a frame is shown, and
    /// at most [`REPORTED_LIMIT`] times.
    pub(crate) fn note_refusal(&self, text: String) {
        let mut state = self.lock();
        if state.refused.is_none() && state.refusals < REPORTED_LIMIT {
            state.refusals += 1;
            state.push_message(text.clone());
        }
        state.refused = Some(text);
        self.note_change(&mut state);
    }

    pub(crate) fn note_loss(&self, loss: &StreamLoss) {
        let mut state = self.lock();
        *state.losses.entry(loss.kind()).or_default() += 1;
        match state.losses.values().sum::<u64>() {
            0..=REPORTED_LIMIT => state.push_message(loss.to_string()),
            count if count == REPORTED_LIMIT + 1 => {
                state.push_message("more losses follow; the page counts them".to_owned());
            }
            _ => {}
        }
        state.listed_losses.truncate(LISTED_LOSSES - 1);
        state.listed_losses.push_front(loss.to_string());
        self.note_change(&mut state);
    }

    /// Notes that a frame is on the screen, and that its packets had `bytes` bytes.
    pub(crate) fn set_frame(&self, frame: &ShownFrame, design: &Design, bytes: u64) {
        let picture = frame_bytes(frame);
        let active = frame.outcome.active.iter().filter(|&&active| active).count();
        let shown_ms = u64::try_from(self.start.elapsed().as_millis()).unwrap_or(u64::MAX);
        let mut state = self.lock();
        if state.frames == 0 || state.status != StreamStatus::Running {
            state.design = design_facts(design);
            state.status = StreamStatus::Running;
        }
        state.text = format!("showing `{}`", self.name);
        state.refused = None;
        self.note_change(&mut state);
        let change = state.change;
        state.picture = (change, picture);
        state.frames += 1;
        state.bytes += bytes;
        state.history.truncate(HISTORY_LENGTH - 1);
        state.history.push_front(FrameFigures {
            change,
            number: frame.number,
            map_version: frame.map_version,
            active,
            bytes,
            shown_ms,
        });
    }

    /// Notes the values of a round of reads of all registers.
    pub(crate) fn set_registers(&self, registers: Vec<RegisterReading>) {
        let mut state = self.lock();
        self.note_change(&mut state);
        state.registers = (state.change, registers);
    }

    /// Returns the answer to a browser that knows all changes up to `after`: the length of a JSON
    /// text in bytes as a 32-bit number, and the text. If the browser does not know the newest
    /// frame, its decisions follow with a byte per region, and its pixels with a byte per pixel.
    /// Waits up to `time_limit` for a change.
    pub(crate) fn changes_after(&self, after: ChangeCount, time_limit: Duration) -> Vec<u8> {
        let until = Instant::now() + time_limit;
        let mut state = self.lock_noting_silence();
        while state.change <= after && !self.is_over() {
            let Some(left) = until.checked_duration_since(Instant::now()) else { break };
            state =
                self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        let (changed, picture) = &state.picture;
        let picture: &[u8] = if *changed > after { picture } else { &[] };
        let history: Vec<&FrameFigures> =
            state.history.iter().take_while(|figures| figures.change > after).collect();
        let registers = (state.registers.0 > after).then_some(&state.registers.1);
        let text = json!({
            "change": state.change,
            "status": state.status,
            "text": state.text,
            "refused": state.refused,
            "silent": state.is_silent,
            "design": state.design,
            "frames": state.frames,
            "bytes": state.bytes,
            "history": history,
            "losses": state.losses,
            "listed": state.listed_losses,
            "registers": registers,
        });
        let text = text.to_string();
        let length = u32::try_from(text.len()).unwrap_or(u32::MAX);
        [&length.to_le_bytes(), text.as_bytes(), picture].concat()
    }

    /// Locks the state. If nothing has come for too long, this is noted in it.
    fn lock_noting_silence(&self) -> MutexGuard<'_, StreamState> {
        let mut state = self.lock();
        let is_sending =
            matches!(state.status, StreamStatus::Waiting | StreamStatus::Running) && self.is_live;
        if is_sending && !state.is_silent && state.last_byte.elapsed() > SILENCE_LIMIT {
            state.is_silent = true;
            let seconds = SILENCE_LIMIT.as_secs();
            state.push_message(format!("nothing has come from `{}` for {seconds} s", self.name));
            self.note_change(&mut state);
        }
        state
    }

    fn lock(&self) -> MutexGuard<'_, StreamState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note_change(&self, state: &mut StreamState) {
        state.change += 1;
        self.changed.notify_all();
    }
}
