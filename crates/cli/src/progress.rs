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
