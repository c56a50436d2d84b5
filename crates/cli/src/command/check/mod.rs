// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate check`: the card with the values that follow from a configuration.

mod array;
mod card;
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
    let design = source.design()?;
    if args.quiet && args.min_fps.is_some() && args.clock.is_none() {
        return Err(CliError::Usage(
            "--quiet tells by the exit code whether --min-fps is reached, and this needs a clock; \
             give --clock, or leave --quiet out to see which clock is needed"
                .to_owned(),
        ));
    }
    let card = DesignCard::from_design(&design, args.clock, args.min_fps)?;
    if args.json {
        output::print_json(&card)?;
    } else if !args.quiet {
        output::print_text(&text(&design, &card))?;
    }
    match card.proposal {
        Some(proposal) if !proposal.reached => Err(CliError::Failed(proposal.text)),
        Some(_) | None => Ok(()),
    }
}
