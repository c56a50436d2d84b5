// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tables of clocks. The tests of `foveate-timed` compare every clock with the cycle-level
//! models; these tests compare the tables with the other outputs of the same run.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::Path;

use foveate_design::{Design, Organization};
use foveate_simulator::{ClockFigures, ClockOptions, RunOptions, RunSummary};
use foveate_timed::SinkPattern;
use parquet::file::reader::{FileReader, SerializedFileReader};

use crate::support::data_sets::images;
use crate::support::{STREET, design, outcomes, run, street};

/// A raster core whose regions are lost if its sink is slow.
const RASTER: &str = "hardware.organization='raster'";

/// A row of `clocks.csv`: event, frame, region, clock, last clock, first word, words, last,
/// aborted.
type ClockRow = (String, [u64; 8]);

fn options(clocks: ClockOptions) -> RunOptions {
    RunOptions { clocks, rendered: None, ..RunOptions::default() }
}

fn csv_options(sink: SinkPattern) -> RunOptions {
    options(ClockOptions { csv: true, sink, ..ClockOptions::default() })
}

fn csv_rows(folder: &Path) -> Vec<ClockRow> {
    let text = fs::read_to_string(folder.join("clocks.csv")).unwrap();
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some("event,frame,region,clock,last_clock,first_word,words,is_last,is_aborted")
    );
    let row = |line: &str| {
        let (event, numbers) = line.split_once(',').unwrap();
        let numbers: Vec<u64> = numbers.split(',').map(|text| text.parse().unwrap()).collect();
        (event.to_owned(), numbers.try_into().unwrap())
    };
    lines.map(row).collect()
}

/// Returns the rows of an event, which must be in the order of their clocks.
fn rows_of<'a>(rows: &'a [ClockRow], event: &str) -> Vec<&'a [u64; 8]> {
    let found: Vec<_> =
        rows.iter().filter(|row| row.0 == event).map(|(_, numbers)| numbers).collect();
    assert!(found.is_sorted_by_key(|row| row[2]), "{event}");
    found
}

