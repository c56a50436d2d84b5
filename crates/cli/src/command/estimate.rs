// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate`: area and logic levels from Yosys beside the paper's table.

mod compare;

use foveate_design::Design;
use foveate_emit::Top;
use foveate_estimate::{EstimateJob, Report, estimate, render_markdown, render_text};
use foveate_toolchain::{Cache, Toolchain};

use crate::args::EstimateArgs;
use crate::error::CliError;
use crate::progress::Progress;
use crate::{interrupt, output};

pub(crate) fn run(args: &EstimateArgs) -> Result<(), CliError> {
    let flow = Flow { toolchain: interrupt::toolchain()?, cache: Cache::from_env()? };
    if args.compare { compare::run(args, &flow) } else { one(args, &flow) }
}

/// What every synthesis needs.
struct Flow {
    toolchain: Toolchain,
    cache: Cache,
}

impl Flow {
    fn estimate(&self, design: &Design, leaves: bool) -> Result<Report, CliError> {
        let job = EstimateJob {
            leaves_of: leaves.then(|| design.unit().split.to_owned()),
            ..EstimateJob::of(design, Top::Rcm)
        };
        Ok(estimate(&self.toolchain, &self.cache, &job)?)
    }
}

fn one(args: &EstimateArgs, flow: &Flow) -> Result<(), CliError> {
    let design = args.design.design()?;
    let progress = Progress::new(args.quiet);
    progress.work("synthesizing with Yosys");
    let report = flow.estimate(&design, true);
    progress.finish();
    let report = report?;
    if args.json {
        output::json(&report)
    } else if args.markdown {
        output::text(&render_markdown(&report))
    } else {
        output::text(&render_text(&report, output::width()))
    }
}
