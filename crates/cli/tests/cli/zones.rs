// SPDX-License-Identifier: MIT OR Apache-2.0
//! Zones from configuration files and images, through all commands that compute frames.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::run_successfully;

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
}
