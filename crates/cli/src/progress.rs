// SPDX-License-Identifier: MIT OR Apache-2.0
//! Progress on standard error, where a terminal is there to see it.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A spinner with a message, hidden when quiet or when there is no terminal.
pub(crate) fn spinner(quiet: bool, message: &str) -> ProgressBar {
    let bar = with_style(quiet, ProgressBar::new_spinner(), "{spinner} {msg} [{elapsed}]");
    bar.set_message(message.to_owned());
    bar
}

/// Frames with rate and time left; the time left needs a total.
pub(crate) fn frames(quiet: bool) -> ProgressBar {
    with_style(quiet, ProgressBar::new_spinner(), FRAMES_ONLY)
}

const FRAMES_ONLY: &str = "{spinner} {pos} frames [{elapsed}, {per_sec:.1}] {msg}";
const FRAMES_OF_ALL: &str =
    "{wide_bar} {pos}/{len} frames [{elapsed}, {per_sec:.1}, {eta} left] {msg}";

/// Tells a bar of [`frames`] how many there will be.
pub(crate) fn set_total(bar: &ProgressBar, total: u64) {
    if bar.length() != Some(total) {
        bar.set_length(total);
        if let Ok(style) = ProgressStyle::with_template(FRAMES_OF_ALL) {
            bar.set_style(style);
        }
    }
}

/// A bar over a known number of steps.
pub(crate) fn bar(quiet: bool, length: u64, message: &str) -> ProgressBar {
    let style = "{msg} {wide_bar} {pos}/{len} [{elapsed}, {eta} left]";
    let bar = with_style(quiet, ProgressBar::new(length), style);
    bar.set_message(message.to_owned());
    bar
}

fn with_style(quiet: bool, bar: ProgressBar, template: &str) -> ProgressBar {
    // indicatif itself hides what is drawn to something that is no terminal.
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    bar.set_draw_target(target);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(120));
    bar
}
