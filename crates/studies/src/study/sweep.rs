// SPDX-License-Identifier: MIT OR Apache-2.0
//! The active share over one setting of the design: the region size, or each threshold by itself.

use foveate_design::{Config, Decimal, FeatureKind, Measure};
use foveate_footage::Kind;
use foveate_pictures::chart::{Chart, Line, Shape};

use super::Study;
use crate::StudyError;
use crate::findings::Findings;
use crate::number::{coordinate, percent, share};
use crate::table::Table;
use crate::tally::{RegionTally, Regions};
use crate::watch::{Watched, Watcher};

const COLUMNS: [&str; 7] =
    ["clip", "key", "value", "active_share", "srs_share", "trs_share", "design"];
const SIZES: [u32; 4] = [4, 8, 16, 32];
const COUNTS: [u64; 9] = [1, 2, 3, 5, 8, 13, 21, 34, 55];
const LEVELS: [u64; 10] = [0, 1, 2, 4, 6, 8, 12, 16, 24, 32];
const SQUARES: [u64; 9] = [1, 5, 10, 25, 50, 100, 200, 400, 800];

/// A key of the configuration, and its values.
pub(super) struct Key {
    pub(super) name: String,
    /// The title of the axis: the meaning of the key, with its unit.
    axis: String,
    /// The file name of the charts.
    file: &'static str,
    /// Whether the key is about change, which a data set does not have.
    pub(super) temporal: bool,
    pub(super) points: Vec<(u64, Config)>,
}

pub(crate) fn size(watcher: &Watcher<'_>) -> Result<Findings, StudyError> {
    run(Study::Size, watcher, &[region_size(watcher.config)])
}

pub(crate) fn threshold(watcher: &Watcher<'_>) -> Result<Findings, StudyError> {
    run(Study::Threshold, watcher, &thresholds(watcher.config))
}

/// Returns the keys of the three thresholds.
pub(super) fn thresholds(config: &Config) -> [Key; 3] {
    [min_score(config), level(config), min_count(config)]
}

pub(super) fn region_size(config: &Config) -> Key {
    let point = |&size: &u32| {
        let mut other = config.clone();
        other.camera.region.size = size;
        if size != config.camera.region.size {
            // Fewer regions may not fill the lanes; the fold does not change any result.
            other.hardware.fold = 1;
        }
        (u64::from(size), other)
    };
    Key {
        name: "region.size".to_owned(),
        axis: "region size N [pixels]".to_owned(),
        file: "size",
        temporal: false,
        points: SIZES.iter().map(point).collect(),
    }
}

/// Varies the minimum score of the first feature; the other features keep theirs.
fn min_score(config: &Config) -> Key {
    let n = pixels(config);
    let kind = config.camera.spatial.first().map_or(FeatureKind::default(), |entry| entry.feature);
    let values = match kind.measure() {
        Measure::Pixels => within(&COUNTS, n),
        Measure::Levels => scaled(&COUNTS, config),
        Measure::SquaredLevels => scaled(&SQUARES, config),
    };
    let axis = format!("min_score of {kind} [{}]", kind.measure().name());
    let point = |value| {
        let mut config = config.clone();
        if let Some(entry) = config.camera.spatial.first_mut() {
            entry.min_score = Some(Decimal::whole(value));
        }
        (value, config)
    };
    let points = values.into_iter().map(point).collect();
    let name = "spatial.0.min_score".to_owned();
    Key { name, axis, file: "threshold-min-score", temporal: false, points }
}

fn level(config: &Config) -> Key {
    let point = |value| {
        let mut config = config.clone();
        config.camera.temporal.level = Some(u32::try_from(value).expect("at most a pixel"));
        (value, config)
    };
    // A level of the largest pixel value or more is not valid, because no pixel differs by more.
    let max = (1_u64 << config.camera.frame.pixel_bits.min(16)) - 1;
    let reachable = scaled(&LEVELS, config).into_iter().filter(|&value| value < max);
    Key {
        name: "temporal.level".to_owned(),
        axis: "temporal.level [grey levels]".to_owned(),
        file: "threshold-level",
        temporal: true,
        points: reachable.map(point).collect(),
    }
}

fn min_count(config: &Config) -> Key {
    let point = |value| {
        let mut config = config.clone();
        config.camera.temporal.min_count = u32::try_from(value).expect("one of COUNTS");
        (value, config)
    };
    Key {
        name: "temporal.min_count".to_owned(),
        axis: "temporal.min_count [pixels of a region]".to_owned(),
        file: "threshold-count",
        temporal: true,
        points: within(&COUNTS, pixels(config)).into_iter().map(point).collect(),
    }
}

fn pixels(config: &Config) -> u64 {
    u64::from(config.camera.region.size) * u64::from(config.camera.region.size)
}

fn within(values: &[u64], most: u64) -> Vec<u64> {
    values.iter().copied().filter(|&value| value <= most).collect()
}

/// Converts grey levels of 8 bits to those of the design, and leaves out values above the largest
/// pixel.
fn scaled(values: &[u64], config: &Config) -> Vec<u64> {
    let bits = config.camera.frame.pixel_bits;
    let max = (1_u64 << bits.min(16)) - 1;
    within(
        &values.iter().map(|value| value << bits.saturating_sub(8).min(8)).collect::<Vec<_>>(),
        max,
    )
}

fn run(study: Study, watcher: &Watcher<'_>, keys: &[Key]) -> Result<Findings, StudyError> {
    // The unchanged design comes first, for the notes.
    let points = keys.iter().flat_map(|key| key.points.iter().map(|(_, config)| config.clone()));
    let configs: Vec<Config> = std::iter::once(watcher.config.clone()).chain(points).collect();
    let watched = watcher.watch(&configs, |tally: &mut RegionTally, _, seen| tally.add(seen))?;
    let mut table = Table::new(&COLUMNS);
    let mut charts = Vec::new();
    let mut first = 1;
    for key in keys {
        let range = first..first + key.points.len();
        first = range.end;
        let mut lines = Vec::new();
        for clip in watched.iter().filter(|clip| !key.temporal || clip.kind == Kind::Clip) {
            let points = &clip.points[range.clone()];
            for ((value, _), (design, tally)) in key.points.iter().zip(points) {
                let sum = tally.sum();
                let mut row = vec![clip.name.clone(), key.name.clone(), value.to_string()];
                row.extend([sum.active, sum.srs, sum.trs].map(|part| share(part, sum.all)));
                row.push(design.fingerprint());
                table.rows.push(row);
            }
            lines.push(line(clip, key, range.start));
        }
        charts.push(Chart {
            file: key.file.to_owned(),
            title: format!("Active regions against {}", key.name),
            x: key.axis.clone(),
            y: "active share of regions [%]".to_owned(),
            caption: String::new(),
            shape: Shape::Lines(lines),
        });
    }
    let mut findings = Findings::new(study, &watched, table);
    for chart in charts {
        findings.chart(chart, &watched);
    }
    Ok(findings)
}

fn line(clip: &Watched<RegionTally>, key: &Key, first: usize) -> Line {
    let tallies = clip.points.iter().skip(first).map(|(_, tally)| tally.sum());
    let point = |((value, _), sum): (&(u64, Config), Regions)| {
        (coordinate(*value), percent(sum.active, sum.all))
    };
    let points = key.points.iter().zip(tallies).map(point).collect();
    Line { name: clip.name.clone(), points, ..Line::default() }
}
