// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate --liberty`: area, timing, leakage and energy of a design in the cells of a
//! process.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use foveate_cosim::{EnergyJob, EnergyReport, measure_energy};
use foveate_estimate::{SiliconJob, SiliconReport, gate_netlist, map_to_silicon};
use foveate_media::InputOptions;
use foveate_output::report::Report;
use foveate_tools::{check_file, write_file};
use serde::Serialize;

use super::synthesis::SynthesisTools;
use crate::args::{EstimateArgs, warn_about_inputs};
use crate::error::CliError;
use crate::interrupt;
use crate::liberty::{read_library, read_macros};
use crate::output;
use crate::progress::Progress;

pub(super) fn run(args: &EstimateArgs, flow: &SynthesisTools) -> Result<(), CliError> {
    if args.clock.is_some() && args.activity.is_none() {
        let message = "--clock with --liberty is for the power of --activity; the clock of a report on area is measured";
        return Err(CliError::Usage(message.to_owned()));
    }
    let cancel = flow.toolchain.cancel_flag();
    let energy = args.activity.as_deref().map(|clip| open_clip(args, clip, cancel)).transpose()?;
    let design = match &energy {
        Some(energy) => energy.design().clone(),
        None => args.design.design()?,
    };
    let job = SiliconJob::for_design(&design, args.memory_limit);
    let job = if args.modules || args.json { job.with_leaves(&design) } else { job };
    let libraries = args.liberty.iter().map(|path| read_library(path));
    let libraries: Vec<_> = libraries.collect::<Result<_, _>>()?;
    if args.netlist.is_some() && libraries.len() > 1 {
        let message = "--netlist is for one library; give --liberty once";
        return Err(CliError::Usage(message.to_owned()));
    }
    let macros = read_macros(&args.macros)?;
    if let Some(path) = &args.netlist {
        check_file(path)?;
    }
    let progress = Progress::new(args.quiet);
    if let (Some(path), [library]) = (&args.netlist, libraries.as_slice()) {
        progress.report_work("mapping with Yosys");
        let netlist = gate_netlist(&flow.toolchain, &flow.cache, &job, library);
        progress.finish();
        write_file(path, netlist?.as_bytes())?;
    }
    let mut reports = Vec::new();
    for library in &libraries {
        progress.report_work("mapping with Yosys, timing with OpenSTA");
        let inputs = (library, macros.as_slice());
        let report = map_to_silicon(&flow.toolchain, &flow.cache, &job, inputs);
        progress.finish();
        let silicon = report?;
        let energy = match &energy {
            None => None,
            Some(job) => {
                progress.report_work("simulating gates");
                let clock = args.clock.map_or(silicon.path.mhz, f64::from);
                let inputs = (library, &silicon, clock);
                let report = measure_energy(&flow.toolchain, &flow.cache, job, inputs);
                progress.finish();
                Some(report?)
            }
        };
        reports.push(ProcessReport { silicon, energy });
    }
    print_reports(args, &reports)
}

/// The report of a design in one process.
#[derive(Serialize)]
struct ProcessReport {
    #[serde(flatten)]
    silicon: SiliconReport,
    #[serde(skip_serializing_if = "Option::is_none")]
    energy: Option<EnergyReport>,
}

fn open_clip(args: &EstimateArgs, clip: &Path, cancel: &AtomicBool) -> Result<EnergyJob, CliError> {
    let progress = Progress::new(args.quiet);
    progress.report_work("playing the clip");
    let options = InputOptions {
        frames: Some(args.max_frames),
        interrupt: interrupt::stop_request(),
        ..InputOptions::default()
    };
    warn_about_inputs(&[clip], &options);
    let job = EnergyJob::open(clip, &args.design.config()?, &options, f64::from(args.fps), cancel);
    progress.finish();
    Ok(job?)
}

fn print_reports(args: &EstimateArgs, reports: &[ProcessReport]) -> Result<(), CliError> {
    let of_process = |ProcessReport { silicon, energy }: &ProcessReport| {
        let energy = energy.as_ref().map(EnergyReport::tables);
        std::iter::once(silicon.tables()).chain(energy).flat_map(|report| report.0)
    };
    let tables = Report(reports.iter().flat_map(of_process).collect());
    let form = (args.json, args.markdown);
    match reports {
        [report] => output::print_report(form, report, &tables),
        reports => output::print_report(form, &reports, &tables),
    }
}
