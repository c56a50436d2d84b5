// SPDX-License-Identifier: MIT OR Apache-2.0
//! Zones from configuration files and images, through all commands that compute frames.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{expect_failure, run_in, run_successfully};

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

/// Makes the folder `designs` with a configuration, and returns its path.
fn designs_folder(dir: &Path, text: &str) -> PathBuf {
    let folder = dir.join("designs");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("camera.toml"), text).unwrap();
    folder
}

#[test]
fn a_map_has_a_pixel_for_each_region_or_for_each_pixel() {
    let dir = tempfile::tempdir().unwrap();
    let folder = designs_folder(dir.path(), FILE);
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
    let folder = designs_folder(dir.path(), FILE);
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

/// `build` reads a map as the other commands do.
#[test]
fn a_board_takes_a_map() {
    let dir = tempfile::tempdir().unwrap();
    let text = "[frame]\nwidth = 64\nheight = 48\n[hardware]\norganization = \"raster\"\ninterface = \"axi\"\n\
                [zones]\nmap = \"map.pgm\"\n";
    let folder = designs_folder(dir.path(), text);
    write_image(&folder.join("map.pgm"), (8, 6), |x, _| u8::from(x > 3));
    let args = ["--board", "ulx3s", "--project", "--config", "designs/camera.toml", "-o", "out"];
    run_successfully(dir.path(), &[&["build"], &args[..]].concat());
    let design = fs::read_to_string(dir.path().join("out/design.toml")).unwrap();
    assert!(design.contains("\"00001111\""), "{design}");
}

#[test]
fn errors_name_the_key_and_the_file_that_are_wrong() {
    let dir = tempfile::tempdir().unwrap();
    let fails = |args: &[&str], parts: &[&str]| {
        expect_failure(dir.path(), 2, &[&["check"], args].concat(), parts)
    };
    // Without a size the frame is that of the paper, and classes must fit it.
    fails(&["--set", "zones.classes=[\"11\",\"11\"]"], &["zones.classes", "28 rows of 28"]);
    let area = "zones.areas=[{class='off',rectangle=[200,0,30,8]}]";
    fails(&["--set", area], &["zones.areas[0].rectangle", "224x224"]);
    let huge = "zones.areas=[{class='off',polygon=[[0,0],[4294967295,0],[4294967295,4294967295]]}]";
    fails(&["--set", huge], &["zones.areas[0].polygon", "[4294967295, 0]"]);
    fails(&["--set", "zones.keen.spatial.0.level=5"], &["`zones.keen.spatial` has no entries"]);
    let inherited = [
        ("temporal", "zones.keen.temporal.min_count=3", "`temporal.level`"),
        ("spatial.0", "zones.keen.spatial=[{feature='edge',min_score=3}]", "`spatial.level`"),
    ];
    for (table, keen, own_key) in inherited {
        let level = if table == "temporal" { 255 } else { 1530 };
        let minimum = if table == "temporal" { "min_count" } else { "min_score" };
        let (level, minimum) = (format!("{table}.level={level}"), format!("{table}.{minimum}=0"));
        let set = ["--set", &level, "--set", &minimum, "--set", keen];
        fails(&set, &["zones.keen.", "keen regions have it from", own_key]);
    }
    fs::write(dir.path().join("camera.toml"), FILE).unwrap();
    write_image(&dir.path().join("map.pgm"), (4, 3), |_, _| 0);
    let set = ["check", "--config", "camera.toml", "--set", "temporal.level=999"];
    let said = run_in(dir.path(), &set).stderr;
    assert!(said.starts_with("foveate: `temporal.level` = 999"), "{said}");
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