fn overrides(hardware: &'static str) -> Vec<&'static str> {
    // A pipelined array decides a frame at its last pixel only if no feature needs a second pass.
    let features = "spatial=[{feature='edge',min_score=1}]";
    [&STREET[..], &[hardware, features, "temporal.min_count=1"]].concat()
}

/// Checks that every region of every frame is decided once, and that exactly the active regions
/// send all of their words.
fn check_whole(rows: &[ClockRow], design: &Design, overrides: &[&str], figures: ClockFigures) {
    let outcomes = outcomes(overrides);
    let decisions: BTreeMap<(u64, u64), u64> =
        rows_of(rows, "decision").iter().map(|row| ((row[0], row[1]), row[2])).collect();
    assert_eq!(decisions.len() as u64, 5 * u64::from(design.regions()));
    let mut words: BTreeMap<(u64, u64), u64> = BTreeMap::new();
    for row in rows_of(rows, "pixels") {
        let region = (row[0], row[1]);
        assert!(row[2] > decisions[&region], "{row:?}: words leave after the decision");
        let sent = words.entry(region).or_default();
        assert_eq!(*sent, row[4], "{row:?}: words leave in order");
        *sent += row[5];
    }
    let active = |frame: usize| outcomes[frame].active.iter().enumerate();
    // A pipelined array sends the pixels of a frame while the next one enters.
    let sent_frames = match design.organization() {
        Organization::Pipelined => 4,
        Organization::Serial | Organization::Raster => 5,
    };
    let expected: Vec<(u64, u64)> = (0..sent_frames)
        .flat_map(|frame| active(frame).map(move |(region, &is_active)| (frame, region, is_active)))
        .filter(|&(_, _, is_active)| is_active)
        .map(|(frame, region, _)| (frame as u64, region as u64))
        .collect();
    assert_eq!(words.keys().copied().collect::<Vec<_>>(), expected);
    assert!(words.values().all(|&sent| sent == 64), "{words:?}");
    let last = rows.iter().map(|(_, row)| row[3]).max().unwrap();
    let total = words.values().sum();
    assert_eq!(figures, ClockFigures { last_clock: last, words: total, lost_regions: 0 });
}

#[test]
fn every_organization_decides_and_sends_what_the_model_does() {
    for hardware in
        ["hardware.organization='pipelined'", "hardware={organization='serial',fold=2}", RASTER]
    {
        let dir = tempfile::tempdir().unwrap();
        let output = dir.path().join("out");
        let overrides = overrides(hardware);
        let summary = street(&output, &overrides, &csv_options(SinkPattern::Always));
        check_whole(&csv_rows(&output), &design(&overrides), &overrides, summary.clocks.unwrap());
    }
}

#[test]
fn a_slow_sink_delays_words_and_a_sink_that_takes_none_loses_regions() {
    let dir = tempfile::tempdir().unwrap();
    let overrides = overrides(RASTER);
    let simulate = |name: &str, sink| {
        let output = dir.path().join(name);
        let summary: RunSummary = street(&output, &overrides, &csv_options(sink));
        (csv_rows(&output), summary.clocks.unwrap())
    };
    let (rows, none) = simulate("none", SinkPattern::Rate { words: 0, clocks: 1 });
    // One word waits on the port. The last rows of regions are not overwritten any more.
    assert_eq!(rows_of(&rows, "loss").len() as u64, none.lost_regions);
    assert!(none.words == 1 && none.lost_regions > 20, "{none:?}");
    // A list with one stall behind the first decision keeps the first word on the port, and delays
    // the second.
    let stall = 0..rows_of(&rows, "decision")[0][2] + 40;
    let (rows, _) = simulate("late", SinkPattern::Stalls(vec![stall.clone()].into()));
    let words = rows_of(&rows, "pixels");
    assert_eq!((words[0][5], words[1][2], words[1][4]), (1, stall.end, 1), "{words:?}");
}

#[test]
fn frames_come_at_the_times_of_the_clip() {
    let dir = tempfile::tempdir().unwrap();
    let overrides = overrides("hardware.organization='pipelined'");
    let clocks = |name: &str, clock_hz| {
        let output = dir.path().join(name);
        let clocks = ClockOptions { csv: true, clock_hz, ..ClockOptions::default() };
        street(&output, &overrides, &options(clocks));
        let rows = csv_rows(&output);
        let first = rows_of(&rows, "decision").into_iter().filter(|row| row[1] == 0);
        first.map(|row| row[2]).collect::<Vec<_>>()
    };
    let (dense, timed) = (clocks("dense", None), clocks("timed", Some(1_000_000)));
    let times = fs::read_to_string(dir.path().join("timed/frames.csv")).unwrap();
    let times = times.lines().filter(|line| !line.starts_with('#')).skip(1);
    let times = times.map(|line| line.split(',').nth(1).unwrap().parse::<u64>().unwrap());
    let latency = dense[0];
    assert!(dense.iter().enumerate().all(|(frame, &clock)| clock == latency + 64 * frame as u64));
    assert!(times.zip(&timed).all(|(time, &clock)| clock == latency + time), "{timed:?}");
}

#[test]
fn all_formats_have_the_same_rows() {
    let dir = tempfile::tempdir().unwrap();
    let output = dir.path().join("out");
    let clocks = ClockOptions { csv: true, parquet: true, npy: true, ..ClockOptions::default() };
    let means = [&overrides(RASTER)[..], &["render.irrelevant='mean'"]].concat();
    street(&output, &means, &options(clocks));
    let file = File::open(output.join("clocks.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let found = reader.get_row_iter(None).unwrap().map(|row| {
        let row = row.unwrap();
        let texts: Vec<String> = row
            .get_column_iter()
            .map(|(_, field)| field.to_string().trim_matches('"').to_owned())
            .collect();
        texts.join(",").replace("true", "1").replace("false", "0")
    });
    let text = fs::read_to_string(output.join("clocks.csv")).unwrap();
    assert_eq!(found.collect::<Vec<_>>(), text.lines().skip(1).collect::<Vec<_>>());
    let array = fs::read(output.join("clocks.npy")).unwrap();
    let rows = csv_rows(&output);
    let shape = format!("'shape': ({}, 9)", rows.len());
    assert!(String::from_utf8_lossy(&array[..128]).contains(&shape), "{shape}");
    let events = ["decision", "pixels", "means", "loss"];
    let numbers = rows.iter().flat_map(|(event, numbers)| {
        let event = events.iter().position(|name| name == event).unwrap() as u64;
        [event].into_iter().chain(*numbers)
    });
    assert_eq!(array[128..], numbers.flat_map(u64::to_le_bytes).collect::<Vec<u8>>());
    assert!(events[..3].iter().all(|name| rows.iter().any(|row| row.0 == *name)), "{rows:?}");
}

/// Each row of `latency.csv` is that of the rows of its frame in `clocks.csv`. The sink is so slow
/// that regions are lost.
#[test]
fn latencies_are_those_of_the_rows_of_a_frame() {
    let dir = tempfile::tempdir().unwrap();
    let output = dir.path().join("out");
    let sink = SinkPattern::Rate { words: 1, clocks: 40 };
    let clock_hz = Some(1_000_000);
    let clocks = ClockOptions { csv: true, clock_hz, sink, ..ClockOptions::default() };
    street(&output, &overrides(RASTER), &options(clocks));
    let rows = csv_rows(&output);
    let text = fs::read_to_string(output.join("latency.csv")).unwrap();
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some("frame,clock,decision_clocks,word_clocks,waiting_regions,lost_regions")
    );
    let mut frames = 0;
    for line in lines {
        let values: Vec<u64> = line.split(',').map(|text| text.parse().unwrap()).collect();
        let own = |event: &str| {
            rows_of(&rows, event).into_iter().filter(|row| row[0] == frames).collect::<Vec<_>>()
        };
        let clocks = |event: &str| own(event).iter().map(|row| row[3]).max().unwrap() - values[1];
        assert_eq!(values[..4], [frames, values[1], clocks("decision"), clocks("pixels")]);
        assert_eq!(values[5], own("loss").len() as u64);
        assert!(values[4] > 0 && values[4] <= own("decision").len() as u64, "{line}");
        frames += 1;
    }
    assert_eq!(frames, 5);
    let lost: usize = rows_of(&rows, "loss").len();
    assert!(lost > 20, "{lost} regions were lost");
    for name in ["latency.svg", "latency.png", "waiting.svg", "waiting.png"] {
        assert!(fs::metadata(output.join(name)).unwrap().len() > 2000, "{name}");
    }
}

#[test]
fn a_set_has_no_clocks() {
    let dir = tempfile::tempdir().unwrap();
    let set = dir.path().join("images-idx3-ubyte");
    fs::write(&set, images()).unwrap();
    let output = dir.path().join("out");
    let error = run(&[&set], &[], &output, &csv_options(SinkPattern::Always)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "images of a set do not follow one another; --clocks needs a clip"
    );
    assert!(!output.exists());
}
