// SPDX-License-Identifier: MIT OR Apache-2.0
//! A known clip with known objects, and their counts in the study.

mod counted;
mod inputs;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use foveate_design::DesignConfig;
use foveate_explore::studies::{Study, StudyError, StudyReport, StudyRequest, analyze};
use foveate_media::{InputOptions, SilentHooks};

/// The tracks and boxes of the objects, in frames of 4x2 regions: regions 0 and 1, region 6, and
/// region 3.
const MOT: [(u32, [u32; 4]); 3] = [(1, [0, 0, 16, 8]), (2, [16, 8, 8, 8]), (3, [24, 0, 8, 8])];
/// The patterns of region 0, of region 6 and of all other regions in each frame: 0 and 1 are edges
/// with light and dark swapped.
const SHOWN: [[u8; 3]; 4] = [[0, 0, 0], [1, 0, 0], [0, 0, 0], [1, 1, 0]];

/// Draws a frame in which every region has an edge in its middle; `zoom` enlarges pixels, and
/// `edge` is the width of a border.
fn frame(number: usize, zoom: usize, edge: usize) -> (usize, usize, Vec<u8>) {
    let (width, height) = (32 * zoom + 2 * edge, 16 * zoom + 2 * edge);
    let mut pixels = vec![90; width * height];
    for (y, x) in (0..16 * zoom).flat_map(|y| (0..32 * zoom).map(move |x| (y, x))) {
        let (column, row) = (x / zoom / 8, y / zoom / 8);
        let [first, sixth, others] = SHOWN[number];
        let swapped = match 4 * row + column {
            0 => first,
            6 => sixth,
            _ => others,
        };
        let light = (x / zoom % 8 < 4) == (swapped == 0);
        pixels[(y + edge) * width + x + edge] = if light { 200 } else { 20 };
    }
    (width, height, pixels)
}

fn images(folder: &Path, zoom: usize, edge: usize) {
    fs::create_dir_all(folder).unwrap();
    for number in 0..SHOWN.len() {
        let (width, height, pixels) = frame(number, zoom, edge);
        let image = [format!("P5 {width} {height} 255\n").into_bytes(), pixels].concat();
        fs::write(folder.join(format!("{:06}.pgm", number + 1)), image).unwrap();
    }
}

/// Returns the rows of all objects in all frames, in the format of MOT.
fn mot_rows(zoom: u32, edge: u32) -> String {
    let mut text = String::new();
    for (frame, (track, [x, y, w, h])) in
        (1..=SHOWN.len()).flat_map(|frame| MOT.map(|object| (frame, object)))
    {
        let [x, y] = [x, y].map(|at| at * zoom + edge + 1);
        let (w, h) = (w * zoom, h * zoom);
        writeln!(text, "{frame},{track},{x},{y},{w},{h},1,1,1").unwrap();
    }
    text
}

fn config() -> DesignConfig {
    let isolated = "region.neighborhood = \"isolated\"";
    DesignConfig::from_toml_with("", &[isolated, "denoise.filter=\"none\""]).unwrap()
}

fn recall(
    inputs: &[PathBuf],
    boxes: &[PathBuf],
    input: &InputOptions,
    out: &Path,
) -> Result<StudyReport, StudyError> {
    recall_of(&config(), inputs, boxes, input, out)
}

fn recall_of(
    config: &DesignConfig,
    inputs: &[PathBuf],
    boxes: &[PathBuf],
    input: &InputOptions,
    out: &Path,
) -> Result<StudyReport, StudyError> {
    let (study, sensor_events, sensor_start_us) = (Study::Recall, None, 0);
    let request =
        StudyRequest { study, inputs, input, config, sensor_events, sensor_start_us, boxes };
    analyze(&request, out, true, &SilentHooks)
}

/// Returns the cells of a row of the unchanged design.
fn row<'a>(report: &'a StudyReport, clip: &str, vote: &str, class: (&str, &str)) -> &'a [String] {
    let wanted = [clip, "design", "", vote, class.0, class.1];
    let mut rows = report.rows.iter().filter(|row| row[..6] == wanted);
    let row = rows.next().unwrap_or_else(|| panic!("no row {wanted:?} in {:?}", report.rows));
    assert!(rows.next().is_none(), "twice: {wanted:?}");
    &row[6..13]
}

/// Checks the counts of the known clip, in whatever form it was given. They were found by hand in
/// frames 1 to 3, with three objects each.
fn check_known(report: &StudyReport, clip: &str, folder: &Path) {
    let known = ["9", "0.555556", "0.444444", "0.444444", "0.111111", "", "87"];
    assert_eq!(row(report, clip, "active", ("all", "all")), known);
    assert_eq!(row(report, clip, "active", ("size", "small")), known);
    assert_eq!(row(report, clip, "active", ("speed", "still")), known);
    let relevant = ["9", "0.000000", "1.000000", "1.000000", "1.000000", "", "87"];
    assert_eq!(row(report, clip, "srs", ("all", "all")), relevant);
    let tracks = ["3", "0.333333", "0.666667", "0.666667", "0.333333", "3", "87"];
    assert_eq!(row(report, clip, "active", ("track", "all")), tracks);
    let table = fs::read_to_string(folder.join("recall-tracks.csv")).unwrap();
    let rows: Vec<&str> = table.lines().filter(|line| !line.starts_with('#')).collect();
    let columns = "clip,track,frames,some,quarter,half,all,longest_gap";
    let expected =
        ["1,3,3,3,3,0,0", "2,3,1,1,1,1,2", "3,3,0,0,0,0,3"].map(|row| format!("{clip},{row}"));
    assert_eq!((rows[0], &rows[1..]), (columns, &expected.each_ref().map(String::as_str)[..]));
}
