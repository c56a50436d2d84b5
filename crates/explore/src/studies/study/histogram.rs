// SPDX-License-Identifier: MIT OR Apache-2.0
//! The distribution of the mean absolute deviation (MAD) of regions, in 128 bins from 0 to half of
//! full scale, which is the largest possible value. At 8 bits a bin is one grey level wide.

use foveate_camera::{FeatureKind, SpatialConfig};
use foveate_design::Design;
use foveate_output::chart::{Chart, ChartData, ChartSeries};
use foveate_output::report::ReportTable;

use super::Study;
use crate::studies::StudyError;
use crate::studies::findings::StudyFindings;
use crate::studies::number::{coordinate, percent, share_text};
use crate::studies::runner::StudyRunner;

const COLUMNS: [&str; 6] = ["set", "mad_from", "mad_to", "regions", "share", "design"];
const BINS: u64 = 128;

#[derive(Default)]
struct DeviationHistogram {
    all: u64,
    bins: Vec<u64>,
}

pub(crate) fn run(watcher: &StudyRunner<'_>) -> Result<StudyFindings, StudyError> {
    let own = watcher.config.camera.spatial.iter().find(|entry| entry.feature == FeatureKind::Mad);
    let mad = own.cloned().unwrap_or_else(|| SpatialConfig::new(FeatureKind::Mad));
    let mut config = watcher.config.clone();
    config.camera.spatial = vec![mad];
    let watched =
        watcher.run_clips(&[config], |histogram: &mut DeviationHistogram, design, seen| {
            histogram.bins.resize(usize::try_from(BINS).expect("BINS are few"), 0);
            for &score in seen.outcome.scores.iter().flatten() {
                histogram.all += 1;
                histogram.bins[bin(design, score)] += 1;
            }
        })?;
    let mut table = ReportTable::of_words(COLUMNS);
    let mut lines = Vec::new();
    for set in &watched {
        for (design, histogram) in &set.points {
            let width = bin_width(design);
            let used = histogram.bins.iter().rposition(|&count| count > 0).map_or(0, |at| at + 1);
            let bins = || (0_u32..).zip(histogram.bins.iter().copied());
            for (at, count) in bins() {
                table.rows.push(vec![
                    set.name.clone(),
                    (f64::from(at) * width).to_string(),
                    (f64::from(at + 1) * width).to_string(),
                    count.to_string(),
                    share_text(count, histogram.all),
                    design.fingerprint(),
                ]);
            }
            let steps = bins().take(used).flat_map(|(at, count)| {
                let height = percent(count, histogram.all);
                [(f64::from(at) * width, height), (f64::from(at + 1) * width, height)]
            });
            lines.push(ChartSeries {
                name: set.name.clone(),
                points: steps.collect(),
                ..ChartSeries::default()
            });
        }
    }
    let mut findings = StudyFindings::new(Study::MadHistogram, &watched, table);
    let width = watched.first().and_then(|set| set.points.first()).map_or(1.0, |p| bin_width(&p.0));
    let chart = Chart {
        file_stem: "mad-histogram".to_owned(),
        title: "Mean absolute deviation (MAD) of regions".to_owned(),
        x_title: "MAD [grey levels]".to_owned(),
        y_title: format!("share of regions [%] per {width} grey level"),
        caption: String::new(),
        shape: ChartData::Lines(lines),
    };
    findings.add_chart(chart, &watched);
    Ok(findings)
}

/// Returns the width of a bin in grey levels.
fn bin_width(design: &Design) -> f64 {
    coordinate(u64::from(design.pixel_max()) + 1) / 256.0
}

/// Returns the bin of a score. The score is the MAD times the pixels of a region and the unit of
/// the mean.
fn bin(design: &Design, score: u64) -> usize {
    let feature = design.feature(FeatureKind::Mad);
    let fraction = feature.and_then(|mad| mad.mean()).map_or(0, |mean| mean.fraction_bits);
    let unit = u128::from(design.region_pixels()) << fraction;
    let half = 1_u128 << (design.pixel_bits() - 1);
    let bin = u128::from(score) * u128::from(BINS) / (unit * half);
    usize::try_from(bin.min(u128::from(BINS) - 1)).expect("BINS are few")
}
