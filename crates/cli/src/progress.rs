// SPDX-License-Identifier: MIT OR Apache-2.0
//! Progress on standard error, where a terminal is there to see it.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

const SPINNER: &str = "{spinner} {msg} [{elapsed}]";
const BAR: &str = "{msg} {wide_bar} {pos}/{len} [{elapsed}, {eta} left]";
const FRAMES_ONLY: &str = "{spinner} {pos} frames [{elapsed}, {per_sec:.1}] {msg}";
const FRAMES_OF_ALL: &str =
    "{wide_bar} {pos}/{len} frames [{elapsed}, {per_sec:.1}, {eta} left] {msg}";

/// A spinner with a message, hidden when quiet or when there is no terminal.
pub(crate) fn spinner(quiet: bool, message: &str) -> ProgressBar {
    let bar = shown(quiet, ProgressBar::new_spinner());
    become_spinner(&bar, message);
    bar
}

/// Turns a bar into a spinner, for work of unknown length that follows.
pub(crate) fn become_spinner(bar: &ProgressBar, message: &str) {
    set_style(bar, SPINNER);
    bar.set_message(message.to_owned());
}

/// Frames with rate and time left; the time left needs a total.
pub(crate) fn frames(quiet: bool) -> ProgressBar {
    let bar = shown(quiet, ProgressBar::new_spinner());
    set_style(&bar, FRAMES_ONLY);
    bar
}

/// Tells a bar of [`frames`] how many there will be.
pub(crate) fn set_total(bar: &ProgressBar, total: u64) {
    if bar.length() != Some(total) {
        bar.set_length(total);
        set_style(bar, FRAMES_OF_ALL);
    }
}

/// A bar over a known number of steps.
pub(crate) fn bar(quiet: bool, length: u64, message: &str) -> ProgressBar {
    let bar = shown(quiet, ProgressBar::new(length));
    set_style(&bar, BAR);
    bar.set_message(message.to_owned());
    bar
}

fn shown(quiet: bool, bar: ProgressBar) -> ProgressBar {
    // indicatif itself hides what is drawn to something that is no terminal.
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    bar.set_draw_target(target);
    bar.enable_steady_tick(Duration::from_millis(120));
    bar
}

fn set_style(bar: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
}
