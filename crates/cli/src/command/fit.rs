// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate fit`: the cheapest design that a scene needs.

use std::fmt::Write as _;

use foveate_estimate::ramb36;
use foveate_explore::{
    AgreementEstimate, ConstraintCheck, ExploreError, FidelityFigures, FitRequest, FitResult,
    FittedDesign, FittedNetwork, ProcessEnergy, ProcessFigures, fit,
};
use foveate_inference::NoiseAgreement;
use foveate_media::{ImageRelation, PlaybackError};
use foveate_tools::{check_file, write_file};

use crate::agreement_text::{grey_levels, interval_text, noise_text};
use crate::args::{FitArgs, warn_about_inputs};
use crate::error::CliError;
use crate::output;
use crate::progress::RunTerminal;

pub(crate) fn run(args: &FitArgs) -> Result<(), CliError> {
    if let Some(file) = &args.output {
        check_file(file)?;
    }
    let cheapest = args.cheapest()?;
    let task = args.design.config()?;
    let input = args.input.options(ImageRelation::Clip);
    warn_about_inputs(&args.inputs, &input);
    let terminal = RunTerminal::new(args.quiet)?;
    let process = terminal.process(&args.process)?;
    let synthesizer = terminal.synthesizer()?;
    let vision_options = args.network.vision.options();
    let network = args.network.goal(&vision_options);
    let request = FitRequest {
        task: &task,
        inputs: &args.inputs,
        input: &input,
        disturbance: args.disturb,
        constraints: &args.constraints.constraints(network.is_some()),
        clock_hz: args.constraints.clock.map(|clock| clock.0),
        target_active: args.constraints.target_active,
        boxes: &args.boxes,
        cheapest,
        process: process.as_ref(),
        network,
        synthesizer: &synthesizer,
        max_designs: usize::try_from(args.max_syntheses).unwrap_or(usize::MAX),
    };
    let found = fit(&request, &terminal);
    terminal.progress.finish();
    let found = match found {
        Err(ExploreError::Playback(PlaybackError::Interrupted)) => {
            return Err(CliError::Stopped { done: "some of the designs".to_owned() });
        }
        other => other?,
    };
    if let Some(file) = &args.output {
        write_file(file, found.design.toml.as_bytes())?;
    }
    output::print_result((args.json, false), &found, || text(args, &found, output::text_width()))?;
    check_result(&found)
}

/// Fails, with exit code 1, if the input was not read completely, if no design meets all limits, or
/// if the second half of the clips does not confirm the design.
fn check_result(found: &FitResult) -> Result<(), CliError> {
    if !found.problems.is_empty() {
        return Err(CliError::Failed(format!(
            "not all of the input was read: {}",
            found.problems.join("; ")
        )));
    }
    if !found.feasible {
        return Err(CliError::Failed("no design meets all limits".to_owned()));
    }
    if !found.borne_out {
        let broken = found.design.held_out_held.iter().filter(|check| !check.holds);
        let broken: Vec<String> = broken.map(ConstraintCheck::text).collect();
        return Err(CliError::Failed(format!(
            "the second half of the clips does not confirm the design: {}",
            broken.join(", ")
        )));
    }
    Ok(())
}

fn text(args: &FitArgs, found: &FitResult, width: usize) -> String {
    let mut text = String::new();
    let design = &found.design;
    let (cameras, designs, left_out) = found.considered;
    let (first, second) = found.frames;
    let _ = writeln!(
        text,
        "{cameras} candidate cameras, {designs} designs synthesized, {left_out} less promising ones skipped; fitted on {first} frames, {second} held out."
    );
    if let Some(target) = &found.target {
        let _ = writeln!(
            text,
            "Thresholds for {:.1} % active: {:.1} % on the first half.",
            target.wanted * 100.0,
            target.found * 100.0
        );
    }
    let heading = if found.feasible { "Cheapest" } else { "No design meets all limits; nearest" };
    text.push('\n');
    text += &output::paragraph(&format!("{heading}: {}", design.summary), width);
    let (unit, array) = (&design.silicon.unit, &design.silicon.array);
    let silicon = format!(
        "{} of {} LUTs ({} of them memory) and {} flip-flops; the array {} LUTs, {} flip-flops, {} RAMB36; \
         {} clocks per frame, {}",
        unit_count_text(design),
        unit.lut_total_packed,
        unit.lut_memory_packed,
        unit.ff,
        array.lut_total_packed,
        array.ff,
        ramb36(array.bram18),
        design.clocks_per_frame,
        design.speed.map_or_else(|| "no estimated clock".to_owned(), |speed| speed.text()),
    );
    text += &output::paragraph(&silicon, width);
    if let Some(process) = &design.process {
        let line = process_text(design, process);
        text += &output::paragraph(&line, width);
    }
    let halves = [
        ("fitted", &design.fitted, &design.fitted_held),
        ("held out", &design.held_out, &design.held_out_held),
    ];
    for (name, figures, checks) in halves {
        text.push('\n');
        text += &output::paragraph(&format!("{name}: {}", figures_text(figures)), width);
        for check in checks {
            let sign = if check.holds { "ok  " } else { "NOT " };
            let _ = writeln!(text, "  {sign}{}", check.text());
        }
    }
    if let Some(network) = &found.network {
        text.push('\n');
        for line in agreement_lines(network, design) {
            text += &output::paragraph(&line, width);
        }
    }
    if !found.binding.is_empty() {
        let options: Vec<String> = found.binding.iter().map(|name| format!("--{name}")).collect();
        let line =
            format!("Binding: without {}, a design would meet all limits.", options.join(" or "));
        text.push('\n');
        text += &output::paragraph(&line, width);
    }
    if !found.feasible && found.binding.is_empty() {
        text += "\nNo single limit is binding: every design exceeds more than one.\n";
    }
    text += "\nWhy:\n";
    for line in &found.why {
        text += &output::paragraph(&format!("- {line}"), width);
    }
    match &args.output {
        Some(file) => {
            let _ = writeln!(
                text,
                "\nThe design is in {}. To build it: foveate generate --config {0} -o core",
                file.display()
            );
        }
        None => {
            let _ =
                writeln!(text, "\nIts configuration (--output FILE writes it):\n\n{}", design.toml);
        }
    }
    text
}

