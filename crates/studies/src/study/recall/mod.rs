// SPDX-License-Identifier: MIT OR Apache-2.0
//! The recall of objects: the share of ground-truth boxes of which a design sends some regions, a
//! quarter, half, or all, by size, speed and contrast, and its cost in bytes, over thresholds and
//! region sizes.

mod charts;
mod class;
mod contrast;
mod count;
mod tables;
mod truth;

use std::path::PathBuf;
use std::slice::from_ref;
use std::sync::Arc;

use foveate_design::Config;
use foveate_footage::Kind;
use foveate_footage::boxes::{Clip, assign};

use super::Study;
use super::sweep::{Key, region_size, thresholds};
use crate::StudyError;
use crate::findings::Findings;
use crate::watch::{Watched, Watcher};
use count::{Count, ObjectTally, Sums, once};
use truth::Truth;

/// A clip with the counts of every design.
type Seen = Watched<ObjectTally, Truth>;

/// A point of the study: a design.
struct Point {
    /// The key of the configuration that is varied, or `design` for the unchanged design.
    key: String,
    value: String,
    /// Whether the key is about change, which a data set does not have.
    temporal: bool,
}

/// The result of one design over one clip, or over all clips.
struct PointResult {
    clip: String,
    /// The number of the design's point.
    point: usize,
    sums: Sums,
    /// The tracks by what they reached in at least one frame, and the longest gap of all tracks.
    tracks: (Count, Option<u64>),
    /// The fingerprint of the design; empty if clips of different sizes give different designs.
    design: String,
}

pub(crate) fn run(watcher: &Watcher<'_>, files: &[PathBuf]) -> Result<Findings, StudyError> {
    if files.is_empty() {
        return Err(StudyError::NoBoxes);
    }
    let subjects = watcher.subjects;
    let clips = subjects.iter().map(|clip| Clip { name: &clip.name, input: &clip.inputs[0] });
    let boxes = assign(files, &clips.collect::<Vec<_>>())?;
    let keys = keys(watcher.config);
    let varied = keys.iter().flat_map(|key| key.points.iter().map(|(_, config)| config.clone()));
    let configs: Vec<Config> = std::iter::once(watcher.config.clone()).chain(varied).collect();
    let watched = watcher.watch_guided(
        &configs,
        |clip| Truth::new(Arc::clone(&boxes[clip]), watcher.input.crop),
        |truth, tally: &mut ObjectTally, design, seen| tally.add(truth, design, seen),
    )?;
    check(&watched)?;
    let points = points(&keys);
    let results = results(&watched, &points);
    let mut findings = Findings::new(Study::Recall, &watched, tables::whole(&points, &results));
    findings.shown = Some(tables::shown(&results));
    findings.more = tables::tracks(&watched).map(|table| ("tracks", table)).into_iter().collect();
    findings.notes.extend(watched.iter().map(|clip| clip.guide.note(&clip.name)));
    for chart in charts::all(&keys, &results) {
        findings.chart(chart, &watched);
    }
    Ok(findings)
}

/// Returns the keys that are varied. Invalid values, such as a count above the pixels of a small
/// region, are left out.
fn keys(config: &Config) -> Vec<Key> {
    let mut keys: Vec<Key> = thresholds(config).into_iter().chain([region_size(config)]).collect();
    for key in &mut keys {
        // Only the camera is checked, because the hardware depends on the frame size, which is not
        // known yet.
        key.points.retain(|(_, config)| config.camera.validate().is_ok());
    }
    keys
}

/// Refuses boxes that do not belong to their clip, and clips without objects.
fn check(watched: &[Seen]) -> Result<(), StudyError> {
    for clip in watched {
        clip.guide.check(&clip.name)?;
    }
    let tallies = watched.iter().flat_map(|clip| clip.points.iter().map(|(_, tally)| tally));
    if tallies.map(|tally| tally.sums().count(0).objects).sum::<u64>() > 0 {
        return Ok(());
    }
    let names: Vec<&str> = watched.iter().map(|clip| clip.name.as_str()).collect();
    Err(StudyError::NoObjects { clips: names.join(", ") })
}

/// Returns the unchanged design, and every value of every key.
fn points(keys: &[Key]) -> Vec<Point> {
    let own = Point { key: "design".to_owned(), value: String::new(), temporal: false };
    let varied = keys.iter().flat_map(|key| {
        key.points.iter().map(|(value, _)| Point {
            key: key.name.clone(),
            value: value.to_string(),
            temporal: key.temporal,
        })
    });
    std::iter::once(own).chain(varied).collect()
}

/// Returns the results of every point for every clip, and then for all clips together if there are
/// several.
fn results(watched: &[Seen], points: &[Point]) -> Vec<PointResult> {
    let alone = watched.iter().map(|clip| (clip.name.clone(), from_ref(clip)));
    let together = (watched.len() > 1).then(|| ("all clips".to_owned(), watched));
    let of = |(name, clips): (String, &[Seen])| {
        let numbered = points.iter().enumerate();
        numbered.filter_map(|(at, point)| result(&name, clips, at, point)).collect::<Vec<_>>()
    };
    alone.chain(together).flat_map(of).collect()
}

fn result(name: &str, clips: &[Seen], at: usize, point: &Point) -> Option<PointResult> {
    let clips = clips.iter().filter(|clip| !point.temporal || clip.kind == Kind::Clip);
    let seen: Vec<_> = clips.map(|clip| &clip.points[at]).collect();
    let mut sums = Sums::default();
    seen.iter().for_each(|(_, tally)| sums.merge(tally.sums()));
    let tracks = once(seen.iter().flat_map(|(_, tally)| tally.sums().tracks.values()));
    let (first, others) = seen.split_first()?;
    let design = first.0.fingerprint();
    let same = others.iter().all(|other| other.0.fingerprint() == design);
    let design = if same { design } else { String::new() };
    Some(PointResult { clip: name.to_owned(), point: at, sums, tracks, design })
}
