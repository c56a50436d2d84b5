// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tables of the study: the whole table, a smaller one to print, and one of tracks.

use super::class::{ALL, CLASSES, UNKNOWN};
use super::count::{ClassCounts, LevelCounts};
use super::{RecallClip, RecallPoint, RecallResult};
use crate::studies::number::{percent, share_text};
use crate::studies::table::StudyTable;

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
pub(super) fn whole_table(points: &[RecallPoint], results: &[RecallResult]) -> StudyTable {
    let mut table = StudyTable::new(&COLUMNS);
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
pub(super) fn printed_table(results: &[RecallResult]) -> StudyTable {
    let mut table = StudyTable::new(&SHOWN);
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
pub(super) fn track_table(watched: &[RecallClip]) -> Option<StudyTable> {
    let mut table = StudyTable::new(&TRACKS);
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
