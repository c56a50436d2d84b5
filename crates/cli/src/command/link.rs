// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate link`: a comparison of what a camera sends over a link with codecs at equal quality.

use foveate_footage::ImagesAs;
use foveate_link::{LINK, Request, compare};
use foveate_staging::StagedFolder;

use super::simulate::Terminal;
use crate::args::{LinkArgs, warn_of};
use crate::error::CliError;
use crate::{interrupt, output};

pub(crate) fn run(args: &LinkArgs) -> Result<(), CliError> {
    StagedFolder::check(&args.output, LINK, args.force)?;
    let config = args.design.read()?;
    let input = args.input.options(ImagesAs::Clip);
    let mut codecs = Vec::new();
    for codec in args.codecs.iter().map(|choice| choice.0) {
        if !codecs.contains(&codec) {
            codecs.push(codec);
        }
    }
    let request = Request {
        inputs: &args.inputs,
        input: &input,
        config: &config,
        codecs: &codecs,
        effort: args.effort.effort(),
        link: args.link.0,
        clock_hz: args.clock.map(|clock| clock.0),
    };
    warn_of(&args.inputs, &input);
    let hooks = Terminal::new(args.quiet)?;
    let report = compare(&request, &interrupt::toolchain()?, &args.output, args.force, &hooks);
    hooks.shown.finish();
    let report = report?;
    match (args.json, args.quiet) {
        (true, _) => output::json(&report)?,
        (false, false) => output::text(&report.markdown())?,
        (false, true) => {}
    }
    let problems = report.problems();
    if problems.is_empty() {
        return Ok(());
    }
    let place = args.output.display();
    Err(CliError::Failed(format!("`{place}` is not complete: {}", problems.join("; "))))
}
