// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate explore --liberty`: the figures of all designs of a space in the cells of a process.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::silicon::{is_ready, number, write_clip};
use crate::common::{run_in, run_successfully};

/// A space of three organizations: RPUs and lanes have an energy, and a core of `raster` has none.
const SPACE: &str = "preset = 'bare'\nmethod = 'each'\nclock_mhz = 900\n[design]\nregion.size = 4\n\
     [vary]\nhardware.organization = ['serial', 'raster']\n";
const INPUTS: [&str; 4] = ["explore", "space.toml", "clip", "--quiet"];

/// Explores the space into `out`. Returns the points.
fn explore(folder: &Path, args: &[&str]) -> Value {
    let found = run_successfully(folder, &[&INPUTS[..], &["--json", "-o", "out"], args].concat());
    serde_json::from_str(&found).unwrap()
}

/// Returns the cells of a column of `points.csv`.
fn column(folder: &Path, name: &str) -> Vec<String> {
    let text = fs::read_to_string(folder.join("out/points.csv")).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned));
    let place = lines.next().unwrap().position(|column| column == name);
    let place = place.unwrap_or_else(|| panic!("{name}: {text}"));
    lines.map(|mut cells| cells.nth(place).unwrap()).collect()
}

/// The figures are those of `estimate` for the same design and clip, in every file.
#[test]
#[ignore = "a minute of synthesis; scripts/release.sh whole runs it"]
fn points_have_the_figures_of_estimate_and_are_not_measured_twice() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    write_clip(dir.path(), 16);
    fs::write(dir.path().join("space.toml"), SPACE).unwrap();
    let args = ["--energy", "60", "--liberty"];
    let found = explore(dir.path(), &args);
    let rows = found["rows"].as_array().unwrap();
    assert_eq!((rows.len(), &found["energy_rate"]), (3, &60.0.into()), "{found}");
    let organization = |row: &Value| row["settings"][0].as_str().unwrap().to_owned();
    for row in rows {
        let config = format!("out/designs/{}.toml", row["number"]);
        let estimate = ["estimate", "--json", "--quiet", "--config", &config];
        let activity = ["--activity", "clip", "--fps", "60"];
        let is_raster = organization(row).contains("raster");
        let activity = if is_raster { &[][..] } else { &activity[..] };
        let report = [&estimate[..], activity, &["--liberty"]].concat();
        let report: Value = serde_json::from_str(&run_successfully(dir.path(), &report)).unwrap();
        let process = &row["process"];
        let equal =
            |one: f64, other: f64| assert!((one - other).abs() <= 1e-9 * one, "{one} {other}");
        equal(number(process, "/unit_um2"), number(&report, "/unit/cells/area_um2"));
        equal(number(process, "/mm2"), number(&report, "/array/area_um2") / 1e6);
        // The clock of the space is above that of the cells.
        assert_eq!(row["speed"]["clock_mhz"], process["clock_mhz"]);
        assert_eq!(process["energy"].is_null(), is_raster, "{row}");
        if !is_raster {
            let power = number(&report, "/energy/stretches/1/stopped_clock_mw");
            equal(number(process, "/energy/usual_mw"), power);
        }
    }
    let cells = column(dir.path(), "usual_mw");
    assert_eq!(cells.iter().filter(|cell| cell.is_empty()).count(), 1, "{cells:?}");
    assert!(column(dir.path(), "front_energy").contains(&"true".to_owned()));
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    for text in ["Error against energy", "mm² of the array", "osu018_stdcells"] {
        assert!(page.contains(text), "{text}");
    }
    // A kept energy is used again; here it is another one, to tell.
    let kept = fs::read_dir(dir.path().join("out/measured")).unwrap();
    let kept = kept.map(|file| file.unwrap().path());
    let of_energy =
        kept.filter(|path| fs::read_to_string(path).unwrap().contains("stopped_clock_mw"));
    let of_energy: Vec<_> = of_energy.collect();
    assert_eq!(of_energy.len(), 2);
    for path in of_energy {
        let mut report: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
        report["stretches"][1]["stopped_clock_mw"] = 7.0.into();
        fs::write(&path, report.to_string()).unwrap();
    }
    explore(dir.path(), &args);
    let powers = || column(dir.path(), "usual_mw");
    assert_eq!(powers(), ["7", "7", ""]);
    // Another frame rate is another measurement, and without it there is none.
    explore(dir.path(), &["--liberty"]);
    assert_eq!(powers(), ["", "", ""]);
    let space = SPACE.split_once("[vary]").unwrap().0;
    fs::write(dir.path().join("space.toml"), space).unwrap();
    explore(dir.path(), &["--energy", "30", "--liberty"]);
    assert!(powers().len() == 1 && !["7", ""].contains(&powers()[0].as_str()), "{:?}", powers());
    assert!(column(dir.path(), "mm2").iter().all(|cell| !cell.is_empty()));
}

/// A clip that ends early may be complete the next time, so nothing is kept of it.
#[test]
#[ignore = "a design is mapped and simulated twice; scripts/release.sh whole runs it"]
fn a_clip_that_ends_early_has_no_energy() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("space.toml"), SPACE.split_once("[vary]").unwrap().0).unwrap();
    let clip = |frames: usize, last: usize| {
        let frame = |number: usize| {
            let pixels = (0..128).map(|pixel| u8::try_from(pixel * number % 251).unwrap());
            [b"FRAME\n".to_vec(), pixels.collect()].concat()
        };
        let header = b"YUV4MPEG2 W16 H8 F25:1 Cmono\n".to_vec();
        let mut bytes = [header, (0..frames).flat_map(frame).collect()].concat();
        bytes.truncate(bytes.len() - last);
        fs::write(dir.path().join("clip.y4m"), bytes).unwrap();
    };
    let args = ["explore", "space.toml", "clip.y4m", "--quiet", "--json", "-o", "out"];
    let args = [&args[..], &["--energy", "30", "--liberty"]].concat();
    clip(9, 20);
    let cut = run_in(dir.path(), &args);
    assert!(cut.code == 1 && cut.stderr.contains("no energy is given"), "{}", cut.stderr);
    let found: Value = serde_json::from_str(&cut.stdout).unwrap();
    assert!(found["rows"][0]["process"]["energy"].is_null(), "{found}");
    assert_eq!(fs::read_dir(dir.path().join("out/measured")).unwrap().count(), 0);
    clip(9, 0);
    let whole = run_in(dir.path(), &args);
    assert_eq!(whole.code, 0, "{}", whole.stderr);
    // The second run has the figures of the first one, digit for digit.
    let again = run_in(dir.path(), &args);
    assert_eq!(whole.stdout, again.stdout);
}

/// The fronts and the texts name the same area, also if no point has one.
#[test]
#[ignore = "half a minute of synthesis; scripts/release.sh whole runs it"]
fn a_front_without_areas_is_named_so() {
    if !is_ready() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    write_clip(dir.path(), 16);
    fs::write(dir.path().join("space.toml"), SPACE).unwrap();
    let args = ["explore", "space.toml", "clip", "-o", "out", "--memory-limit", "0", "--liberty"];
    let text = run_successfully(dir.path(), &args);
    assert!(text.contains("Error against frames per second: ") && !text.contains("mm²"), "{text}");
    assert!(column(dir.path(), "mm2").iter().all(String::is_empty));
    assert!(column(dir.path(), "front_area").iter().all(|cell| cell == "false"));
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(!page.contains("Error against area") && !page.contains("Error against mm²"));
}
