// SPDX-License-Identifier: MIT OR Apache-2.0
//! Progress on standard error: a bar on a terminal, or a line now and then in a log.

mod logger;
mod run_terminal;
mod stage_text;

pub(crate) use run_terminal::RunTerminal;

use std::fmt::Write;
use std::io::IsTerminal as _;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use foveate_media::{ProgressStage, RunProgress, StageAmount};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use terminal_size::Width;

use crate::notice::printable;
use logger::ProgressLogger;
use stage_text::terminal_line;

/// The template of the line for a source of unknown length.
const OPEN_TEMPLATE: &str = "{spinner} {told}";
/// The template of the line for a source of known length.
const BAR_TEMPLATE: &str = "{told} {wide_bar}";
/// The columns of a terminal whose width is unknown.
const DEFAULT_COLUMNS: usize = 80;
/// The time between two drawings of the elapsed time.
const REDRAW_INTERVAL: Duration = Duration::from_millis(120);

/// The progress of a command. Nothing is shown before the command reports its first stage, and
/// nothing if it is quiet. Nothing remains on a terminal after the drop.
pub(crate) struct Progress {
    bar: ProgressBar,
    stage: Arc<Mutex<ProgressStage>>,
    /// The lines of a log, until the end, if standard error is no terminal.
    log_lines: Mutex<Option<ProgressLogger>>,
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
        let stage = Arc::new(Mutex::new(ProgressStage::new(Instant::now())));
        let lines = !quiet && !terminal;
        let lines = lines.then(|| ProgressLogger::start(Arc::clone(&stage))).flatten();
        Self { bar, stage, log_lines: Mutex::new(lines) }
    }

    /// Reports work of unknown length, such as one run of a tool: `synthesizing with Yosys`.
    pub(crate) fn report_work(&self, what: &str) {
        self.report(&RunProgress::work(what));
    }

    /// Reports that `done` of `all` steps are done, such as `designs over clips`.
    pub(crate) fn report_steps(&self, what: &str, done: u64, all: u64) {
        self.report(&RunProgress::steps(what, done, all));
    }

    /// Clears the line of the terminal, and shows nothing from then on. This comes before results
    /// are printed.
    pub(crate) fn finish(&self) {
        drop(self.log_lines.lock().unwrap_or_else(PoisonError::into_inner).take());
        self.bar.finish_and_clear();
    }

    pub(crate) fn report(&self, progress: &RunProgress<'_>) {
        let label = printable(&progress.label);
        let progress = RunProgress { label, ..*progress };
        let amount = StageAmount::new(progress.done, progress.total);
        // The lock is not held while the bar is updated, because the bar takes it when it draws.
        let before = {
            let mut stage = lock_stage(&self.stage);
            let before = stage.unit.map(|_| stage.amount.total.is_some());
            stage.enter(&progress, Instant::now());
            before
        };
        // The bar takes its words from the stage. The template is set first, or a plain bar would
        // be drawn.
        let has_length = amount.total.is_some();
        if before != Some(has_length) {
            self.set_template(if has_length { BAR_TEMPLATE } else { OPEN_TEMPLATE });
        }
        match amount.total {
            Some(all) => self.bar.set_length(all),
            None => self.bar.unset_length(),
        }
        self.bar.set_position(amount.done);
        if before.is_none() && !self.bar.is_hidden() {
            self.bar.enable_steady_tick(REDRAW_INTERVAL);
        }
    }

    /// Draws with this template from now on.
    fn set_template(&self, template: &'static str) {
        // A template is unreadable only through a fault of the program; the bar is then the plain
        // one.
        if let Ok(style) = ProgressStyle::with_template(template) {
            let stage = Arc::clone(&self.stage);
            let told = move |bar: &ProgressState, text: &mut dyn Write| {
                let room = text_columns(terminal_columns(), template);
                let told = terminal_line(&lock_stage(&stage), bar.elapsed(), Instant::now(), room);
                let _ = text.write_str(&told);
            };
            self.bar.set_style(style.with_key("told", told));
        }
    }
}

fn terminal_columns() -> usize {
    let size = terminal_size::terminal_size_of(std::io::stderr());
    size.map_or(DEFAULT_COLUMNS, |(Width(columns), _)| columns.into())
}

/// Returns the columns for words. The spinner and the space behind it take two columns; a bar takes
/// a space and a quarter of the line.
fn text_columns(columns: usize, template: &str) -> usize {
    // A line that fills all columns would be followed by an empty one.
    let columns = columns.saturating_sub(1);
    columns.saturating_sub(if template == BAR_TEMPLATE { 1 + columns / 4 } else { 2 })
}

/// Locks the stage. Its value is valid even if a thread panicked while it held the lock.
fn lock_stage(stage: &Mutex<ProgressStage>) -> MutexGuard<'_, ProgressStage> {
    stage.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}
