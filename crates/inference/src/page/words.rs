// SPDX-License-Identifier: MIT OR Apache-2.0
//! The setup and the findings of a run in sentences.

use super::figures::{bytes, decibels, error, many, mean_bytes, millijoules, milliseconds, share};
use crate::{ConfidenceIntervals, Mapping, NoiseAgreement, Sight, Summary, Tuning};
use foveate_design::Design;
use foveate_pictures::page::number::{grouped, things};
use std::path::Path;

/// The number of inputs that are named; the others are counted.
const NAMED: usize = 3;

/// Returns the title of the page.
pub(super) fn title(summary: &Summary) -> String {
    let network = Path::new(&summary.network).file_name().map(|name| name.to_string_lossy());
    let network = network.unwrap_or_else(|| summary.network.as_str().into());
    format!("{network} over {}", inputs(summary))
}

fn inputs(summary: &Summary) -> String {
    some(&summary.inputs)
}

/// Returns the words with a capital letter and a full stop.
fn sentence(words: &str) -> String {
    words[..1].to_uppercase() + &words[1..] + "."
}

/// Returns the first few names, and the number of the others.
fn some(names: &[String]) -> String {
    let more = names.len().saturating_sub(NAMED);
    let named = names[..names.len() - more].join(", ");
    if more > 0 { format!("{named} and {more} more") } else { named }
}

/// Describes the network, the input, the camera and the mode of the run.
pub(super) fn run(summary: &Summary, design: &Design) -> String {
    let frames = usize::try_from(summary.frames).unwrap_or(usize::MAX);
    format!(
        "The network {} ran on {}{} of {}{}, as a camera with {} shows them, in mode {}: {}. {}{}",
        summary.network,
        things(frames, "frame"),
        every(summary),
        inputs(summary),
        clips(summary),
        camera(design),
        summary.mode,
        mode(summary),
        mapped(&summary.mapping),
        layout(summary)
    )
}

/// Names the number of camera frames for each frame that the network saw, unless it saw all.
fn every(summary: &Summary) -> String {
    let every = summary.every.get();
    if every == 1 { String::new() } else { format!(", one of {every},") }
}

/// Names the number of clips, if there are several, and the clips that are reported.
fn clips(summary: &Summary) -> String {
    let reported = summary.clips.len();
    match summary.tuning.as_ref().filter(|_| summary.is_tuned_on_clips()) {
        Some(tuning) => format!(
            " ({} to choose limits on, then {}, which {} reported)",
            things(tuning.clips.len(), "clip"),
            things(reported, "other clip"),
            if reported == 1 { "is" } else { "are" }
        ),
        None if reported > 1 => format!(" ({reported} clips)"),
        None => String::new(),
    }
}

/// Describes the layout in which the model takes its input, unless it is the usual one.
fn layout(summary: &Summary) -> &'static str {
    if summary.layout == "nhwc" {
        " The model takes them as [1, height, width, channels] (layout nhwc); its Transpose to channels first is left out."
    } else {
        ""
    }
}

