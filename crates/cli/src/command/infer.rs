// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate infer`: a network behind the camera, and the computations that the camera's masks save.

mod network;

use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::Path;

use foveate_inference::{
    ClipSummary, DetectionCounts, INFERENCE_FOLDER, Inference, InferenceOptions, InferenceSummary,
    TuningSummary, WholeFrameAgreement, is_array,
};
use foveate_media::{ImageRelation, input_without_secrets};
use indicatif::DecimalBytes;

use crate::agreement_text::{grey_levels, interval_text, noise_text};
use crate::args::{InferArgs, check_output, warn_about_inputs};
use crate::error::CliError;
use crate::progress::RunTerminal;
use crate::{notice, output};

pub(crate) fn run(args: &InferArgs, words: &[OsString]) -> Result<(), CliError> {
    match &args.output {
        None => network::run_check(args, words),
        Some(output) if args.inputs.iter().any(|input| is_array(input)) => {
            network::run_arrays(args, words, output)
        }
        Some(output) => run_clips(args, words, output),
    }
}

fn run_clips(args: &InferArgs, words: &[OsString], folder: &Path) -> Result<(), CliError> {
    check_output(folder, INFERENCE_FOLDER, args.force, &args.inputs)?;
    let (config, input) = (args.design.config()?, args.input.options(ImageRelation::Clip));
    warn_about_inputs(&args.inputs, &input);
    let footage = (&args.inputs[..], &args.boxes[..]);
    let inference = Inference::new(&config, &args.network, args.vision.options(), footage, &input)?;
    let options = InferenceOptions {
        computation: args.computation(),
        accelerator: args.accelerator()?,
        with_whole_computation: args.has_reference(),
        with_whole_frames: args.runs_on_whole_frames(),
        noise: args.noise_levels(),
        frame_interval: args.every,
        record: args.record_options(),
        command: command_words(words),
        overwrite: args.force,
    };
    let hooks = RunTerminal::new(args.quiet)?;
    let summary = inference.run(folder, &options, &hooks);
    hooks.progress.finish();
    let summary = summary?;
    summary.warnings.iter().for_each(|warning| notice::print_warning(warning));
    output::print_result((args.json, args.quiet), &summary, || text(folder, &summary))?;
    hooks.check_complete(folder, summary.problem)
}

