// SPDX-License-Identifier: MIT OR Apache-2.0
//! The active share over one setting of the design: the region size, or each threshold by itself.

use foveate_camera::{Decimal, FeatureKind, ScoreUnit};
use foveate_design::DesignConfig;
use foveate_media::SourceKind;
use foveate_output::chart::{Chart, ChartData, ChartSeries};
use foveate_output::report::ReportTable;

use super::Study;
use crate::studies::StudyError;
use crate::studies::findings::StudyFindings;
use crate::studies::number::{coordinate, percent, share_text};
use crate::studies::runner::{ClipResult, StudyRunner};
use crate::studies::tally::{RegionCounts, RegionTally};

const COLUMNS: [&str; 7] =
    ["clip", "key", "value", "active_share", "srs_share", "trs_share", "design"];
const SIZES: [u32; 4] = [4, 8, 16, 32];
const COUNTS: [u64; 9] = [1, 2, 3, 5, 8, 13, 21, 34, 55];
const LEVELS: [u64; 10] = [0, 1, 2, 4, 6, 8, 12, 16, 24, 32];
const SQUARES: [u64; 9] = [1, 5, 10, 25, 50, 100, 200, 400, 800];

/// A key of the configuration, and its values.
pub(super) struct SweptKey {
    pub(super) name: String,
    /// The title of the axis: the meaning of the key, with its unit.
    axis: String,
    /// The file name of the charts.
    file: &'static str,
    /// True if the key is about change, which a data set does not have.
    pub(super) is_temporal: bool,
    pub(super) points: Vec<(u64, DesignConfig)>,
}

pub(crate) fn run_size(watcher: &StudyRunner<'_>) -> Result<StudyFindings, StudyError> {
    run(Study::Size, watcher, &[region_size_key(watcher.config)])
}

pub(crate) fn run_threshold(watcher: &StudyRunner<'_>) -> Result<StudyFindings, StudyError> {
    run(Study::Threshold, watcher, &threshold_keys(watcher.config))
}

pub(super) fn threshold_keys(config: &DesignConfig) -> [SweptKey; 3] {
    [min_score_key(config), level_key(config), min_count_key(config)]
}

pub(super) fn region_size_key(config: &DesignConfig) -> SweptKey {
    let point = |&size: &u32| {
        let mut other = config.clone();
        other.camera.region.size = size;
        if size != config.camera.region.size {
            // Fewer regions may not fill the lanes; the fold does not change any result.
            other.hardware.unfold();
        }
        (u64::from(size), other)
    };
    SweptKey {
        name: "region.size".to_owned(),
        axis: "region size N [pixels]".to_owned(),
        file: "size",
        is_temporal: false,
        points: SIZES.iter().map(point).collect(),
    }
}

/// Varies the minimum score of the first feature; the other features keep theirs.
fn min_score_key(config: &DesignConfig) -> SweptKey {
    let n = region_pixels(config);
    let kind = config.camera.spatial.first().map_or(FeatureKind::default(), |entry| entry.feature);
    let values = match kind.score_unit() {
        ScoreUnit::Pixels => values_up_to(&COUNTS, n),
        ScoreUnit::Levels => scaled_to_depth(&COUNTS, config),
        ScoreUnit::SquaredLevels => scaled_to_depth(&SQUARES, config),
    };
    let axis = format!("min_score of {kind} [{}]", kind.score_unit().name());
    let point = |value| {
        let mut config = config.clone();
        if let Some(entry) = config.camera.spatial.first_mut() {
            entry.min_score = Some(Decimal::from_whole(value));
        }
        (value, config)
    };
    let points = values.into_iter().map(point).collect();
    let name = "spatial.0.min_score".to_owned();
    SweptKey { name, axis, file: "threshold-min-score", is_temporal: false, points }
}

