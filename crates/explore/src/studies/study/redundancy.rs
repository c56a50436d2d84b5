// SPDX-License-Identifier: MIT OR Apache-2.0
//! Spatial redundancy: the share of regions that a single feature finds irrelevant.

use foveate_camera::{CameraConfig, Decimal, FeatureKind, SpatialConfig};
use foveate_design::DesignConfig;
use foveate_output::report::ReportTable;
use foveate_output::{
    chart::{BarSeries, Chart, ChartData},
    palette::{LIGHT, SERIES},
};

use super::Study;
use crate::studies::StudyError;
use crate::studies::findings::StudyFindings;
use crate::studies::number::{percent, share_text};
use crate::studies::runner::StudyRunner;

/// The columns before and after those of the features.
const COLUMNS: ([&str; 3], [&str; 1]) = (["set", "images", "regions"], ["design"]);

/// The number of regions, and of those below the threshold of every feature.
#[derive(Default)]
struct IrrelevantCounts {
    all: u64,
    by_feature: Vec<u64>,
}

pub(crate) fn run(watcher: &StudyRunner<'_>) -> Result<StudyFindings, StudyError> {
    let config = with_every_feature(watcher.config);
    let kinds: Vec<FeatureKind> = config.camera.spatial.iter().map(|entry| entry.feature).collect();
    let watched = watcher.run_clips(&[config], |below: &mut IrrelevantCounts, design, seen| {
        below.all += u64::from(design.regions());
        below.by_feature.resize(design.features().len(), 0);
        let scored = design.features().iter().zip(&seen.outcome.scores);
        for (sum, (feature, scores)) in below.by_feature.iter_mut().zip(scored) {
            let low = scores.iter().filter(|&&score| score < feature.min_score()).count();
            *sum += low as u64;
        }
    })?;
    let names = kinds.iter().map(|kind| kind.name());
    let columns: Vec<_> = COLUMNS.0.into_iter().chain(names).chain(COLUMNS.1).collect();
    let mut table = ReportTable::of_words(columns);
    for set in &watched {
        for (design, below) in &set.points {
            let mut row = vec![set.name.clone(), set.frames.to_string(), below.all.to_string()];
            row.extend(below.by_feature.iter().map(|&low| share_text(low, below.all)));
            row.push(design.fingerprint());
            table.rows.push(row);
        }
    }
    let mut findings = StudyFindings::new(Study::Redundancy, &watched, table);
    let points = || watched.iter().flat_map(|set| set.points.iter().map(|(_, below)| below));
    let bars = |(at, kind): (usize, &FeatureKind)| BarSeries {
        name: kind.name().to_owned(),
        colour: SERIES.get(at).copied().unwrap_or(LIGHT.further_series),
        values: points().map(|below| percent(below.by_feature[at], below.all)).collect(),
        ranges: Vec::new(),
    };
    let chart = Chart {
        file_stem: "redundancy".to_owned(),
        title: "Spatial redundancy: regions with SRS = 0".to_owned(),
        x_title: "set".to_owned(),
        y_title: "share of regions [%]".to_owned(),
        caption: String::new(),
        shape: ChartData::Bars {
            groups: watched.iter().map(|set| set.name.clone()).collect(),
            series: kinds.iter().enumerate().map(bars).collect(),
        },
    };
    findings.add_chart(chart, &watched);
    Ok(findings)
}

/// Returns the configuration with every feature that its organization supports, in the order of the
/// columns, with the thresholds of the configuration or their defaults. With `last-sent` and votes
/// of all features no region ever has a reference for a displacement, so that feature is left out.
fn with_every_feature(config: &DesignConfig) -> DesignConfig {
    let with_features = |kinds: Vec<FeatureKind>| {
        let entry = |kind: FeatureKind| {
            let own = config.camera.spatial.iter().find(|entry| entry.feature == kind);
            own.cloned().unwrap_or_else(|| default_entry(&config.camera, kind))
        };
        let mut all = config.clone();
        all.camera.spatial = kinds.into_iter().map(entry).collect();
        all
    };
    let mut kinds = config.hardware.organization.kind().feature_kinds();
    let every = with_features(kinds.clone());
    if every.camera.validate().is_ok() {
        return every;
    }
    kinds.retain(|kind| !kind.is_displacement());
    with_features(kinds)
}

/// Returns a feature that a camera does not have, with its defaults. It has the mean that the
/// camera has, and a minimum that is within reach of a small region.
fn default_entry(config: &CameraConfig, kind: FeatureKind) -> SpatialConfig {
    let mut entry = SpatialConfig::new(kind).with_defaults(config.frame.pixel_bits);
    if entry.has_mean_fraction() {
        let own = config.spatial.iter().find_map(|entry| entry.mean_fraction_bits);
        entry.mean_fraction_bits = own.or(entry.mean_fraction_bits);
    }
    let without_minimum =
        SpatialConfig { min_score: Some(Decimal::from_whole(0)), ..entry.clone() };
    let alone = CameraConfig { spatial: vec![without_minimum], ..config.clone() };
    // A camera that is not valid is refused as a whole, with its own message.
    if let Ok(camera) = alone.validate() {
        let largest = camera.features()[0].largest_min_score();
        let billionths = |minimum: &Decimal| minimum.ceil_times(1_000_000_000);
        entry.min_score = entry.min_score.into_iter().chain([largest]).min_by_key(billionths);
    }
    entry
}
