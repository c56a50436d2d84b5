// SPDX-License-Identifier: MIT OR Apache-2.0
//! Zones from configuration files and images, through all commands that compute frames.

use std::fs;
use std::path::Path;

use crate::common::{expect_failure, run_successfully};

/// A map of 4 x 3 regions.
const CODES: [u8; 12] = [1, 1, 1, 1, 0, 2, 2, 0, 0, 0, 0, 3];
const FILE: &str = "[frame]\nwidth = 32\nheight = 24\n[zones]\nmap = \"map.pgm\"\n\
                    [zones.keen]\ntemporal = { level = 3 }\n";

/// Writes an image of one byte per pixel.
fn write_image(path: &Path, (width, height): (usize, usize), pixel: impl Fn(usize, usize) -> u8) {
    let mut bytes = format!("P5 {width} {height} 255\n").into_bytes();
    bytes.extend(
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)),
    );
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_map_has_a_pixel_for_each_region_or_for_each_pixel() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("designs");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("camera.toml"), FILE).unwrap();
    let check = |map: &str| {
        let found = run_successfully(dir.path(), &["check", "--config", "designs/camera.toml"]);
        assert!(
            found.contains("zones             5 normal, 4 off, 2 keen, 1 always regions"),
            "{map}"
        );
        assert!(found.contains("keen              temporal level 3\n"), "{found}");
    };
    // The map is in the folder of the file.
    write_image(&folder.join("map.pgm"), (4, 3), |x, y| CODES[4 * y + x]);
    check("regions");
    write_image(&folder.join("map.pgm"), (32, 24), |x, y| CODES[4 * (y / 8) + x / 8]);
    check("pixels");
    // A path of `--set` is relative to the working folder.
    let set =
        ["check", "--config", "designs/camera.toml", "--set", "zones.map=\"designs/map.pgm\""];
    assert!(run_successfully(dir.path(), &set).contains("4 off"));
}

/// The folder of the file is that of its map, also if `--set` changes other keys of the zones.
#[test]
fn a_map_stays_in_the_folder_of_its_file_beside_other_keys() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("designs");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("camera.toml"), FILE).unwrap();
    write_image(&folder.join("map.pgm"), (4, 3), |x, y| CODES[4 * y + x]);
    write_image(&dir.path().join("map.pgm"), (4, 3), |_, _| 3);
    let check = |setting: &str, expected: &str| {
        let set = ["check", "--config", "designs/camera.toml", "--set", setting];
        let found = run_successfully(dir.path(), &set);
        assert!(found.contains(expected), "{setting}: {found}");
    };
    for setting in ["zones.keen.temporal.level=5", "zones.areas=[]", " zones.keen={}"] {
        check(setting, "5 normal, 4 off, 2 keen, 1 always");
    }
    check("zones.map=\"map.pgm\"", "12 always");
    check("zones={map='map.pgm'}", "12 always");
}

#[test]
fn maps_that_do_not_fit_are_refused_with_their_place() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("camera.toml"), FILE).unwrap();
    let fails = |parts: &[&str]| {
        expect_failure(dir.path(), 2, &["check", "--config", "camera.toml"], parts);
    };
    fails(&["map.pgm"]);
    write_image(&dir.path().join("map.pgm"), (4, 3), |x, _| if x == 2 { 9 } else { 0 });
    fails(&["map.pgm", "pixel (2, 0) is (9, 9, 9)", "black or 0 is normal"]);
    write_image(&dir.path().join("map.pgm"), (5, 3), |_, _| 0);
    fails(&["3 rows of 5 classes", "3 rows of 4 classes", "24 rows of 32"]);
    // A map and classes would say the same twice.
    let both = ["check", "--config", "camera.toml", "--set", "zones.classes=[\"0\"]"];
    expect_failure(dir.path(), 2, &both, &["zones.map", "map.pgm", "zones.classes"]);
    let text = FILE.replace("map = \"map.pgm\"", "classes = [\"0123\", \"4000\", \"0000\"]");
    fs::write(dir.path().join("camera.toml"), text).unwrap();
    fails(&["zones.classes[1]", "'4'"]);
    let text =
        FILE.replace("map = \"map.pgm\"", "areas = [{ class = \"of\", rectangle = [0, 0, 8, 8] }]");
    fs::write(dir.path().join("camera.toml"), text).unwrap();
    fails(&["zones.areas[0].class", "\"off\""]);
}

/// A run follows the map, and so does a run of the design that a core comes with, without the image.
#[test]
fn a_written_design_has_the_classes_of_the_map() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("camera.toml"), FILE).unwrap();
    write_image(&dir.path().join("map.pgm"), (4, 3), |x, y| CODES[4 * y + x]);
    run_successfully(dir.path(), &["generate", "--config", "camera.toml", "-o", "core"]);
    let run = |config: &str, output: &str| {
        let args = ["simulate", "scene:street", "--frames", "6", "-o", output, "--config", config];
        run_successfully(dir.path(), &args);
        fs::read(dir.path().join(output).join("srs.npy")).unwrap()
    };
    let srs = run("camera.toml", "out");
    // The array has a byte for each region behind its header.
    for frame in srs[srs.len() - 6 * CODES.len()..].chunks(CODES.len()) {
        assert_eq!((&frame[..4], frame[11]), (&[0; 4][..], 1));
    }
    fs::remove_file(dir.path().join("map.pgm")).unwrap();
    assert_eq!(run("core/design.toml", "again"), srs);
    let explain = ["explain", "scene:street", "--config", "core/design.toml"];
    let explain = [&explain[..], &["--frame", "2", "--region", "1,0"]].concat();
    let told = run_successfully(dir.path(), &explain);
    assert!(told.contains("class off: SRS is 0, whatever the votes are"), "{told}");
    assert!(told.contains("SRS 0 (by the class, not by the votes)"), "{told}");
}
