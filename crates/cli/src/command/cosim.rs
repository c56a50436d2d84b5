// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate cosim`: comparison of model and RTL, every output at every clock.

mod end_to_end;
mod plan;
mod text;

use foveate_cosim::{
    CosimError, CosimLevel, CosimProgress, CosimReport, CosimSummary, CosimVerdict, REPLAY,
    Simulator, UnreachedVerilog, junit_error, junit_xml, unelaborated_variants,
    unsimulated_modules,
};
use foveate_emit::AXI_TOP;
use foveate_tools::{Cache, StagedFolder, Toolchain, check_file, write_file};
use serde::Serialize;

use crate::args::CosimArgs;
use crate::error::CliError;
use crate::progress::Progress as Shown;
use crate::{interrupt, notice, output};
use end_to_end::{EndToEndFolder, EndToEndReport};
use plan::{CosimPlan, PlannedCosim};

/// All results that the command prints.
#[derive(Serialize)]
struct CosimOutput<'a> {
    #[serde(flatten)]
    summary: &'a CosimSummary,
    #[serde(skip_serializing_if = "Option::is_none")]
    end_to_end: Option<EndToEndReport>,
}

pub(crate) fn run(args: &CosimArgs) -> Result<(), CliError> {
    check_output_paths(args)?;
    let mut plan = plan::plan(args)?;
    let trip = args.end_to_end.as_deref().map(EndToEndFolder::create).transpose()?;
    if let Some(trip) = &trip {
        plan.keep_packets(&trip.packets());
    }
    let (toolchain, cache) = (interrupt::toolchain()?, Cache::from_env()?);
    let summary = run_all(args, plan, &toolchain, &cache).map_err(|error| match &trip {
        Some(trip) => trip.with_final_path(error),
        None => error,
    })?;
    let written = write_junit(args, &junit_xml(&summary));
    let passed = summary.verdict() == CosimVerdict::Passed;
    let compared = trip.as_ref().filter(|_| passed);
    let compared = compared.map(|trip| end_to_end::compare(args, trip)).transpose();
    trip.map_or(Ok(()), EndToEndFolder::commit)?;
    let end_to_end = compared?;
    let is_received = end_to_end.as_ref().is_none_or(EndToEndReport::agrees);
    print_output(args, &CosimOutput { summary: &summary, end_to_end })?;
    let complaint = match summary.verdict() {
        CosimVerdict::Passed if is_received => return written,
        CosimVerdict::Passed => {
            "the frames that `decode` makes of the packets differ from the results of `simulate`"
                .to_owned()
        }
        CosimVerdict::Mismatch => "model and RTL do not agree".to_owned(),
        CosimVerdict::Incomplete => incompleteness_message(&summary),
    };
    if let Err(error) = written {
        notice::print_notice(&error);
    }
    Err(CliError::Failed(complaint))
}

/// Fails if a file or folder cannot be written. This is checked before inputs are read.
fn check_output_paths(args: &CosimArgs) -> Result<(), CliError> {
    for file in [&args.junit, &args.packets].into_iter().flatten() {
        check_file(file)?;
    }
    StagedFolder::check(&args.replay, REPLAY, true)?;
    args.end_to_end.as_deref().map_or(Ok(()), EndToEndFolder::check)
}

/// Returns the message about what was not simulated, and the options that help.
fn incompleteness_message(summary: &CosimSummary) -> String {
    let missing = summary.situations.missing();
    if !missing.is_empty() {
        return format!(
            "no mismatch, but the vectors did not reach every situation: {}. Try more --rounds, \
             another --seed, or thresholds that frames can meet.",
            missing.join("; ")
        );
    }
    let mut text = format!(
        "no mismatch, but not all of the Verilog was simulated: {}.",
        summary.describe_unreached()
    );
    if !summary.not_simulated.is_empty() {
        text.push_str(
            " Foveate simulates `rpu`, `rcm` and, in Verilator, `rcm_axi` with the modules that they instantiate; remove \
             other files from the folder, or choose one of the tops with --level.",
        );
    }
    if !summary.not_elaborated.is_empty() {
        text.push_str(
            " Only a run with --full has these modules with these parameter values; --level simulates a part.",
        );
    }
    text
}

