// SPDX-License-Identifier: MIT OR Apache-2.0
//! The present state of the stream, which the reader, the board and the browsers share. Only the
//! newest frame is kept: a slow browser misses frames, and no other part waits for it.

use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use foveate_design::Design;
use foveate_simulator::{Loss, ShownFrame};
use serde::Serialize;
use serde_json::{Value, json};

use crate::input::Input;
use crate::picture::{facts, picture};

/// The time without a byte after which the page and the terminal report silence.
const SILENCE: Duration = Duration::from_secs(2);
/// The number of frames whose figures are kept.
const HISTORY: usize = 240;
/// The number of losses that the page lists, the newest ones.
const LISTED: usize = 50;
/// The number of losses, and of refusals, that are reported in the terminal, the first ones.
const TOLD: u64 = 10;
/// The number of messages that wait for the terminal. Further messages are left out until they are
/// fetched.
const WAITING_NEWS: usize = 100;

/// The status of the stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Status {
    /// No frame has come yet.
    Waiting,
    /// Frames come.
    Running,
    /// The port is gone, and may come back.
    Gone,
    /// No more frames will come.
    Ended,
}

/// The figures of a frame.
#[derive(Clone, Debug, Serialize)]
struct Sample {
    /// The [`Change`] that added the frame.
    #[serde(skip)]
    at: u64,
    number: u32,
    active: usize,
    bytes: u64,
    /// The time at which the frame was shown, in milliseconds since the start.
    shown_ms: u64,
}

/// A register with the value of the last read.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Reading {
    pub(crate) address: u32,
    /// The value; `None` if the board did not answer.
    pub(crate) value: Option<u32>,
}

/// A count of all changes, by which a browser asks for what it does not know.
type Change = u64;

#[derive(Debug)]
struct State {
    change: Change,
    status: Status,
    text: String,
    /// The reason why frames cannot be shown.
    refused: Option<String>,
    heard: Instant,
    is_silent: bool,
    design: Value,
    /// The decisions and pixels of the newest frame, and the change that added them.
    picture: (Change, Vec<u8>),
    frames: u64,
    bytes: u64,
    history: VecDeque<Sample>,
    losses: BTreeMap<&'static str, u64>,
    listed: VecDeque<String>,
    registers: (Change, Vec<Reading>),
    /// The number of refusals that were reported.
    refusals: u64,
    news: Vec<String>,
}

impl State {
    fn tell(&mut self, text: String) {
        match self.news.len() {
            0..WAITING_NEWS => self.news.push(text),
            WAITING_NEWS => self.news.push("further messages were left out".to_owned()),
            _ => {}
        }
    }
}

/// The state of the stream, and what waits for its changes.
#[derive(Debug)]
pub(crate) struct Live {
    state: Mutex<State>,
    changed: Condvar,
    is_over: AtomicBool,
    start: Instant,
    name: String,
    is_live: bool,
}

