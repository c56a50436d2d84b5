// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate live`: a page with a camera in the browser, until Ctrl-C.

use foveate_boards::view::{Player, camera_page};
use foveate_tools::write_file;

use crate::args::{LiveArgs, refuse_several_clips, warn_about_inputs};
use crate::error::CliError;
use crate::serving::ServingCommand;

pub(crate) fn run(args: &LiveArgs) -> Result<(), CliError> {
    if let Some(file) = &args.page {
        return Ok(write_file(file, camera_page(None).as_bytes())?);
    }
    let serving = ServingCommand::new()?;
    let options = args.options()?;
    refuse_several_clips(&options.inputs, &options.input)?;
    warn_about_inputs(&options.inputs, &options.input);
    let player = Player::open(options)?;
    serving.run_until_stopped(&player.link(), || player.take_messages(), || player.frames_decoded())
}