fn level_key(config: &DesignConfig) -> SweptKey {
    let point = |value| {
        let mut config = config.clone();
        config.camera.temporal.level = Some(u32::try_from(value).expect("at most a pixel"));
        (value, config)
    };
    // A level of the largest pixel value or more is not valid, because no pixel differs by more.
    let max = (1_u64 << config.camera.frame.pixel_bits.min(16)) - 1;
    let reachable = scaled_to_depth(&LEVELS, config).into_iter().filter(|&value| value < max);
    SweptKey {
        name: "temporal.level".to_owned(),
        axis: "temporal.level [grey levels]".to_owned(),
        file: "threshold-level",
        is_temporal: true,
        points: reachable.map(point).collect(),
    }
}

fn min_count_key(config: &DesignConfig) -> SweptKey {
    let point = |value| {
        let mut config = config.clone();
        config.camera.temporal.min_count = u32::try_from(value).expect("one of COUNTS");
        (value, config)
    };
    SweptKey {
        name: "temporal.min_count".to_owned(),
        axis: "temporal.min_count [pixels of a region]".to_owned(),
        file: "threshold-count",
        is_temporal: true,
        points: values_up_to(&COUNTS, region_pixels(config)).into_iter().map(point).collect(),
    }
}

fn region_pixels(config: &DesignConfig) -> u64 {
    u64::from(config.camera.region.size) * u64::from(config.camera.region.size)
}

fn values_up_to(values: &[u64], most: u64) -> Vec<u64> {
    values.iter().copied().filter(|&value| value <= most).collect()
}

/// Converts grey levels of 8 bits to those of the design, and leaves out values above the largest
/// pixel.
fn scaled_to_depth(values: &[u64], config: &DesignConfig) -> Vec<u64> {
    let bits = config.camera.frame.pixel_bits;
    let max = (1_u64 << bits.min(16)) - 1;
    values_up_to(
        &values.iter().map(|value| value << bits.saturating_sub(8).min(8)).collect::<Vec<_>>(),
        max,
    )
}

fn run(
    study: Study,
    watcher: &StudyRunner<'_>,
    keys: &[SweptKey],
) -> Result<StudyFindings, StudyError> {
    // The unchanged design comes first, for the notes.
    let points = keys.iter().flat_map(|key| key.points.iter().map(|(_, config)| config.clone()));
    let configs: Vec<DesignConfig> =
        std::iter::once(watcher.config.clone()).chain(points).collect();
    let watched =
        watcher.run_clips(&configs, |tally: &mut RegionTally, _, seen| tally.add(seen))?;
    let mut table = ReportTable::of_words(COLUMNS);
    let mut charts = Vec::new();
    let mut first = 1;
    for key in keys {
        let range = first..first + key.points.len();
        first = range.end;
        let mut lines = Vec::new();
        for clip in watched.iter().filter(|clip| !key.is_temporal || clip.kind == SourceKind::Clip)
        {
            let points = &clip.points[range.clone()];
            for ((value, _), (design, tally)) in key.points.iter().zip(points) {
                let sum = tally.sum();
                let mut row = vec![clip.name.clone(), key.name.clone(), value.to_string()];
                row.extend([sum.active, sum.srs, sum.trs].map(|part| share_text(part, sum.all)));
                row.push(design.fingerprint());
                table.rows.push(row);
            }
            lines.push(line(clip, key, range.start));
        }
        charts.push(Chart {
            file_stem: key.file.to_owned(),
            title: format!("Active regions against {}", key.name),
            x_title: key.axis.clone(),
            y_title: "active share of regions [%]".to_owned(),
            caption: String::new(),
            shape: ChartData::Lines(lines),
        });
    }
    let mut findings = StudyFindings::new(study, &watched, table);
    for chart in charts {
        findings.add_chart(chart, &watched);
    }
    Ok(findings)
}

fn line(clip: &ClipResult<RegionTally>, key: &SweptKey, first: usize) -> ChartSeries {
    let tallies = clip.points.iter().skip(first).map(|(_, tally)| tally.sum());
    let point = |((value, _), sum): (&(u64, DesignConfig), RegionCounts)| {
        (coordinate(*value), percent(sum.active, sum.all))
    };
    let points = key.points.iter().zip(tallies).map(point).collect();
    ChartSeries { name: clip.name.clone(), points, ..ChartSeries::default() }
}
