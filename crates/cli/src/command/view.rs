// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate view`: packets in, a page in the browser out, until Ctrl-C.

use foveate_boards::view::View;

use crate::args::ViewArgs;
use crate::error::CliError;
use crate::serving::ServingCommand;

pub(crate) fn run(args: &ViewArgs) -> Result<(), CliError> {
    let serving = ServingCommand::new()?;
    let view = View::open(args.options()?)?;
    serving.run_until_stopped(view.link(), || view.take_messages(), || view.frames_shown())
}
