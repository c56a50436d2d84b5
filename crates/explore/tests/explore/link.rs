// SPDX-License-Identifier: MIT OR Apache-2.0
//! Explorations with a link behind all designs: their loads, and the folder that keeps them.

use std::fs;
use std::path::Path;

use foveate_explore::{DesignSpace, Exploration};
use foveate_media::testing::RecordingHooks;

use crate::explore::run;
use crate::unit::{files, measure_only, units};

/// The columns that a link adds, in their order.
const COLUMNS: &str = ",needed_clock_hz,delivery_longest_ns,buffer_bytes,overloaded_clips,\
     unbuffered_lost_regions,unbuffered_frames_with_losses";
const CLIPS: [&str; 2] = ["scene:street", "scene:shake"];

/// Returns a space with a design of each organization, with these lines before it.
fn space(keys: &str) -> String {
    format!(
        "{keys}\n[design]\nframe.width = 48\nframe.height = 32\n[vary]\n\
         hardware.organization = ['pipelined', 'serial', 'raster']\n"
    )
}

fn explored(keys: &str, output: &Path) -> Exploration {
    run(&space(keys), &CLIPS, output, &RecordingHooks::new()).unwrap()
}

/// Returns a table as lines without the columns of the link, and these columns.
fn split_table(file: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fs::read_to_string(file).unwrap();
    let split = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let (own, link) = cells.split_at(cells.len() - 6);
        (own.join(","), link.iter().map(|&cell| cell.to_owned()).collect())
    };
    text.lines().map(split).unzip()
}

#[test]
fn a_slow_link_loses_regions_of_raster_and_a_fast_one_none() {
    let folder = tempfile::tempdir().unwrap();
    let loads = |rate: &str| {
        let keys = format!("link = '{rate}'\nclock_mhz = 50");
        let found = explored(&keys, &folder.path().join(rate));
        found.rows.iter().map(|row| row.load.unwrap()).collect::<Vec<_>>()
    };
    let (slow, fast) = (loads("10kbit"), loads("100Mbit"));
    for (slow, fast) in slow.iter().zip(&fast) {
        assert_eq!(slow.needed_clock_hz, fast.needed_clock_hz);
        assert!(slow.delivery_longest_ns > fast.delivery_longest_ns, "{slow:?} {fast:?}");
        assert!(slow.buffer_bytes > fast.buffer_bytes, "{slow:?} {fast:?}");
        assert_eq!((slow.overloaded_clips, fast.overloaded_clips), (Some(2), Some(0)));
    }
    // A frame is taken in 64 clocks, and the shortest interval has 33,333 us.
    assert_eq!(slow[0].needed_clock_hz, 1921);
    for other in [slow[0], slow[1], fast[0], fast[1]] {
        assert_eq!(other.unbuffered_lost_regions, None);
    }
    assert!(slow[2].unbuffered_lost_regions > Some(24), "{slow:?}");
    assert!((Some(2)..=Some(24)).contains(&slow[2].unbuffered_frames_with_losses), "{slow:?}");
    assert_eq!(fast[2].unbuffered_lost_regions, Some(0));
    assert_eq!(fast[2].unbuffered_frames_with_losses, Some(0));
}

#[test]
fn the_tables_have_the_load_of_each_clip_and_are_otherwise_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let (with, without) = (folder.path().join("with"), folder.path().join("without"));
    let found = explored("link = '1Mbit'", &with);
    assert_eq!(found.link_bits_per_second, Some(1_000_000));
    let plain = explored("", &without);
    assert!(plain.rows.iter().all(|row| row.load.is_none()));
    for table in ["points.csv", "clips.csv"] {
        let (own, link) = split_table(&with.join(table));
        let expected = fs::read_to_string(without.join(table)).unwrap();
        assert_eq!(own, expected.lines().collect::<Vec<_>>(), "{table}");
        assert_eq!(format!(",{}", link[0].join(",")), COLUMNS, "{table}");
    }
    let (_, points) = split_table(&with.join("points.csv"));
    let (_, clips) = split_table(&with.join("clips.csv"));
    for (number, point) in points[1..].iter().enumerate() {
        let [street, shake] = [&clips[1 + number], &clips[4 + number]];
        for column in 0..6 {
            let of = |cells: &Vec<String>| cells[column].parse::<u64>().ok();
            let (one, other) = (of(street), of(shake));
            let sum = one.zip(other).map(|(one, other)| one + other);
            let expected = if column < 3 { one.max(other) } else { sum };
            assert_eq!(of(point), expected, "{number} {column}");
        }
    }
    let page = fs::read_to_string(with.join("report.html")).unwrap();
    assert!(page.contains("1 Mbit/s") && page.contains("last byte"), "the page has the link");
    let page = fs::read_to_string(without.join("report.html")).unwrap();
    assert!(!page.contains("last byte") && !page.contains("Mbit"), "the page has no link");
    let json = fs::read_to_string(without.join("exploration.json")).unwrap();
    assert!(!json.contains("link_bits_per_second") && !json.contains("\"load\""), "{json}");
}

