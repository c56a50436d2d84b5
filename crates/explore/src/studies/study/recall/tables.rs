// SPDX-License-Identifier: MIT OR Apache-2.0
//! The results of the study: tables of everything, of the part that is printed, and of tracks,
//! and charts over all clips, of recall over bytes and by class ([`recall_charts`]).

use super::class::{ALL, CLASSES, UNKNOWN};
use super::count::{ClassCounts, LevelCounts};
use super::{RecallClip, RecallPoint, RecallResult, SweptKey};
use crate::studies::number::{coordinate, percent, share_text};
use foveate_output::chart::{BarSeries, Chart, ChartData, ChartSeries};
use foveate_output::palette::SERIES;
use foveate_output::report::ReportTable;

const COLUMNS: [&str; 14] = [
    "clip",
    "key",
    "value",
    "vote",
    "group",
    "class",
    "objects",
    "missed",
    "quarter",
    "half",
    "all",
    "longest_gap",
    "bytes_per_frame",
    "design",
];
const SHOWN: [&str; 10] = [
    "clip",
    "objects",
    "count",
    "missed",
    "quarter",
    "half",
    "all",
    "half relevant",
    "longest gap",
    "bytes/frame",
];
const TRACKS: [&str; 8] =
    ["clip", "track", "frames", "some", "quarter", "half", "all", "longest_gap"];

/// Returns a row for every clip, point, vote and class that has an object.
pub(super) fn whole_table(points: &[RecallPoint], results: &[RecallResult]) -> ReportTable {
    let mut table = ReportTable::of_words(COLUMNS);
    for result in results {
        let point = &points[result.point];
        let mut row =
            |vote: &str, (group, class): (&str, &str), shares: Vec<String>, gap: String| {
                let place = [&result.clip, &point.key, &point.value].map(Clone::clone);
                let mut row = place.to_vec();
                row.extend([vote, group, class].map(str::to_owned));
                row.extend(shares);
                row.extend([gap, result.sums.bytes_per_frame().to_string(), result.design.clone()]);
                table.rows.push(row);
            };
        for (class, count) in counted_classes(result) {
            for (vote, shares) in [("active", &count.active), ("srs", &count.relevant)] {
                row(vote, class, cells(count.objects, shares, share_text), String::new());
            }
        }
        if let (count, Some(gap)) = &result.tracks {
            let cells = cells(count.objects, &count.active, share_text);
            row("active", ("track", "all"), cells, gap.to_string());
        }
    }
    table
}

/// Returns the rows of the unchanged design: every clip, and the classes of all clips together.
pub(super) fn printed_table(results: &[RecallResult]) -> ReportTable {
    let mut table = ReportTable::of_words(SHOWN);
    let own: Vec<&RecallResult> = results.iter().filter(|result| result.point == 0).collect();
    let in_percent = |part, whole| format!("{:.1} %", percent(part, whole));
    for (number, result) in own.iter().enumerate() {
        let mut row = |name: String, shares: Vec<String>, relevant: String, gap: String| {
            let mut row = vec![result.clip.clone(), name];
            row.extend(shares);
            row.extend([relevant, gap, result.sums.bytes_per_frame().to_string()]);
            table.rows.push(row);
        };
        let classes = number + 1 == own.len();
        for ((group, class), count) in counted_classes(result) {
            let nothing_known = class == UNKNOWN && count.objects == result.sums.count(0).objects;
            let name = match group {
                _ if nothing_known => continue,
                ALL => class.to_owned(),
                group if classes => format!("{group}: {class}"),
                _ => continue,
            };
            let relevant = in_percent(count.relevant.at_least[1], count.objects);
            let shares = cells(count.objects, &count.active, in_percent);
            row(name, shares, relevant, String::new());
        }
        if let (count, Some(gap)) = &result.tracks {
            let shares = cells(count.objects, &count.active, in_percent);
            row("tracks, at least once".to_owned(), shares, String::new(), gap.to_string());
        }
    }
    table
}

/// Returns every track of every clip for the unchanged design; `None` without tracks.
pub(super) fn track_table(watched: &[RecallClip]) -> Option<ReportTable> {
    let mut table = ReportTable::of_words(TRACKS);
    for clip in watched {
        let own = clip.points.first().into_iter();
        for (id, track) in own.flat_map(|(_, tally)| &tally.sums().tracks) {
            let [quarter, half, all] = track.at_least;
            let numbers =
                [*id, track.frames, track.some_active, quarter, half, all, track.longest_gap];
            let numbers = numbers.map(|number| number.to_string());
            table.rows.push([clip.name.clone()].into_iter().chain(numbers).collect());
        }
    }
    (!table.rows.is_empty()).then_some(table)
}

/// Returns the classes that have an object.
fn counted_classes(
    result: &RecallResult,
) -> impl Iterator<Item = ((&'static str, &'static str), ClassCounts)> {
    let counts = CLASSES.into_iter().enumerate().map(|(at, class)| (class, result.sums.count(at)));
    counts.filter(|(_, count)| count.objects > 0)
}

/// Returns the number of objects, and the shares of them that are missed and sent.
fn cells(objects: u64, shares: &LevelCounts, text: fn(u64, u64) -> String) -> Vec<String> {
    let parts = [shares.none].into_iter().chain(shares.at_least);
    let parts = parts.map(|part| text(part, objects));
    [objects.to_string()].into_iter().chain(parts).collect()
}

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