/// Returns the words of the command line, for the page.
fn command_words(words: &[OsString]) -> Vec<String> {
    let words = words.iter().skip(1).map(|word| input_without_secrets(Path::new(word)));
    std::iter::once("foveate".to_owned()).chain(words).collect()
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

fn frames(count: u64, kind: &str) -> String {
    format!("{count} {kind}{}", if count == 1 { "frame" } else { "frames" })
}

/// Returns a line for each clip if there are several clips.
fn clip_lines(summary: &InferenceSummary) -> String {
    if summary.clips.len() == 1 {
        return String::new();
    }
    let line = |clip: &ClipSummary| {
        let result = if clip.counted_frames == 0 {
            "none of these counts".to_owned()
        } else {
            format!(
                "regions active {}, changed {}; MACs needed {}",
                percent(clip.active_share),
                percent(clip.changed_share),
                percent(clip.macs.needed_share())
            )
        };
        let problem = clip.problem.as_ref().map(|problem| format!(", NOT COMPLETE: {problem}"));
        format!(
            "  {}: {}, {result}{}\n",
            clip.name,
            frames(clip.frames, ""),
            problem.unwrap_or_default()
        )
    };
    summary.clips.iter().map(line).collect()
}

/// Returns the lines about the choice of limits, with the statement whether they hold.
fn tuning_lines(tuning: &TuningSummary, summary: &InferenceSummary) -> String {
    let (of, these) = if summary.is_tuned_on_clips() {
        let reported: Vec<&str> = summary.clips.iter().map(|clip| &clip.name[..]).collect();
        (format!("of {}", tuning.clips.join(", ")), reported.join(", "))
    } else {
        ("before these".to_owned(), "these frames".to_owned())
    };
    let held = if tuning.holds {
        format!("is reached on {these}, too")
    } else {
        format!("is missed on {these}")
    };
    let frozen = if tuning.frozen.holds {
        format!("           {}; try variation=10%\n", TuningSummary::FROZEN_OUTPUTS_NOTE)
    } else {
        String::new()
    };
    format!(
        "tuned      on {} {of}, in {} runs; there {} of the MACs were needed, {} without a limit\n\
         goal       {} {held}\n{frozen}",
        frames(tuning.frames, "counted "),
        tuning.runs,
        percent(tuning.chosen.needed_share),
        percent(tuning.exact.needed_share),
        tuning.goal
    )
}

fn text(folder: &Path, summary: &InferenceSummary) -> String {
    let mut text = format!(
        "{}: {}{} of {} x {} pixels, mode {}{}\n",
        folder.display(),
        frames(summary.frames, ""),
        // The usual values are left out: every frame, and layout nchw.
        if summary.every.get() == 1 {
            String::new()
        } else {
            format!(", one of {},", summary.every)
        },
        summary.width,
        summary.height,
        summary.mode,
        if summary.layout == "nchw" {
            String::new()
        } else {
            format!(", layout {}", summary.layout)
        }
    );
    if summary.counted_frames == 0 {
        return text + InferenceSummary::ONLY_FRAME_NOTE + "\n";
    }
    text.push_str(&clip_lines(summary));
    if let Some(tuning) = &summary.tuning {
        text.push_str(&tuning_lines(tuning, summary));
    }
    let _ = writeln!(
        text,
        "regions    active {}, changed {}",
        percent(summary.active_share),
        percent(summary.changed_share)
    );
    let _ = writeln!(
        text,
        "MACs       {:.1} M per frame; needed {}, computed {} (of a whole frame {})",
        summary.macs.whole_frame / 1e6,
        percent(summary.macs.needed_share()),
        percent(summary.macs.scheduled_share()),
        percent(summary.macs.whole_share())
    );
    let _ = writeln!(
        text,
        "memory     weights {}, kept tensors {}, masks {}",
        DecimalBytes(summary.weight_bytes),
        DecimalBytes(summary.kept_bytes),
        DecimalBytes(summary.mask_bytes)
    );
    let _ = writeln!(
        text,
        "traffic    tensors read {:.2} MB per frame, {:.2} MB of it unchanged (halo), and written {:.2} MB",
        summary.traffic.read_bytes / 1e6,
        summary.traffic.halo_bytes / 1e6,
        summary.traffic.written_bytes / 1e6
    );
    if let Some(accelerator) = &summary.accelerator {
        let (whole, masked) = (&accelerator.whole, &accelerator.masked);
        let _ = writeln!(
            text,
            "on {}: {:.2} ms and {:.3} mJ per frame, whole {:.2} ms and {:.3} mJ; DRAM accesses {:.2} M, whole {:.2} M",
            accelerator.name,
            1e3 * masked.seconds,
            masked.energy_mj,
            1e3 * whole.seconds,
            whole.energy_mj,
            masked.dram_accesses / 1e6,
            whole.dram_accesses / 1e6
        );
    }
    let _ = write!(
        text,
        "time       {:.2} ms per frame, {:.2} ms of it for masks",
        1e3 * summary.seconds_per_frame,
        1e3 * summary.overhead_seconds_per_frame
    );
    if let Some(error) = &summary.error {
        let _ = write!(text, "; whole {:.2} ms", 1e3 * error.dense_seconds_per_frame);
        if let Some(share) = summary.break_even_share() {
            let _ = write!(
                text,
                "; faster than that as long as at most {} of the blocks are computed",
                percent(share)
            );
        }
        text.push('\n');
        let _ = writeln!(
            text,
            "outputs    relative RMS error {:.2e}, largest error {:.2e}, cosine {:.6}, PSNR {}, same largest value in {} of the frames",
            error.outputs.relative_rms,
            error.outputs.largest,
            error.outputs.cosine,
            error.outputs.psnr.map_or("infinite".to_owned(), |psnr| format!("{psnr:.1} dB")),
            percent(error.outputs.agreement)
        );
        let _ = writeln!(
            text,
            "frames     {} of {} differ from a whole computation in some bit of some tensor",
            error.different_frames, summary.frames
        );
    } else {
        text.push('\n');
    }
    if let Some(sight) = &summary.sight {
        text.push_str(&loss_lines(sight));
    }
    text
}

/// Returns the lines about what the network loses behind the camera.
fn loss_lines(sight: &WholeFrameAgreement) -> String {
    let psnr = sight.picture_psnr.map_or("infinite".to_owned(), |psnr| format!("{psnr:.1} dB"));
    let mut text = format!(
        "sent       {:.0} bytes per frame, {} of whole frames; PSNR of the receiver's screen {psnr}\n",
        sight.sent_bytes,
        percent(sight.sent_share)
    );
    if let Some(kept) = &sight.detections {
        let DetectionCounts { whole, kept: same, seen, added } = kept.all;
        let sizes = [("small", kept.small), ("medium", kept.medium), ("large", kept.large)];
        let size = |(name, found): &(&str, DetectionCounts)| {
            format!("{name} {} of {}", found.kept, found.whole)
        };
        let sizes = sizes.iter().filter(|(_, found)| found.whole > 0).map(size);
        let _ = writeln!(
            text,
            "detections {} of {whole} in whole frames are kept, {same}; {} of {seen} are right, {added} added; kept by size: {}",
            percent(kept.kept_share),
            percent(kept.precision),
            sizes.collect::<Vec<_>>().join(", ")
        );
    }
    if let Some(truth) = &sight.truth {
        let _ = writeln!(
            text,
            "boxes      {} objects: average precision {} in whole frames, {} behind the camera; found {} and {}",
            truth.objects,
            percent(truth.whole_ap50),
            percent(truth.seen_ap50),
            percent(truth.whole_recall),
            percent(truth.seen_recall)
        );
    }
    if let Some(classes) = &sight.classes {
        let _ = writeln!(
            text,
            "class      same as for whole frames in {} of the frames; margin {:.3} in whole frames, {:.3} behind the camera",
            percent(classes.same_share),
            classes.whole_margin,
            classes.seen_margin
        );
    }
    if let Some(same) = sight.same_places {
        let _ = writeln!(
            text,
            "classes    same as for whole frames at {} of the places",
            percent(same)
        );
    }
    let _ = writeln!(
        text,
        "agreement  {} with whole frames{}; relative RMS error of the outputs {:.2e}",
        percent(sight.agreement),
        interval_text(&sight.intervals),
        sight.relative_rms
    );
    for noisy in &sight.noise {
        let _ = writeln!(
            text,
            "noise      of {} on the whole frames ({}): {}",
            grey_levels(noisy.levels),
            frames(noisy.frames, ""),
            noise_text(noisy)
        );
    }
    text
}
