// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate live`: a page with a camera in the browser, until Ctrl-C.

use std::fs;
use std::sync::atomic::Ordering;
use std::time::Duration;

use foveate_view::{Player, camera_page};

use crate::args::{LiveArgs, warn_of};
use crate::error::CliError;
use crate::{interrupt, output};

/// Between two looks at what there is to say.
const LOOK: Duration = Duration::from_millis(50);

pub(crate) fn run(args: &LiveArgs) -> Result<(), CliError> {
    if let Some(file) = &args.page {
        return fs::write(file, camera_page(None)).map_err(CliError::io("write the page", file));
    }
    let interrupted = interrupt::flag()?;
    let options = args.options()?;
    warn_of(&options.inputs, &options.input);
    let player = Player::open(options)?;
    output::text(&format!("{}\n", player.link()))?;
    while !interrupted.load(Ordering::Relaxed) {
        for text in player.news() {
            eprintln!("foveate: {text}");
        }
        std::thread::sleep(LOOK);
    }
    Err(CliError::Stopped { done: format!("{} frames", player.frames()) })
}
