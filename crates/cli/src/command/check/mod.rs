// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate check`: the card with the values that follow from a configuration.

mod array;
mod card;
mod clip;
mod text;

use self::card::DesignCard;
use self::text::text;
use crate::args::{CheckArgs, DesignArgs};
use crate::error::CliError;
use crate::output;

pub(crate) fn run(args: &CheckArgs) -> Result<(), CliError> {
    let source = DesignArgs {
        config: args.file.clone().or_else(|| args.design.config.clone()),
        preset: args.design.preset.clone(),
        overrides: args.design.overrides.clone(),
    };
    check_quiet(args)?;
    let (design, load) = match &args.clip {
        None => (source.design()?, None),
        Some(clip) => {
            let (design, load) = clip::measure(args, &source, clip)?;
            (design, Some(load))
        }
    };
    let card = DesignCard::from_design(&design, args.clock, args.min_fps, load)?;
    output::print_result((args.json, args.quiet), &card, || text(&design, &card))?;
    let rate = card.proposal.filter(|proposal| !proposal.reached).map(|proposal| proposal.text);
    let failures = rate.into_iter().chain(card.clip.iter().flat_map(clip::failures));
    let failures: Vec<String> = failures.collect();
    if failures.is_empty() { Ok(()) } else { Err(CliError::Failed(failures.join("; "))) }
}

/// Refuses `--quiet` if there is something to check by the exit code, but no clock to check it at.
fn check_quiet(args: &CheckArgs) -> Result<(), CliError> {
    let checked = match (&args.min_fps, &args.clip) {
        (Some(_), _) => "--min-fps is reached",
        (None, Some(_)) => "the design keeps up with --clip",
        (None, None) => return Ok(()),
    };
    if args.quiet && args.clock.is_none() {
        return Err(CliError::Usage(format!(
            "--quiet tells by the exit code whether {checked}, and this needs a clock; give \
             --clock, or leave --quiet out to see which clock is needed"
        )));
    }
    Ok(())
}