impl Live {
    pub(crate) fn new(input: &Input) -> Self {
        let state = State {
            change: 1,
            status: Status::Waiting,
            text: format!("waiting for `{}`", input.name()),
            refused: None,
            heard: Instant::now(),
            is_silent: false,
            design: Value::Null,
            picture: (0, Vec::new()),
            frames: 0,
            bytes: 0,
            history: VecDeque::new(),
            losses: BTreeMap::new(),
            listed: VecDeque::new(),
            registers: (0, Vec::new()),
            refusals: 0,
            news: Vec::new(),
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
    pub(crate) fn end(&self) {
        self.is_over.store(true, Ordering::Relaxed);
        self.changed.notify_all();
    }

    pub(crate) fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    pub(crate) fn frames(&self) -> u64 {
        self.look().frames
    }

    pub(crate) fn news(&self) -> Vec<String> {
        std::mem::take(&mut self.look().news)
    }

    /// Notes that bytes have come.
    pub(crate) fn heard(&self) {
        let mut state = self.lock();
        state.heard = Instant::now();
        if std::mem::take(&mut state.is_silent) {
            self.change(&mut state);
        }
    }

    pub(crate) fn status(&self, status: Status, text: String) {
        let mut state = self.lock();
        state.tell(text.clone());
        (state.status, state.text, state.is_silent) = (status, text, false);
        state.heard = Instant::now();
        self.change(&mut state);
    }

    /// Adds a message for the terminal that does not change the status.
    pub(crate) fn tell(&self, text: String) {
        self.lock().tell(text);
    }

    /// Notes that the next frame is due only after `left`.
    pub(crate) fn expect(&self, number: u32, left: Duration) {
        let mut state = self.lock();
        let seconds = left.as_secs();
        state.text = format!("showing `{}`; frame {number} is due in {seconds} s", self.name);
        self.change(&mut state);
    }

    /// Notes that a FRAME packet cannot be read. This is reported once until a frame is shown, and
    /// at most [`TOLD`] times.
    pub(crate) fn refuse(&self, text: String) {
        let mut state = self.lock();
        if state.refused.is_none() && state.refusals < TOLD {
            state.refusals += 1;
            state.tell(text.clone());
        }
        state.refused = Some(text);
        self.change(&mut state);
    }

    pub(crate) fn lose(&self, loss: &Loss) {
        let mut state = self.lock();
        *state.losses.entry(loss.kind()).or_default() += 1;
        match state.losses.values().sum::<u64>() {
            0..=TOLD => state.tell(loss.to_string()),
            count if count == TOLD + 1 => {
                state.tell("more losses follow; the page counts them".to_owned());
            }
            _ => {}
        }
        state.listed.truncate(LISTED - 1);
        state.listed.push_front(loss.to_string());
        self.change(&mut state);
    }

    /// Notes that a frame is on the screen, and that its packets had `bytes` bytes.
    pub(crate) fn show(&self, frame: &ShownFrame, design: &Design, bytes: u64) {
        let picture = picture(frame);
        let active = frame.outcome.active.iter().filter(|&&active| active).count();
        let shown_ms = u64::try_from(self.start.elapsed().as_millis()).unwrap_or(u64::MAX);
        let mut state = self.lock();
        if state.frames == 0 || state.status != Status::Running {
            state.design = facts(design);
            state.status = Status::Running;
        }
        state.text = format!("showing `{}`", self.name);
        state.refused = None;
        self.change(&mut state);
        let at = state.change;
        state.picture = (at, picture);
        state.frames += 1;
        state.bytes += bytes;
        state.history.truncate(HISTORY - 1);
        state.history.push_front(Sample { at, number: frame.number, active, bytes, shown_ms });
    }

    /// Notes the values of a round of reads of all registers.
    pub(crate) fn read(&self, registers: Vec<Reading>) {
        let mut state = self.lock();
        self.change(&mut state);
        state.registers = (state.change, registers);
    }

    /// Returns what a browser needs that knows all changes up to `after`: the length of a JSON text
    /// in bytes as a 32-bit number, the text, and, if the newest frame is new, its decisions and
    /// pixels with a byte per region and a byte per pixel. Waits up to `patience` for a change.
    pub(crate) fn next(&self, after: Change, patience: Duration) -> Vec<u8> {
        let until = Instant::now() + patience;
        let mut state = self.look();
        while state.change <= after && !self.is_over() {
            let Some(left) = until.checked_duration_since(Instant::now()) else { break };
            state =
                self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        let (changed, picture) = &state.picture;
        let picture: &[u8] = if *changed > after { picture } else { &[] };
        let history: Vec<&Sample> = state.history.iter().take_while(|own| own.at > after).collect();
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
            "listed": state.listed,
            "registers": registers,
        });
        let text = text.to_string();
        let length = u32::try_from(text.len()).unwrap_or(u32::MAX);
        [&length.to_le_bytes(), text.as_bytes(), picture].concat()
    }

    /// Locks the state. If nothing has come for too long, this is noted in it.
    fn look(&self) -> MutexGuard<'_, State> {
        let mut state = self.lock();
        let comes = matches!(state.status, Status::Waiting | Status::Running) && self.is_live;
        if comes && !state.is_silent && state.heard.elapsed() > SILENCE {
            state.is_silent = true;
            let seconds = SILENCE.as_secs();
            state.tell(format!("nothing has come from `{}` for {seconds} s", self.name));
            self.change(&mut state);
        }
        state
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&self, state: &mut State) {
        state.change += 1;
        self.changed.notify_all();
    }
}