/// Describes how pixels become inputs of the network.
fn mapped(mapping: &Mapping) -> String {
    let pixels = "Its inputs are the pixels, from 0 (black) to 1 (white), the same in all channels";
    if *mapping == (Mapping { mean: vec![0.0], scale: vec![1.0] }) {
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
pub(super) fn camera(design: &Design) -> String {
    let feature = |feature: &foveate_design::SpatialFeature| {
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

fn mode(summary: &Summary) -> String {
    let (mode, limit) = summary.mode.split_once('=').unwrap_or((&summary.mode, ""));
    let again = "every value is computed again whose window holds";
    match mode {
        "dense" => "everything is computed for every frame".to_owned(),
        "exact" => format!("{again} a changed pixel"),
        "compare" => format!("{again} a change, and a value that came out as before is none"),
        "truncate" => format!("{again} a change of more than {limit}"),
        "fixed" => {
            "in every layer the positions under changed regions are computed again".to_owned()
        }
        _ => format!(
            "{again} a change above the limit of its layer, which was chosen on the first half of the {}",
            if summary.is_tuned_on_clips() { "clips" } else { "frames" }
        ),
    }
}

/// Returns the reasons why the run is not complete.
pub(super) fn problems(summary: &Summary) -> Vec<String> {
    let problem = summary.problem.iter();
    if summary.clips.len() > 1 {
        return problem.cloned().collect();
    }
    let frames = usize::try_from(summary.frames).unwrap_or(usize::MAX);
    problem.map(|problem| format!("{problem}, after {}", things(frames, "frame"))).collect()
}

/// Says which frames the plot of frames leaves out.
pub(super) fn sampled(every: usize) -> String {
    format!(
        "Of every {every} frames in a row, the one that needs the most MACs is shown; frames.csv has all."
    )
}

/// Returns a sentence for each total.
pub(super) fn findings(summary: &Summary) -> Vec<String> {
    let macs = &summary.macs;
    let memory = format!(
        "All tensors stay from frame to frame, which takes {}; the weights take {} and the masks {}.",
        bytes(summary.kept_bytes),
        bytes(summary.weight_bytes),
        bytes(summary.mask_bytes)
    );
    if summary.counted_frames == 0 {
        return vec![sentence(Summary::ONLY_FRAME), memory];
    }
    let mut found = vec![
        format!(
            "Of the regions of a frame, {} were active and {} changed on the screen, as means over {}.",
            share(summary.active_share),
            share(summary.changed_share),
            things(usize::try_from(summary.counted_frames).unwrap_or(usize::MAX), "counted frame")
        ),
        needed(summary),
        format!(
            "{} of them were computed, because the executor computes whole blocks of positions; a whole frame takes {} in such blocks.",
            share(macs.scheduled_share()),
            share(macs.whole_share())
        ),
        memory,
        moved(summary),
        time(summary),
    ];
    found.extend(accelerated(summary));
    found.extend(compared(summary));
    found.extend(sighted(summary));
    found.extend(summary.tuning.as_ref().map(|tuning| tuned(summary, tuning)));
    found
}

fn moved(summary: &Summary) -> String {
    let traffic = &summary.traffic;
    format!(
        "The layers read {} of tensors per frame, of them {} that had not changed (the halo around changes), and wrote {}.",
        mean_bytes(traffic.read_bytes),
        mean_bytes(traffic.halo_bytes),
        mean_bytes(traffic.written_bytes)
    )
}

fn needed(summary: &Summary) -> String {
    let macs = &summary.macs;
    let whole =
        format!("A whole frame takes {} multiplications and additions (MACs).", many(macs.dense));
    if summary.mode == "dense" {
        return format!("{whole} All of them are computed for every frame, so nothing is saved.");
    }
    format!("{whole} {} of them were needed.", share(macs.needed_share()))
}

fn time(summary: &Summary) -> String {
    let mut text = format!(
        "A frame took {} on this computer, {} of it for masks, comparisons and copies",
        milliseconds(summary.seconds_per_frame),
        milliseconds(summary.overhead_seconds_per_frame)
    );
    if let Some(error) = &summary.error {
        text +=
            &format!("; a whole computation took {}", milliseconds(error.dense_seconds_per_frame));
    }
    if let Some(blocks) = summary.break_even_share() {
        text += &format!(
            ", as long as this run would at {} of the blocks of a whole frame or more",
            share(blocks)
        );
    }
    text + "."
}

fn accelerated(summary: &Summary) -> Option<String> {
    let accelerator = summary.accelerator.as_ref()?;
    let (whole, masked) = (&accelerator.whole, &accelerator.masked);
    Some(format!(
        "On the accelerator {} a frame would take {}, {} and {} accesses to DRAM; a whole frame {}, {} and {}.",
        accelerator.name,
        milliseconds(masked.seconds),
        millijoules(masked.energy_mj),
        many(masked.dram_accesses),
        milliseconds(whole.seconds),
        millijoules(whole.energy_mj),
        many(whole.dram_accesses)
    ))
}

fn compared(summary: &Summary) -> Option<String> {
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
        error(outputs.relative_rms),
        error(outputs.largest),
        decibels(outputs.psnr),
        share(outputs.agreement)
    ))
}

/// Describes what the network loses behind the camera.
fn sighted(summary: &Summary) -> Vec<String> {
    let Some(sight) = &summary.sight else { return Vec::new() };
    let mut found = vec![format!(
        "The camera sends {} per frame, {} of the whole frames; what the receiver sees of them has a PSNR of {}.",
        mean_bytes(sight.sent_bytes),
        share(sight.sent_share),
        decibels(sight.picture_psnr)
    )];
    found.extend(sight.detections.as_ref().map(|kept| {
        let all = kept.all;
        format!(
            "Of {} that the network finds in whole frames ({}) it finds {} behind the camera, and {} that are not there: {} are kept, {} are right.",
            things(usize::try_from(all.whole).unwrap_or(usize::MAX), "object"),
            kept.detector,
            grouped(all.kept),
            grouped(all.added),
            share(kept.kept_share),
            share(kept.precision)
        )
    }));
    found.extend(sight.truth.map(|truth| {
        format!(
            "Against {} ground-truth objects the average precision is {} in whole frames and {} behind the camera.",
            grouped(truth.objects),
            share(truth.whole_ap50),
            share(truth.seen_ap50)
        )
    }));
    found.extend(sight.classes.map(|classes| {
        format!(
            "The class is that of the whole frame in {} of the frames; its margin is {:.3} in whole frames and {:.3} behind the camera.",
            share(classes.same_share),
            classes.whole_margin,
            classes.seen_margin
        )
    }));
    found.extend(sight.same_places.map(|same| {
        format!("The class of a place is that of the whole frame at {} of the places.", share(same))
    }));
    found.push(format!(
        "The outputs differ from those of whole frames by a relative RMS of {}.",
        error(sight.relative_rms)
    ));
    found.extend(noisy(sight));
    found
}

/// Compares the agreement with whole frames under noise with the agreement behind the camera.
fn noisy(sight: &Sight) -> Option<String> {
    let frames = sight.noise.first()?.frames;
    let all = |of: &dyn Fn(&NoiseAgreement) -> String| {
        sight.noise.iter().map(of).collect::<Vec<_>>().join(", ")
    };
    let agreement = |agreement: f64, intervals: &ConfidenceIntervals| {
        let interval = intervals.of_few().map(|ends| ends.map(share).join(" to "));
        share(agreement) + &interval.map_or_else(String::new, |ends| format!(" ({ends})"))
    };
    let is_few = std::iter::once(&sight.intervals)
        .chain(sight.noise.iter().map(|noisy| &noisy.intervals))
        .any(|intervals| intervals.of_few().is_some());
    Some(format!(
        "Noise of {} grey levels on the whole frames ({}) leaves an agreement of {}; behind the camera it is {}.{}",
        all(&|noisy| noisy.levels.to_string()),
        things(usize::try_from(frames).unwrap_or(usize::MAX), "frame"),
        all(&|noisy| agreement(noisy.agreement, &noisy.intervals)),
        agreement(sight.agreement, &sight.intervals),
        if is_few { " In brackets are 95 % intervals, for few things say little." } else { "" }
    ))
}

fn tuned(summary: &Summary, tuning: &Tuning) -> String {
    let held = if tuning.holds { "is reached" } else { "is missed" };
    let frozen = if tuning.frozen.holds {
        format!(" {}", sentence(Tuning::SAYS_LITTLE))
    } else {
        String::new()
    };
    format!(
        "The limits were chosen on {} {}, in {} runs; there they needed {} of the MACs, and {} without a limit. The goal {} {held} on these frames.{frozen}",
        things(usize::try_from(tuning.frames).unwrap_or(usize::MAX), "counted frame"),
        if summary.is_tuned_on_clips() {
            format!("of {}", some(&tuning.clips))
        } else {
            "before these".to_owned()
        },
        grouped(tuning.runs),
        share(tuning.chosen.needed_share),
        share(tuning.exact.needed_share),
        tuning.goal
    )
}