/// Returns the lines about the agreement of the network's outputs.
fn agreement_lines(network: &FittedNetwork, design: &FittedDesign) -> Vec<String> {
    let (fitted, held_out) = design.bytes_per_frame;
    let parts = [
        ("fitted", network.fitted, Some(fitted)),
        ("confirmed later in this half", network.confirmed, None),
        ("held out", network.held_out, Some(held_out)),
    ];
    let part = |(name, agreed, bytes): (&str, AgreementEstimate, Option<f64>)| {
        let found = agreed.detections.map_or_else(String::new, |found| {
            format!(
                ": {:.1} % of {} detections kept, {:.1} % of {} right",
                100.0 * found.kept_share(),
                found.whole,
                100.0 * found.precision(),
                found.seen
            )
        });
        let bytes = bytes.map_or_else(String::new, |bytes| {
            let share = 100.0 * bytes / network.bytes_per_whole_frame;
            format!("; {bytes:.0} bytes per frame, {share:.1} % of a whole one")
        });
        let (model, frames, share) = (&network.network, agreed.frames, 100.0 * agreed.share);
        let interval = interval_text(&agreed.intervals);
        format!("{model} ({name}, {frames} frames): agreement {share:.1} %{interval}{found}{bytes}")
    };
    let noisy = |noisy: &NoiseAgreement| {
        let (model, level) = (&network.network, grey_levels(noisy.levels));
        let (frames, shares) = (noisy.frames, noise_text(noisy));
        format!(
            "{model}, noise of {level} on the whole frames (held out, {frames} frames): {shares}"
        )
    };
    parts.map(part).into_iter().chain(network.noise.iter().map(noisy)).collect()
}

/// Returns the number of RPUs or lanes, with their name.
fn unit_count_text(design: &FittedDesign) -> String {
    let name = design.config.hardware.organization.kind().unit_name();
    let plural = if design.silicon.units == 1 { "" } else { "s" };
    format!("{} {name}{plural}", design.silicon.units)
}

/// Returns the cost of a design in the cells of a process.
fn process_text(design: &FittedDesign, process: &ProcessFigures) -> String {
    let name = design.config.hardware.organization.kind().unit_name();
    let area = match process.mm2 {
        Some(mm2) => format!("{mm2:.3} mm2"),
        None => {
            let bits = process.memory_bits_without_macro;
            format!("no area of the array, because no macro fits {bits} bits of memory")
        }
    };
    let (library, unit, clock) = (&process.library, process.unit_um2, process.clock_mhz);
    let mut text =
        format!("in {library}: {area}, {unit:.0} um2 per {name}, at most {clock:.1} MHz");
    match &process.energy {
        None => text += ", energy not measured, because memories are not flip-flops",
        Some(ProcessEnergy { frame_rate, nj_per_region, usual_mw, busiest_mw }) => {
            let _ = write!(
                text,
                ", {usual_mw:.4} mW at {frame_rate} frames/s ({busiest_mw:.4} in the busiest stretch), \
                 {nj_per_region:.3} nJ per region and frame"
            );
        }
    }
    if let Some(energy) = &design.held_out_energy {
        let ProcessEnergy { usual_mw, busiest_mw, .. } = energy;
        let _ = write!(text, "; held out {usual_mw:.4} mW ({busiest_mw:.4})");
    }
    text + ". Wires and the clock tree are not included, so areas and powers are lower bounds, and the clock is an upper bound."
}

fn figures_text(figures: &FidelityFigures) -> String {
    let psnr =
        figures.psnr_ideal.map_or_else(|| "identical".to_owned(), |psnr| format!("{psnr:.1} dB"));
    format!(
        "{:.2} % flips, {:.2} % missed, {:.2} % false alarms, {:.2} % of the relevant regions stale; {:.1} % active (ideal {:.1} %), IoU {:.3}, PSNR {psnr} and SSIM {:.3} to the ideal screen",
        figures.action_flips * 100.0,
        figures.missed * 100.0,
        figures.false_alarms * 100.0,
        figures.stale_regions * 100.0,
        figures.active * 100.0,
        figures.ideal_active * 100.0,
        figures.active_iou,
        figures.ssim_ideal,
    )
}
