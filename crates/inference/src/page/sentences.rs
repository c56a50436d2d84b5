// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page in words: the setup of a run ([`run_sentences`]) and its findings ([`findings`]).

use super::figures::{
    bytes_text, decibels_text, error_text, large_count_text, mean_bytes_text, millijoules_text,
    milliseconds_text, share_text,
};
use crate::{
    Computation, ConfidenceIntervals, InferenceSummary, NoiseAgreement, PixelMapping,
    TuningSummary, WholeFrameAgreement,
};
use foveate_design::Design;
use foveate_network::ExecutionMode;
use foveate_output::number_text::{counted, grouped};
use std::path::Path;

/// The number of inputs that are named; the others are counted.
const MAX_NAMED_INPUTS: usize = 3;

pub(super) fn title(summary: &InferenceSummary) -> String {
    let network = Path::new(&summary.network).file_name().map(|name| name.to_string_lossy());
    let network = network.unwrap_or_else(|| summary.network.as_str().into());
    format!("{network} over {}", inputs_text(summary))
}

fn inputs_text(summary: &InferenceSummary) -> String {
    first_names(&summary.inputs)
}

/// Returns the words with a capital letter and a full stop.
fn sentence(words: &str) -> String {
    words[..1].to_uppercase() + &words[1..] + "."
}

/// Returns the first few names, and the number of the others.
fn first_names(names: &[String]) -> String {
    let more = names.len().saturating_sub(MAX_NAMED_INPUTS);
    let named = names[..names.len() - more].join(", ");
    if more > 0 { format!("{named} and {more} more") } else { named }
}

/// Describes the network, the input, the camera and the mode of the run.
pub(super) fn run_sentences(summary: &InferenceSummary, design: &Design) -> String {
    let frames = usize::try_from(summary.frames).unwrap_or(usize::MAX);
    format!(
        "The network {} ran on {}{} of {}{}, as a receiver shows them behind a camera with {}, in mode {}: {}. {}{}",
        summary.network,
        counted(frames, "frame"),
        frame_interval_text(summary),
        inputs_text(summary),
        clips_text(summary),
        camera_text(design),
        summary.mode,
        mode_text(summary),
        mapping_sentence(&summary.mapping),
        layout_sentence(summary)
    )
}

/// Names the number of camera frames for each frame that the network saw, unless it saw all.
fn frame_interval_text(summary: &InferenceSummary) -> String {
    let every = summary.every.get();
    if every == 1 { String::new() } else { format!(", one of {every},") }
}

/// Names the number of clips, if there are several, and the clips that are reported.
fn clips_text(summary: &InferenceSummary) -> String {
    let reported = summary.clips.len();
    match summary.tuning.as_ref().filter(|_| summary.is_tuned_on_clips()) {
        Some(tuning) => format!(
            " ({} to choose limits on, then {}, which {} reported)",
            counted(tuning.clips.len(), "clip"),
            counted(reported, "other clip"),
            if reported == 1 { "is" } else { "are" }
        ),
        None if reported > 1 => format!(" ({reported} clips)"),
        None => String::new(),
    }
}

/// Describes the layout in which the model takes its input, unless it is the usual one.
fn layout_sentence(summary: &InferenceSummary) -> &'static str {
    if summary.layout == "nhwc" {
        " The model takes them as [1, height, width, channels] (layout nhwc); its Transpose to channels first is left out."
    } else {
        ""
    }
}

/// Describes how pixels become inputs of the network.
fn mapping_sentence(mapping: &PixelMapping) -> String {
    let pixels = "Its inputs are the pixels, from 0 (black) to 1 (white), the same in all channels";
    if *mapping == (PixelMapping { mean: vec![0.0], scale: vec![1.0] }) {
        return format!("{pixels}.");
    }
    let list = |values: &[f32]| values.iter().map(f32::to_string).collect::<Vec<_>>().join(", ");
    format!(
        "{pixels}, less the mean ({}) and divided by the scale ({}) of the channel.",
        list(&mapping.mean),
        list(&mapping.scale)
    )
}

/// Describes the camera in a few words.
pub(super) fn camera_text(design: &Design) -> String {
    let feature = |feature: &foveate_camera::SpatialFeature| {
        feature
            .level()
            .map_or(feature.kind().to_string(), |level| format!("{} {level}", feature.kind()))
    };
    let features: Vec<String> = design.features().iter().map(feature).collect();
    let side = design.region_size();
    format!(
        "regions of {side}×{side} pixels, {} bits, {}, temporal level {} against {}",
        design.pixel_bits(),
        features.join(" + "),
        design.temporal().level,
        design.temporal().reference
    )
}

