// SPDX-License-Identifier: MIT OR Apache-2.0
//! Progress on standard error: a bar where a terminal is there to draw it, a line now and then where a log
//! is written.

mod lines;
mod stage;

use std::fmt::Write;
use std::io::IsTerminal as _;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use crate::notice::printable;
use lines::Lines;
use stage::{FRAMES, FRAMES_OF_ALL, Left, STEPS, Stage, WORK, locked};

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
        let lines = lines.then(|| Lines::start(bar.clone(), Arc::clone(&stage))).flatten();
        Self { bar, stage, lines: Mutex::new(lines) }
    }

    /// Work of unknown length, such as one run of a tool: `synthesizing with Yosys`.
    pub(crate) fn work(&self, what: &str) {
        self.enter(WORK, what, 0);
    }

    /// So many of all steps are done: `designs over clips`. While there is none to do it is [`Progress::work`].
    pub(crate) fn steps(&self, what: &str, done: u64, all: u64) {
        if all == 0 {
            return self.work(what);
        }
        self.enter(STEPS, what, done);
        self.bar.set_length(all);
        self.bar.set_position(done);
    }

    /// So many frames are done, of so many if that is known; `note` stands beside it.
    pub(crate) fn frames(&self, done: u64, all: Option<u64>, note: &str) {
        self.enter(if all.is_some() { FRAMES_OF_ALL } else { FRAMES }, note, done);
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

    fn enter(&self, style: &'static str, what: &str, done: u64) {
        let what = &*printable(what);
        // Not held while the bar is told: it asks for the stage when it draws.
        let before = {
            let mut stage = locked(&self.stage);
            let before = (stage.style, stage.what.clone());
            stage.enter(style, what, done, Instant::now());
            before
        };
        if before.0 != Some(style) {
            // Only a program fault makes a template that cannot be read; the bar is then the plain one.
            if let Ok(template) = ProgressStyle::with_template(style) {
                let stage = Arc::clone(&self.stage);
                let left = move |bar: &ProgressState, text: &mut dyn Write| {
                    let all = bar.len().unwrap_or(0);
                    let left = locked(&stage).left(bar.pos(), all, Instant::now());
                    let _ = match left {
                        None => Ok(()),
                        Some(Left::About(left)) => write!(text, ", {:#} left", HumanDuration(left)),
                        Some(Left::MoreThan(left)) => {
                            write!(text, ", over {:#} left", HumanDuration(left))
                        }
                    };
                };
                self.bar.set_style(template.with_key("left", left));
            }
            if !self.bar.is_hidden() {
                self.bar.enable_steady_tick(Duration::from_millis(120));
            }
        }
        if before.0 != Some(style) || before.1 != what {
            self.bar.set_message(what.to_owned());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}