#[test]
fn finished_loads_are_kept_and_those_of_another_link_are_measured() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    explored("", &output);
    let measured = |output: &Path| files(&output.join("measured"));
    // The organizations have one camera, and there are two clips.
    assert_eq!(measured(&output).len(), 2);
    explored("link = '1Mbit'", &output);
    let all = measured(&output);
    assert_eq!(all.len(), 2 + 2 * 3);
    let again = RecordingHooks::new();
    run(&space("link = '1Mbit'"), &CLIPS, &output, &again).unwrap();
    assert_eq!((again.reports().len(), measured(&output)), (0, all));
    explored("link = '2Mbit'", &output);
    assert_eq!(measured(&output).len(), 2 + 2 * 3 * 2);
    explored("link = '2Mbit'\nclock_mhz = 50", &output);
    assert_eq!(measured(&output).len(), 2 + 2 * 3 * 3);
}

#[test]
fn units_have_the_loads_of_all_their_designs() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, apart) = (folder.path().join("whole"), folder.path().join("apart"));
    let keys = "link = '1Mbit'";
    explored(keys, &whole);
    let planned = units(&space(keys), &CLIPS, &apart);
    assert_eq!(planned.len(), 2);
    for unit in &planned {
        assert_eq!(unit.combinations, [0, 1, 2]);
        let inputs: Vec<&str> = unit.inputs.iter().map(String::as_str).collect();
        let line = serde_json::to_string(unit).unwrap();
        let which = if unit.clip == "street" { &unit.name } else { &line };
        let done =
            measure_only(&space(keys), &inputs, which, &apart, &RecordingHooks::new()).unwrap();
        assert_eq!(&done, unit);
    }
    // Without the link a unit has one design for each camera.
    let plain = units(&space(""), &CLIPS, &apart);
    assert!(plain.iter().all(|unit| unit.combinations == [0]), "{plain:?}");
    assert_eq!(files(&whole.join("measured")), files(&apart.join("measured")));
    let collecting = RecordingHooks::new();
    run(&space(keys), &CLIPS, &apart, &collecting).unwrap();
    assert_eq!(collecting.reports().len(), 0, "nothing is measured again");
    assert_eq!(files(&whole), files(&apart));
}

#[test]
fn a_design_without_pixels_or_with_a_slow_clock_has_no_load() {
    let folder = tempfile::tempdir().unwrap();
    let measured = |name: &str, own: &str| {
        let text = format!(
            "link = '1Mbit'\nclock_mhz = 1\n[design]\nframe.width = 48\nframe.height = 32\n{own}\n"
        );
        let output = folder.path().join(name);
        let found = run(&text, &["scene:street"], &output, &RecordingHooks::new()).unwrap();
        let (_, points) = split_table(&output.join("points.csv"));
        (found.rows.iter().map(|row| row.load).collect::<Vec<_>>(), points)
    };
    let forward = "hardware.organization = 'raster'\n[vary]\nhardware.forward = [true, false]";
    let (loads, points) = measured("forward", forward);
    assert!(loads[0].is_some() && loads[1].is_none(), "{loads:?}");
    assert!(points[1].iter().all(|cell| !cell.is_empty()), "{points:?}");
    assert!(points[2].iter().all(String::is_empty), "{points:?}");
    // 24 slots of some thousand clocks each do not fit into 33 ms.
    let (loads, points) = measured("slow", "hardware = { organization = 'serial', fold = 24 }");
    let slow = loads[0].unwrap();
    assert!(slow.needed_clock_hz > 1_000_000, "{slow:?}");
    assert_eq!((slow.delivery_longest_ns, slow.buffer_bytes), (None, None));
    assert_eq!(points[1][0], slow.needed_clock_hz.to_string());
    assert!(points[1][1..].iter().all(String::is_empty), "{points:?}");
}

#[test]
fn a_link_without_a_unit_and_a_set_are_refused() {
    let refused = |text: &str| DesignSpace::from_toml(text).unwrap_err().to_string();
    let found = refused("link = '100'\n");
    assert!(found.contains("link = \"100\"") && found.contains("100Mbit"), "{found}");
    assert!(refused("link = 100\n").contains("string"), "a number has no unit");
    let folder = tempfile::tempdir().unwrap();
    let images = folder.path().join("images-idx3-ubyte");
    let header = [0, 0, 8, 3, 0, 0, 0, 2, 0, 0, 0, 32, 0, 0, 0, 48];
    fs::write(&images, [&header[..], &[7; 2 * 32 * 48]].concat()).unwrap();
    let (input, output) = (images.to_str().unwrap(), folder.path().join("out"));
    let found = run(&space("link = '1Mbit'"), &[input], &output, &RecordingHooks::new());
    let found = found.unwrap_err().to_string();
    assert!(found.contains("unrelated images, which have no rate"), "{found}");
}
