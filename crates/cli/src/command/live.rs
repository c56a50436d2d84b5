// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate live`: a page with a camera in the browser, until Ctrl-C.

use foveate_staging::write_file;
use foveate_view::{Player, camera_page};

use crate::args::{LiveArgs, warn_of};
use crate::error::CliError;
use crate::serving::Serving;

pub(crate) fn run(args: &LiveArgs) -> Result<(), CliError> {
    if let Some(file) = &args.page {
        return Ok(write_file(file, camera_page(None).as_bytes())?);
    }
    let serving = Serving::begin()?;
    let options = args.options()?;
    warn_of(&options.inputs, &options.input);
    let player = Player::open(options)?;
    serving.until_stopped(&player.link(), || player.news(), || player.frames())
}
