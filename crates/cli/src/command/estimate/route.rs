// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate --place-and-route`: the clock that a design reaches on a device.

use super::synthesis::SynthesisTools;
use crate::args::{DesignPart, EstimateArgs};
use crate::error::CliError;
use crate::output;
use crate::progress::Progress;
use foveate_design::Design;
use foveate_emit::Top;
use foveate_estimate::{RouteJob, place_and_route};

const NOT_ON_AXI: &str = "--level axi is for a core on AXI; this design has hardware.interface = \"ports\", so set it to \"axi\"";

pub(super) fn run(args: &EstimateArgs, flow: &SynthesisTools) -> Result<(), CliError> {
    let design = args.design.design()?;
    let job = route_job(args, &design)?;
    let progress = Progress::new(args.quiet);
    progress.report_work("placing and routing with nextpnr");
    let report = place_and_route(&flow.toolchain, &flow.cache, &job, &args.place_and_route);
    progress.finish();
    let report = report?;
    output::print_report((args.json, args.markdown), &report, &report.table())?;
    match report.shortage_sentences().as_slice() {
        [] => Ok(()),
        misfits => Err(CliError::Failed(misfits.join("; "))),
    }
}

/// Returns the job to place. Without `--level` it is the core on AXI if the design is one, and one
/// RPU otherwise.
fn route_job(args: &EstimateArgs, design: &Design) -> Result<RouteJob, CliError> {
    let of = |top| RouteJob::of(design, top, args.seeds, args.portable);
    let on_bus = || RouteJob::for_axi_core(design, args.seeds, args.portable);
    match args.level {
        None => Ok(on_bus().unwrap_or_else(|| of(Top::Rpu))),
        Some(DesignPart::Rpu) => Ok(of(Top::Rpu)),
        Some(DesignPart::Rcm) => Ok(of(Top::Rcm)),
        Some(DesignPart::Axi) => on_bus().ok_or_else(|| CliError::Usage(NOT_ON_AXI.to_owned())),
    }
}
