// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate view`: packets in, a page in the browser out, until Ctrl-C.

use std::sync::atomic::Ordering;
use std::time::Duration;

use foveate_view::View;

use crate::args::ViewArgs;
use crate::error::CliError;
use crate::{interrupt, output};

/// Between two looks at what there is to say.
const LOOK: Duration = Duration::from_millis(50);

pub(crate) fn run(args: &ViewArgs) -> Result<(), CliError> {
    let interrupted = interrupt::flag()?;
    let view = View::open(args.options()?)?;
    output::text(&format!("{}\n", view.link()))?;
    while !interrupted.load(Ordering::Relaxed) {
        for text in view.news() {
            eprintln!("foveate: {text}");
        }
        std::thread::sleep(LOOK);
    }
    Err(CliError::Stopped { done: format!("{} frames", view.frames()) })
}
