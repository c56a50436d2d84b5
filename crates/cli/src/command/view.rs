// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate view`: packets in, a page in the browser out, until Ctrl-C.

use foveate_view::View;

use crate::args::ViewArgs;
use crate::error::CliError;
use crate::serving::Serving;

pub(crate) fn run(args: &ViewArgs) -> Result<(), CliError> {
    let serving = Serving::begin()?;
    let view = View::open(args.options()?)?;
    serving.until_stopped(view.link(), || view.news(), || view.frames())
}
