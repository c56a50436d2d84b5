// SPDX-License-Identifier: MIT OR Apache-2.0
//! The recall of objects: the share of ground-truth boxes of which a design sends some regions, a
//! quarter, half, or all, by size, speed and contrast, and its cost in bytes, over thresholds and
//! region sizes.

mod class;
mod contrast;
mod count;
mod tables;
mod truth;

use std::slice::from_ref;
use std::sync::Arc;

use foveate_design::DesignConfig;
use foveate_media::SourceKind;

use super::Study;
use super::sweep::{SweptKey, region_size_key, threshold_keys};
use crate::studies::StudyError;
use crate::studies::findings::StudyFindings;
use crate::studies::runner::{ClipResult, StudyRunner};
use count::{ClassCounts, ObjectTally, RecallSums, reached_at_least_once};
use truth::GroundTruthObjects;

/// A clip with the counts of every design.
type RecallClip = ClipResult<ObjectTally, GroundTruthObjects>;

/// A point of the study: a design.
struct RecallPoint {
    /// The key of the configuration that is varied, or `design` for the unchanged design.
    key: String,
    value: String,
    /// True if the key is about change, which a data set does not have.
    is_temporal: bool,
}

/// The result of one design over one clip, or over all clips.
struct RecallResult {
    clip: String,
    /// The number of the design's point.
    point: usize,
    sums: RecallSums,
    /// The tracks by what they reached in at least one frame, and the longest gap of all tracks.
    tracks: (ClassCounts, Option<u64>),
    /// The fingerprint of the design; empty if clips of different sizes give different designs.
    design: String,
}

pub(crate) fn run(watcher: &StudyRunner<'_>) -> Result<StudyFindings, StudyError> {
    let clips = watcher.clips;
    let boxes = (0..clips.clips().len()).map(|clip| clips.boxes(clip).map(Arc::clone));
    let boxes = boxes.collect::<Option<Vec<_>>>().ok_or(StudyError::NoBoxes)?;
    let keys = swept_keys(watcher.config);
    let varied = keys.iter().flat_map(|key| key.points.iter().map(|(_, config)| config.clone()));
    let configs: Vec<DesignConfig> =
        std::iter::once(watcher.config.clone()).chain(varied).collect();
    let watched = watcher.run_annotated_clips(
        &configs,
        |clip| GroundTruthObjects::new(Arc::clone(&boxes[clip]), clips.options().crop),
        |truth, tally: &mut ObjectTally, design, seen| tally.add(truth, design, seen),
    )?;
    check_boxes(&watched)?;
    let points = recall_points(&keys);
    let results = recall_results(&watched, &points);
    let mut findings =
        StudyFindings::new(Study::Recall, &watched, tables::whole_table(&points, &results));
    findings.printed = Some(tables::printed_table(&results));
    findings.further_tables =
        tables::track_table(&watched).map(|table| ("tracks", table)).into_iter().collect();
    findings.notes.extend(watched.iter().map(|clip| clip.annotator.note(&clip.name)));
    for chart in tables::recall_charts(&keys, &results) {
        findings.add_chart(chart, &watched);
    }
    Ok(findings)
}

/// Returns the keys that are varied. Invalid values, such as a count above the pixels of a small
/// region, are left out.
fn swept_keys(config: &DesignConfig) -> Vec<SweptKey> {
    let mut keys: Vec<SweptKey> =
        threshold_keys(config).into_iter().chain([region_size_key(config)]).collect();
    for key in &mut keys {
        // Only the camera is checked, because the hardware depends on the frame size, which is not
        // known yet.
        key.points.retain(|(_, config)| config.camera.validate().is_ok());
    }
    keys
}

/// Refuses boxes that do not belong to their clip, and clips without objects.
fn check_boxes(watched: &[RecallClip]) -> Result<(), StudyError> {
    for clip in watched {
        clip.annotator.check(&clip.name)?;
    }
    let tallies = watched.iter().flat_map(|clip| clip.points.iter().map(|(_, tally)| tally));
    if tallies.map(|tally| tally.sums().count(0).objects).sum::<u64>() > 0 {
        return Ok(());
    }
    let names: Vec<&str> = watched.iter().map(|clip| clip.name.as_str()).collect();
    let left_out = watched.iter().filter_map(|clip| clip.annotator.left_out()).collect();
    Err(StudyError::NoObjects { clips: names.join(", "), left_out })
}

/// Returns the unchanged design, and every value of every key.
fn recall_points(keys: &[SweptKey]) -> Vec<RecallPoint> {
    let own = RecallPoint { key: "design".to_owned(), value: String::new(), is_temporal: false };
    let varied = keys.iter().flat_map(|key| {
        key.points.iter().map(|(value, _)| RecallPoint {
            key: key.name.clone(),
            value: value.to_string(),
            is_temporal: key.is_temporal,
        })
    });
    std::iter::once(own).chain(varied).collect()
}

/// Returns the results of every point for every clip, and then for all clips together if there are
/// several.
fn recall_results(watched: &[RecallClip], points: &[RecallPoint]) -> Vec<RecallResult> {
    let alone = watched.iter().map(|clip| (clip.name.clone(), from_ref(clip)));
    let together = (watched.len() > 1).then(|| ("all clips".to_owned(), watched));
    let of = |(name, clips): (String, &[RecallClip])| {
        let numbered = points.iter().enumerate();
        numbered
            .filter_map(|(at, point)| recall_result(&name, clips, at, point))
            .collect::<Vec<_>>()
    };
    alone.chain(together).flat_map(of).collect()
}

fn recall_result(
    name: &str,
    clips: &[RecallClip],
    at: usize,
    point: &RecallPoint,
) -> Option<RecallResult> {
    let clips = clips.iter().filter(|clip| !point.is_temporal || clip.kind == SourceKind::Clip);
    let seen: Vec<_> = clips.map(|clip| &clip.points[at]).collect();
    let mut sums = RecallSums::default();
    seen.iter().for_each(|(_, tally)| sums.merge(tally.sums()));
    let tracks =
        reached_at_least_once(seen.iter().flat_map(|(_, tally)| tally.sums().tracks.values()));
    let (first, others) = seen.split_first()?;
    let design = first.0.fingerprint();
    let same = others.iter().all(|other| other.0.fingerprint() == design);
    let design = if same { design } else { String::new() };
    Some(RecallResult { clip: name.to_owned(), point: at, sums, tracks, design })
}
