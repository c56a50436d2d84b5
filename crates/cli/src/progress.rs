// SPDX-License-Identifier: MIT OR Apache-2.0
//! Progress on standard error: a bar where a terminal is there to draw it, a line now and then where a log
//! is written.

mod lines;
mod stage;
mod words;

use std::fmt::Write;
use std::io::IsTerminal as _;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use terminal_size::Width;

use crate::notice::printable;
use lines::Lines;
use stage::{Stage, StageAmount, StageUnit, locked};
use words::drawn;

/// A line for a source without a known length.
const OPEN: &str = "{spinner} {told}";
/// A line for a source of known length.
const BAR: &str = "{told} {wide_bar}";
/// Columns where nobody knows how many there are.
const COLUMNS: usize = 80;
/// Time between two drawings of the time that has passed.
const TICK: Duration = Duration::from_millis(120);

/// What a command is about. Nothing is shown before it says so, nothing when quiet, and nothing remains on
/// a terminal when it is dropped.
pub(crate) struct Progress {
    bar: ProgressBar,
    stage: Arc<Mutex<Stage>>,
    /// Where standard error is no terminal, until the end.
    lines: Mutex<Option<Lines>>,
}

impl Progress {
    pub(crate) fn new(quiet: bool) -> Self {
        let terminal = std::io::stderr().is_terminal();
        let bar = ProgressBar::new_spinner();
        bar.set_draw_target(if quiet || !terminal {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        });
        let stage = Arc::new(Mutex::new(Stage::new(Instant::now())));
        let lines = !quiet && !terminal;
        let lines = lines.then(|| Lines::start(Arc::clone(&stage))).flatten();
        Self { bar, stage, lines: Mutex::new(lines) }
    }

    /// Work of unknown length, such as one run of a tool: `synthesizing with Yosys`.
    pub(crate) fn work(&self, what: &str) {
        self.enter(StageUnit::Work, what, StageAmount::default());
    }

    /// So many of all steps are done: `designs over clips`. While there is none to do it is [`Progress::work`].
    pub(crate) fn steps(&self, what: &str, done: u64, all: u64) {
        if all == 0 {
            return self.work(what);
        }
        self.enter(StageUnit::Steps, what, StageAmount::new(done, Some(all)));
    }

    /// So many frames are done, of so many if that is known; `note` stands beside it.
    pub(crate) fn frames(&self, done: u64, all: Option<u64>, note: &str) {
        self.enter(StageUnit::Frames, note, StageAmount::new(done, all));
    }

    /// Clears the line of the terminal and is silent from then on: before results are printed.
    pub(crate) fn finish(&self) {
        drop(self.lines.lock().unwrap_or_else(PoisonError::into_inner).take());
        self.bar.finish_and_clear();
    }

    fn enter(&self, counted: StageUnit, what: &str, amount: StageAmount) {
        let what = &*printable(what);
        // Not held while the bar is told: it asks for the stage when it draws.
        let before = {
            let mut stage = locked(&self.stage);
            let before = stage.counted.map(|_| stage.amount.all.is_some());
            stage.enter(counted, what, amount, Instant::now());
            before
        };
        // Words are those of the stage, whatever the bar has: the template is first, or a plain bar would be drawn.
        let has_length = amount.all.is_some();
        if before != Some(has_length) {
            self.show(if has_length { BAR } else { OPEN });
        }
        match amount.all {
            Some(all) => self.bar.set_length(all),
            None => self.bar.unset_length(),
        }
        self.bar.set_position(amount.done);
        if before.is_none() && !self.bar.is_hidden() {
            self.bar.enable_steady_tick(TICK);
        }
    }

    /// Draws by a template from now on.
    fn show(&self, template: &'static str) {
        // Only a program fault makes a template that cannot be read; the bar is then the plain one.
        if let Ok(style) = ProgressStyle::with_template(template) {
            let stage = Arc::clone(&self.stage);
            let told = move |bar: &ProgressState, text: &mut dyn Write| {
                let room = room(columns(), template);
                let told = drawn(&locked(&stage), bar.elapsed(), Instant::now(), room);
                let _ = text.write_str(&told);
            };
            self.bar.set_style(style.with_key("told", told));
        }
    }
}

/// Columns of the terminal that progress is drawn on.
fn columns() -> usize {
    let size = terminal_size::terminal_size_of(std::io::stderr());
    size.map_or(COLUMNS, |(Width(columns), _)| columns.into())
}

/// Columns for words: the spinner and the space behind it take two, and a bar that says something a quarter of the line.
fn room(columns: usize, template: &str) -> usize {
    // A line that fills all columns would be followed by an empty one.
    let columns = columns.saturating_sub(1);
    columns.saturating_sub(if template == BAR { 1 + columns / 4 } else { 2 })
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}
