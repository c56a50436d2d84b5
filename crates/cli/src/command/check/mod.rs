// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate check`: the derived card of a design.

mod array;
mod card;
mod text;

use self::array::Proposal;
use self::card::Card;
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
    let propose = |rate| Proposal::of(&design, rate, args.clock);
    let card = Card::of(&design, args.clock, args.min_fps.map(propose).transpose()?);
    if args.json {
        output::json(&card)?;
    } else if !args.quiet {
        output::text(&text(&design, &card))?;
    }
    match card.proposal {
        Some(proposal) if !proposal.reached => Err(CliError::Failed(proposal.text)),
        Some(_) | None => Ok(()),
    }
}
