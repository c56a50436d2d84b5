// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate`: area and logic levels from Yosys next to the paper's table, or the clock of
//! a placed design.

mod compare;
mod flow;
mod route;

use foveate_estimate::{render_markdown, render_text};
use foveate_toolchain::Cache;

use crate::args::EstimateArgs;
use crate::error::CliError;
use crate::progress::Progress;
use crate::{interrupt, output};
use flow::Flow;

pub(crate) fn run(args: &EstimateArgs) -> Result<(), CliError> {
    let flow = Flow { toolchain: interrupt::toolchain()?, cache: Cache::from_env()? };
    if args.compare {
        compare::run(args, &flow)
    } else if args.place_and_route.is_empty() {
        one(args, &flow)
    } else {
        route::run(args, &flow)
    }
}

fn one(args: &EstimateArgs, flow: &Flow) -> Result<(), CliError> {
    let design = args.design.design()?;
    let progress = Progress::new(args.quiet);
    progress.work("synthesizing with Yosys");
    let report = flow.estimate(&design, true);
    progress.finish();
    let report = report?.at(args.clock.map(f64::from));
    if args.json {
        output::json(&report)
    } else if args.markdown {
        output::text(&render_markdown(&report))
    } else {
        output::text(&render_text(&report, output::width()))
    }
}