fn mode_text(summary: &InferenceSummary) -> String {
    let again = "every value is computed again whose window holds";
    match summary.mode {
        Computation::Mode(ExecutionMode::Dense) => {
            "everything is computed for every frame".to_owned()
        }
        Computation::Mode(ExecutionMode::Exact) => format!("{again} a changed pixel"),
        Computation::Mode(ExecutionMode::Compare) => {
            format!(
                "{again} a change, where a value that comes out as before does not count as one"
            )
        }
        Computation::Mode(ExecutionMode::Truncate(limit)) => {
            format!("{again} a change of more than {limit}")
        }
        Computation::Mode(ExecutionMode::Fixed) => {
            "in every layer the positions under changed regions are computed again".to_owned()
        }
        Computation::Tuned(_) => format!(
            "{again} a change above the limit of its layer, which was chosen on the first half of the {}",
            if summary.is_tuned_on_clips() { "clips" } else { "frames" }
        ),
    }
}

/// Returns the reasons why the run is not complete.
pub(super) fn problems(summary: &InferenceSummary) -> Vec<String> {
    let problem = summary.problem.iter();
    if summary.clips.len() > 1 {
        return problem.cloned().collect();
    }
    let frames = usize::try_from(summary.frames).unwrap_or(usize::MAX);
    problem.map(|problem| format!("{problem}, after {}", counted(frames, "frame"))).collect()
}

/// Says which frames the plot of frames leaves out.
pub(super) fn sampling_note(every: usize) -> String {
    format!(
        "Of every {every} frames in a row, the one that needs the most MACs is shown; frames.csv has all."
    )
}

/// Returns a sentence for each total.
pub(super) fn findings(summary: &InferenceSummary) -> Vec<String> {
    let macs = &summary.macs;
    let memory = format!(
        "All tensors stay from frame to frame, which takes {}; the weights take {} and the masks {}.",
        bytes_text(summary.kept_bytes),
        bytes_text(summary.weight_bytes),
        bytes_text(summary.mask_bytes)
    );
    if summary.counted_frames == 0 {
        return vec![sentence(InferenceSummary::ONLY_FRAME_NOTE), memory];
    }
    let mut found = vec![
        format!(
            "Of the regions of a frame, {} were active and {} changed on the screen, as means over {}.",
            share_text(summary.active_share),
            share_text(summary.changed_share),
            counted(usize::try_from(summary.counted_frames).unwrap_or(usize::MAX), "counted frame")
        ),
        macs_sentence(summary),
        format!(
            "{} of them were computed, because the executor computes whole blocks of positions; a whole frame takes {} in such blocks.",
            share_text(macs.scheduled_share()),
            share_text(macs.whole_share())
        ),
        memory,
        traffic_sentence(summary),
        time_sentence(summary),
    ];
    found.extend(accelerator_sentence(summary));
    found.extend(error_sentence(summary));
    found.extend(whole_frame_sentences(summary));
    found.extend(summary.tuning.as_ref().map(|tuning| tuning_sentence(summary, tuning)));
    found
}

fn traffic_sentence(summary: &InferenceSummary) -> String {
    let traffic = &summary.traffic;
    format!(
        "The layers read {} of tensors per frame, {} of which had not changed (the halo around changes), and wrote {}.",
        mean_bytes_text(traffic.read_bytes),
        mean_bytes_text(traffic.halo_bytes),
        mean_bytes_text(traffic.written_bytes)
    )
}

fn macs_sentence(summary: &InferenceSummary) -> String {
    let macs = &summary.macs;
    let whole = format!(
        "A whole frame takes {} multiplications and additions (MACs).",
        large_count_text(macs.whole_frame)
    );
    if summary.mode == Computation::Mode(ExecutionMode::Dense) {
        return format!("{whole} All of them are computed for every frame, so nothing is saved.");
    }
    format!("{whole} {} of them were needed.", share_text(macs.needed_share()))
}

fn time_sentence(summary: &InferenceSummary) -> String {
    let mut text = format!(
        "A frame took {} on this computer, {} of it for masks, comparisons and copies",
        milliseconds_text(summary.seconds_per_frame),
        milliseconds_text(summary.overhead_seconds_per_frame)
    );
    if let Some(error) = &summary.error {
        text += &format!(
            "; a whole computation took {}",
            milliseconds_text(error.dense_seconds_per_frame)
        );
    }
    if let Some(blocks) = summary.break_even_share() {
        text += &format!(
            "; this run is faster than that as long as at most {} of the blocks of a whole frame are computed",
            share_text(blocks)
        );
    }
    text + "."
}

fn accelerator_sentence(summary: &InferenceSummary) -> Option<String> {
    let accelerator = summary.accelerator.as_ref()?;
    let (whole, masked) = (&accelerator.whole, &accelerator.masked);
    Some(format!(
        "On the accelerator {} a frame would take {}, {} and {} accesses to DRAM; a whole frame {}, {} and {}.",
        accelerator.name,
        milliseconds_text(masked.seconds),
        millijoules_text(masked.energy_mj),
        large_count_text(masked.dram_accesses),
        milliseconds_text(whole.seconds),
        millijoules_text(whole.energy_mj),
        large_count_text(whole.dram_accesses)
    ))
}

