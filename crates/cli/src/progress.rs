// SPDX-License-Identifier: MIT OR Apache-2.0
//! Progress on standard error: a bar where a terminal is there to draw it, a line now and then where a log
//! is written.

mod lines;

use std::io::IsTerminal as _;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use lines::Lines;

const WORK: &str = "{spinner} {msg} [{elapsed}]";
const STEPS: &str = "{msg} {wide_bar} {pos}/{len} [{elapsed}, {eta} left]";
const FRAMES: &str = "{spinner} {pos} frames [{elapsed}, {per_sec:.1}] {msg}";
const FRAMES_OF_ALL: &str =
    "{wide_bar} {pos}/{len} frames [{elapsed}, {per_sec:.1}, {eta} left] {msg}";

/// What a command is about. Nothing is shown before it says so, nothing when quiet, and nothing remains on
/// a terminal when it is dropped.
pub(crate) struct Progress {
    bar: ProgressBar,
    stage: Arc<Mutex<Stage>>,
    /// Where standard error is no terminal, until the end.
    lines: Mutex<Option<Lines>>,
}

/// What goes on.
#[derive(Clone, Debug, Default, PartialEq)]
struct Stage {
    style: Option<&'static str>,
    what: String,
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
        let stage = Arc::new(Mutex::new(Stage::default()));
        let lines = !quiet && !terminal;
        let lines = lines.then(|| Lines::start(bar.clone(), Arc::clone(&stage))).flatten();
        Self { bar, stage, lines: Mutex::new(lines) }
    }

    /// Work of unknown length, such as one run of a tool: `synthesizing with Yosys`.
    pub(crate) fn work(&self, what: &str) {
        self.enter(WORK, what);
    }

    /// So many of all steps are done: `designs over clips`. While there is none to do it is [`Progress::work`].
    pub(crate) fn steps(&self, what: &str, done: u64, all: u64) {
        if all == 0 {
            return self.work(what);
        }
        self.enter(STEPS, what);
        self.bar.set_length(all);
        self.bar.set_position(done);
    }

    /// So many frames are done, of so many if that is known; `note` stands beside it.
    pub(crate) fn frames(&self, done: u64, all: Option<u64>, note: &str) {
        self.enter(if all.is_some() { FRAMES_OF_ALL } else { FRAMES }, note);
        if let Some(all) = all {
            self.bar.set_length(all.max(done));
        }
        self.bar.set_position(done);
    }

    /// Clears the line of the terminal and is silent from then on: before results are printed.
    pub(crate) fn finish(&self) {
        drop(self.lines.lock().unwrap_or_else(PoisonError::into_inner).take());
        self.bar.finish_and_clear();
    }

    fn enter(&self, style: &'static str, what: &str) {
        let mut stage = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        if stage.style == Some(style) && stage.what == what {
            return;
        }
        if stage.style != Some(style) {
            // Only a program fault makes a template that cannot be read; the bar is then the plain one.
            if let Ok(template) = ProgressStyle::with_template(style) {
                self.bar.set_style(template);
            }
            if !self.bar.is_hidden() {
                self.bar.enable_steady_tick(Duration::from_millis(120));
            }
        }
        if style == STEPS || stage.style != Some(style) {
            self.bar.reset_eta();
        }
        self.bar.set_message(what.to_owned());
        *stage = Stage { style: Some(style), what: what.to_owned() };
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}
