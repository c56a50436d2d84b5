// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate --liberty`: area, timing and leakage of a design in the cells of a process.

use std::path::Path;

use foveate_estimate::{
    LibertyLibrary, SiliconJob, SiliconReport, gate_netlist, map_to_silicon,
    render_silicon_markdown, render_silicon_text,
};
use foveate_staging::{check_file, write_file};

use super::synthesis::SynthesisTools;
use crate::args::{DEFAULT_LIBERTY, EstimateArgs};
use crate::error::CliError;
use crate::output;
use crate::progress::Progress;

pub(super) fn run(args: &EstimateArgs, flow: &SynthesisTools) -> Result<(), CliError> {
    let design = args.design.design()?;
    let job = SiliconJob::for_design(&design, args.memory_limit);
    let libraries = args.liberty.iter().map(|path| read_library(path));
    let libraries: Vec<_> = libraries.collect::<Result<_, _>>()?;
    if args.netlist.is_some() && libraries.len() > 1 {
        let message = "--netlist is for one library; give --liberty once";
        return Err(CliError::Usage(message.to_owned()));
    }
    let macros = args.macros.iter().map(|path| LibertyLibrary::read(path));
    let macros: Vec<_> = macros.collect::<Result<_, _>>()?;
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
        reports.push(report?);
    }
    print_reports(args, &reports)
}

fn print_reports(args: &EstimateArgs, reports: &[SiliconReport]) -> Result<(), CliError> {
    if args.json {
        return match reports {
            [report] => output::print_json(report),
            reports => output::print_json(&reports),
        };
    }
    let render = |report| match args.markdown {
        true => render_silicon_markdown(report),
        false => render_silicon_text(report, output::text_width()),
    };
    output::print_text(&reports.iter().map(render).collect::<Vec<_>>().join("\n"))
}

/// Reads a library. A missing file of the default library is explained.
fn read_library(path: &Path) -> Result<LibertyLibrary, CliError> {
    if path == Path::new(DEFAULT_LIBERTY) && !path.exists() {
        return Err(CliError::Usage(format!(
            "there is no `{DEFAULT_LIBERTY}`; `apt-get install qflow-tech-osu018` has it, or name the liberty \
             file of another process"
        )));
    }
    Ok(LibertyLibrary::read(path)?)
}