fn error_sentence(summary: &InferenceSummary) -> Option<String> {
    let found = summary.error.as_ref()?;
    let frames = grouped(summary.frames);
    if found.different_frames == 0 {
        return Some(format!(
            "In all {frames} frames every tensor equals that of a whole computation, bit for bit."
        ));
    }
    let outputs = &found.outputs;
    Some(format!(
        "{} of {frames} frames differ from a whole computation in some bit of some tensor. The relative RMS error of the outputs is {}, \
         the largest error {}, PSNR {}, and the largest value is at the same place in {} of the frames.",
        grouped(found.different_frames),
        error_text(outputs.relative_rms),
        error_text(outputs.largest),
        decibels_text(outputs.psnr),
        share_text(outputs.agreement)
    ))
}

/// Describes what the network loses behind the camera.
fn whole_frame_sentences(summary: &InferenceSummary) -> Vec<String> {
    let Some(sight) = &summary.sight else { return Vec::new() };
    let mut found = vec![format!(
        "The camera sends {} per frame, {} of the whole frames; the receiver's screen has a PSNR of {}.",
        mean_bytes_text(sight.sent_bytes),
        share_text(sight.sent_share),
        decibels_text(sight.picture_psnr)
    )];
    found.extend(sight.detections.as_ref().map(|kept| {
        let all = kept.all;
        format!(
            "Of {} that the network finds in whole frames ({}), it finds {} behind the camera, too, and {} others: {} are kept, {} are right.",
            counted(usize::try_from(all.whole).unwrap_or(usize::MAX), "object"),
            kept.detector,
            grouped(all.kept),
            grouped(all.added),
            share_text(kept.kept_share),
            share_text(kept.precision)
        )
    }));
    found.extend(sight.truth.map(|truth| {
        format!(
            "Against {} ground-truth objects the average precision is {} in whole frames and {} behind the camera.",
            grouped(truth.objects),
            share_text(truth.whole_ap50),
            share_text(truth.seen_ap50)
        )
    }));
    found.extend(sight.classes.map(|classes| {
        format!(
            "The class is the same as for the whole frame in {} of the frames; its margin is {:.3} in whole frames and {:.3} behind the camera.",
            share_text(classes.same_share),
            classes.whole_margin,
            classes.seen_margin
        )
    }));
    found.extend(sight.same_places.map(|same| {
        format!(
            "The class is the same as in the whole frame at {} of the places.",
            share_text(same)
        )
    }));
    found.push(format!(
        "The outputs differ from those for whole frames by a relative RMS of {}.",
        error_text(sight.relative_rms)
    ));
    found.extend(noise_sentence(sight));
    found
}

/// Compares the agreement with whole frames under noise with the agreement behind the camera.
fn noise_sentence(sight: &WholeFrameAgreement) -> Option<String> {
    let frames = sight.noise.first()?.frames;
    let all = |of: &dyn Fn(&NoiseAgreement) -> String| {
        sight.noise.iter().map(of).collect::<Vec<_>>().join(", ")
    };
    let agreement = |agreement: f64, intervals: &ConfidenceIntervals| {
        let interval = intervals.wide_agreement().map(|ends| ends.map(share_text).join(" to "));
        share_text(agreement) + &interval.map_or_else(String::new, |ends| format!(" ({ends})"))
    };
    let is_few = std::iter::once(&sight.intervals)
        .chain(sight.noise.iter().map(|noisy| &noisy.intervals))
        .any(|intervals| intervals.wide_agreement().is_some());
    Some(format!(
        "Noise of {} grey levels on the whole frames ({}) leaves an agreement of {}; behind the camera it is {}.{}",
        all(&|noisy| noisy.levels.to_string()),
        counted(usize::try_from(frames).unwrap_or(usize::MAX), "frame"),
        all(&|noisy| agreement(noisy.agreement, &noisy.intervals)),
        agreement(sight.agreement, &sight.intervals),
        if is_few {
            " In brackets are 95 % intervals, which are wide where little was counted."
        } else {
            ""
        }
    ))
}

fn tuning_sentence(summary: &InferenceSummary, tuning: &TuningSummary) -> String {
    let held = if tuning.holds { "is reached" } else { "is missed" };
    let frozen = if tuning.frozen.holds {
        format!(" {}", sentence(TuningSummary::FROZEN_OUTPUTS_NOTE))
    } else {
        String::new()
    };
    format!(
        "The limits were chosen on {} {}, in {} runs; there {} of the MACs were needed, and {} without a limit. The goal {} {held} on these frames.{frozen}",
        counted(usize::try_from(tuning.frames).unwrap_or(usize::MAX), "counted frame"),
        if summary.is_tuned_on_clips() {
            format!("of {}", first_names(&tuning.clips))
        } else {
            "before these".to_owned()
        },
        grouped(tuning.runs),
        share_text(tuning.chosen.needed_share),
        share_text(tuning.exact.needed_share),
        tuning.goal
    )
}
