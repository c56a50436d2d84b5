// SPDX-License-Identifier: MIT OR Apache-2.0
//! The charts of the study over all clips: recall over bytes, and recall by class.

use foveate_output::{
    chart::{BarSeries, Chart, ChartData, ChartSeries},
    palette::SERIES,
};

use super::class::{CLASSES, UNKNOWN};
use super::{RecallResult, SweptKey};
use crate::studies::number::{coordinate, percent};

/// The names of the levels of `Shares::at_least`, in their order.
const LEVELS: [&str; 3] = ["at least a quarter", "at least half", "all"];
const HALF: usize = 1;

/// The groups that have a chart, each with the title of its axis.
const GROUPS: [(&str, &str); 3] = [
    ("size", "size: below 32², below 96², above [pixels]"),
    ("speed", "speed: below 0.5, below 2, below 8, above [pixels per frame]"),
    ("contrast", "contrast to the surroundings: below 8, below 32, above [grey levels of 8 bits]"),
];

pub(super) fn recall_charts(keys: &[SweptKey], results: &[RecallResult]) -> Vec<Chart> {
    let last = results.last().map_or("", |result| result.clip.as_str());
    let together: Vec<&RecallResult> =
        results.iter().filter(|result| result.clip == last).collect();
    let own = together.iter().find(|result| result.point == 0);
    let by_class = own
        .into_iter()
        .flat_map(|own| GROUPS.iter().filter_map(|group| recall_by_class(own, *group)));
    std::iter::once(recall_over_bytes(keys, &together)).chain(by_class).collect()
}

/// Draws a line for every setting that is varied.
fn recall_over_bytes(keys: &[SweptKey], together: &[&RecallResult]) -> Chart {
    let mut first = 1;
    let mut lines = Vec::new();
    for key in keys {
        let range = first..first + key.points.len();
        first = range.end;
        let own = together.iter().filter(|result| range.contains(&result.point));
        let point = |result: &&RecallResult| {
            let count = result.sums.count(0);
            let half = percent(count.active.at_least[HALF], count.objects);
            (coordinate(result.sums.bytes_per_frame()) / 1000.0, half)
        };
        let points: Vec<(f64, f64)> = own.map(point).collect();
        if !points.is_empty() {
            lines.push(ChartSeries { name: key.name.clone(), points, ..ChartSeries::default() });
        }
    }
    Chart {
        file_stem: "recall".to_owned(),
        title: "Objects of which at least half of the regions are active".to_owned(),
        x_title: "kilobytes per frame (1000 bytes)".to_owned(),
        y_title: "share of objects [%]".to_owned(),
        caption: String::new(),
        shape: ChartData::Lines(lines),
    }
}

/// Draws the recall of every class of a group that has an object, unless all its objects are of the
/// unknown class.
fn recall_by_class(own: &RecallResult, (group, axis): (&str, &str)) -> Option<Chart> {
    let classes = CLASSES.iter().enumerate().filter(|(_, class)| class.0 == group);
    let counted = classes.map(|(at, class)| (class.1, own.sums.count(at)));
    let counted: Vec<_> =
        counted.filter(|(name, count)| count.objects > 0 && *name != UNKNOWN).collect();
    let series = |(level, name): (usize, &&str)| BarSeries {
        name: (*name).to_owned(),
        colour: SERIES[level % SERIES.len()],
        values: counted.iter().map(|(_, c)| percent(c.active.at_least[level], c.objects)).collect(),
        ranges: Vec::new(),
    };
    let chart = || Chart {
        file_stem: format!("recall-{group}"),
        title: format!("Objects whose regions are active, by {group}"),
        x_title: axis.to_owned(),
        y_title: "share of objects [%]".to_owned(),
        caption: String::new(),
        shape: ChartData::Bars {
            // A share of few objects is uncertain, so the labels give their number.
            groups: counted.iter().map(|(name, c)| format!("{name} (n = {})", c.objects)).collect(),
            series: LEVELS.iter().enumerate().map(series).collect(),
        },
    };
    (!counted.is_empty()).then(chart)
}
