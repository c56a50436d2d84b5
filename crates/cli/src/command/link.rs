// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate link`: a comparison of what a camera sends over a link with codecs at equal quality.

use foveate_explore::link::{LINK_FOLDER, LinkRequest, compare};
use foveate_media::ImageRelation;

use crate::args::{LinkArgs, check_output, warn_about_inputs};
use crate::error::CliError;
use crate::progress::RunTerminal;
use crate::{interrupt, output};

pub(crate) fn run(args: &LinkArgs) -> Result<(), CliError> {
    check_output(&args.output, LINK_FOLDER, args.force, &args.inputs)?;
    let config = args.design.config()?;
    let input = args.input.options(ImageRelation::Clip);
    let mut codecs = Vec::new();
    for codec in args.codecs.iter().map(|choice| choice.0) {
        if !codecs.contains(&codec) {
            codecs.push(codec);
        }
    }
    let request = LinkRequest {
        inputs: &args.inputs,
        input: &input,
        config: &config,
        codecs: &codecs,
        preset: args.effort.effort(),
        link_bits_per_second: args.link.0,
        clock_hz: args.clock.map(|clock| clock.0),
    };
    warn_about_inputs(&args.inputs, &input);
    let hooks = RunTerminal::new(args.quiet)?;
    let report = compare(&request, &interrupt::toolchain()?, &args.output, args.force, &hooks);
    hooks.progress.finish();
    let report = report?;
    output::print_result((args.json, args.quiet), &report, || report.markdown())?;
    let problems = report.problems();
    if problems.is_empty() {
        return Ok(());
    }
    let place = args.output.display();
    Err(CliError::Failed(format!("`{place}` is not complete: {}", problems.join("; "))))
}