/// Runs the co-simulations one after the other, up to the first with a mismatch.
fn run_all(
    args: &CosimArgs,
    mut plan: CosimPlan,
    toolchain: &Toolchain,
    cache: &Cache,
) -> Result<CosimSummary, CliError> {
    let works = std::mem::take(&mut plan.jobs);
    let (levels, has_axi) = simulated_levels(&works);
    let (mut reports, mut left) = (Vec::new(), works.into_iter());
    for mut work in left.by_ref() {
        let report = run_one(args, &mut work, toolchain, cache);
        let report = report_error_to_ci(args, &work.name(), report)?;
        let passed = report.passed();
        reports.push(report);
        if !passed {
            break;
        }
    }
    // Each run has replaced the waves of the run before it.
    let earlier = reports.len().saturating_sub(1);
    reports.iter_mut().take(earlier).for_each(|report| report.waves = None);
    let names = left.map(|work| work.name()).collect();
    let agree = reports.iter().all(CosimReport::passed);
    let left_out = left_out_parts(args, &plan, (&levels, has_axi), agree, toolchain);
    let left_out = report_error_to_ci(args, "parts left out", left_out)?;
    Ok(CosimSummary::new(
        plan.design.fingerprint(),
        reports,
        names,
        left_out,
        plan::is_whole_folder(args),
    ))
}

/// Returns the levels at which arrays are simulated, and true if the core on AXI is simulated.
fn simulated_levels(works: &[PlannedCosim]) -> (Vec<CosimLevel>, bool) {
    let levels = works.iter().filter_map(|work| match work {
        PlannedCosim::Array(job) => Some(job.stimulus.level),
        PlannedCosim::Axi(_) => None,
    });
    (levels.collect(), works.iter().any(|work| matches!(work, PlannedCosim::Axi(_))))
}

/// Returns `result`. An error is also written as JUnit XML, because a tool that failed leaves no
/// other result for the CI server.
fn report_error_to_ci<T>(
    args: &CosimArgs,
    name: &str,
    result: Result<T, CosimError>,
) -> Result<T, CosimError> {
    result.inspect_err(|error| {
        if let Err(second) = write_junit(args, &junit_error(name, &error.to_string())) {
            notice::print_notice(&second);
        }
    })
}

/// Returns the parts of the given Verilog that runs at these levels leave out. `agree` is true if
/// there is no mismatch; only then are variants of modules looked for.
fn left_out_parts(
    args: &CosimArgs,
    plan: &CosimPlan,
    (levels, has_axi): (&[CosimLevel], bool),
    agree: bool,
    toolchain: &Toolchain,
) -> Result<UnreachedVerilog, CosimError> {
    let CosimPlan { design, rtl: Some(sources), prefix, .. } = plan else {
        return Ok(UnreachedVerilog::default());
    };
    let mut tops: Vec<String> =
        levels.iter().map(|level| prefix.prefixed_name(level.top().module())).collect();
    tops.extend(has_axi.then(|| prefix.prefixed_name(AXI_TOP)));
    let tops: Vec<&str> = tops.iter().map(String::as_str).collect();
    let modules = unsimulated_modules(sources, &tops);
    // A user who chooses a part knows that the rest is left out.
    let variants = if agree && plan::is_whole_folder(args) {
        unelaborated_variants(design, sources, prefix, levels, toolchain)?
    } else {
        Vec::new()
    };
    Ok(UnreachedVerilog { modules, variants })
}

fn run_one(
    args: &CosimArgs,
    work: &mut PlannedCosim,
    toolchain: &Toolchain,
    cache: &Cache,
) -> Result<CosimReport, CosimError> {
    let shown = Shown::new(args.quiet);
    let progress = &mut |step| show_progress(&shown, step);
    let report = match work {
        PlannedCosim::Array(job) => {
            if args.netlist {
                shown.report_work("synthesizing with Yosys");
                job.netlist = Some(job.synthesize(toolchain, cache)?);
                job.simulator = Simulator::Iverilog;
            }
            job.run(toolchain, cache, progress)
        }
        PlannedCosim::Axi(job) => job.run(toolchain, cache, progress),
    };
    shown.finish();
    report
}

fn print_output(args: &CosimArgs, told: &CosimOutput<'_>) -> Result<(), CliError> {
    let passed = told.summary.verdict() == CosimVerdict::Passed
        && told.end_to_end.as_ref().is_none_or(EndToEndReport::agrees);
    let text = || text::summary_text(told, output::text_width());
    output::print_result((args.json, args.quiet && passed), told, text)
}

fn write_junit(args: &CosimArgs, xml: &str) -> Result<(), CliError> {
    args.junit.as_ref().map_or(Ok(()), |file| Ok(write_file(file, xml.as_bytes())?))
}

fn show_progress(shown: &Shown, step: CosimProgress) {
    match step {
        CosimProgress::Vectors { done, total } => shown.report_steps("vectors", done, total),
        CosimProgress::Simulation { clocks } => {
            shown.report_work(&format!("building and simulating {clocks} clocks"));
        }
    }
}
