// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate --place-and-route`: the clock that a design reaches on a device.

use foveate_emit::Top;
use foveate_estimate::{RouteJob, place_and_route, render_routes_markdown, render_routes_text};

use super::flow::Flow;
use crate::args::{EstimateArgs, Level};
use crate::error::CliError;
use crate::output;
use crate::progress::Progress;

pub(super) fn run(args: &EstimateArgs, flow: &Flow) -> Result<(), CliError> {
    let design = args.design.design()?;
    let top = match args.level {
        Level::Rpu => Top::Rpu,
        Level::Rcm => Top::Rcm,
    };
    let job = RouteJob::of(&design, top, args.seeds, args.portable);
    let progress = Progress::new(args.quiet);
    progress.work("placing and routing with nextpnr");
    let report = place_and_route(&flow.toolchain, &flow.cache, &job, &args.place_and_route);
    progress.finish();
    let report = report?;
    if args.json {
        output::json(&report)?;
    } else if args.markdown {
        output::text(&render_routes_markdown(&report))?;
    } else {
        output::text(&render_routes_text(&report, output::width()))?;
    }
    match report.misfits().as_slice() {
        [] => Ok(()),
        misfits => Err(CliError::Failed(misfits.join("; "))),
    }
}
