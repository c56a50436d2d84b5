// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate`: area and logic levels from Yosys next to the paper's table, or the clock of
//! a placed design.

mod compare;
mod route;
mod silicon;
mod synthesis;

use foveate_tools::Cache;

use crate::args::EstimateArgs;
use crate::error::CliError;
use crate::progress::Progress;
use crate::{interrupt, output};
use synthesis::SynthesisTools;

pub(crate) fn run(args: &EstimateArgs) -> Result<(), CliError> {
    let flow = SynthesisTools { toolchain: interrupt::toolchain()?, cache: Cache::from_env()? };
    if !args.liberty.is_empty() {
        silicon::run(args, &flow)
    } else if args.compare {
        compare::run(args, &flow)
    } else if args.place_and_route.is_empty() {
        estimate_one(args, &flow)
    } else {
        route::run(args, &flow)
    }
}

fn estimate_one(args: &EstimateArgs, flow: &SynthesisTools) -> Result<(), CliError> {
    let design = args.design.design()?;
    let progress = Progress::new(args.quiet);
    progress.report_work("synthesizing with Yosys");
    let report = flow.estimate(&design, args.modules || args.json);
    progress.finish();
    let report = report?.with_clock(args.clock.map(f64::from));
    output::print_report((args.json, args.markdown), &report, &report.tables())
}
