// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of entries of folders, trees and patterns that are not read: the warnings about them, and
//! the refusals.

use std::fs;
use std::path::Path;

use crate::common::{expect_failure, foveate, run_in};
use serde_json::Value;

const TIFF: &[u8] = b"II*\0\x08\0\0\0\0\0\0\0\0\0";
const WEBP: &[u8] = b"RIFF\x1A\0\0\0WEBPVP8L\x0D\0\0\0";

fn pgm(seed: u8) -> Vec<u8> {
    let pixels = (0..=255_u8).map(|pixel| pixel.wrapping_mul(seed));
    b"P5 16 16 255\n".iter().copied().chain(pixels).collect()
}

fn y4m() -> Vec<u8> {
    [&b"YUV4MPEG2 W16 H16 F25:1 Cmono\nFRAME\n"[..], &[7; 256]].concat()
}

/// Writes files below a folder.
fn files(folder: &Path, files: &[(&str, &[u8])]) {
    for (name, bytes) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
}

/// Returns the warnings of a run in order, without their first words.
fn warnings(folder: &Path, args: &[&str]) -> Vec<String> {
    let _ = fs::remove_dir_all(folder.join("out"));
    let outcome = run_in(folder, args);
    assert_eq!(outcome.code, 0, "{args:?}: {}", outcome.stderr);
    warnings_in(&outcome.stderr)
}

fn warnings_in(said: &str) -> Vec<String> {
    said.lines()
        .filter_map(|line| line.strip_prefix("foveate: warning: "))
        .map(str::to_owned)
        .collect()
}

/// Fails unless each warning begins with the text at its place in `starts`.
fn assert_warnings(found: &[String], starts: &[&str]) {
    let fit = found.len() == starts.len()
        && found.iter().zip(starts).all(|(found, start)| found.starts_with(start));
    assert!(fit, "{found:#?}");
}

#[cfg(unix)]
fn link(target: &str, path: &Path) {
    std::os::unix::fs::symlink(target, path).unwrap();
}

/// Writes a folder with two images and many entries that are not images.
#[cfg(unix)]
fn write_mixed_folder(folder: &Path) {
    let (one, other) = (pgm(3), pgm(5));
    files(
        folder,
        &[
            ("clip/1.pgm", &one),
            ("clip/2.webp", WEBP),
            ("clip/3.TIF", TIFF),
            ("clip/4", &one),
            ("clip/5.PGM", &other),
            ("clip/6.dat", &one),
            ("clip/8.pgm/note.txt", b"a folder"),
            // These entries are never taken for frames, so that nothing is said about them.
            ("clip/.hidden.webp", WEBP),
            ("clip/Thumbs.db", b"\0\x01"),
            ("clip/desktop.ini", b"[x]"),
            ("clip/labels.csv", b"a,b"),
            ("clip/README", b"how they were made"),
            ("clip/notes.txt", b"notes"),
            ("clip/weights.npy", b"\x93NUMPY"),
            ("clip/labels/1.txt", b"0 0.5 0.5 1 1"),
        ],
    );
    link("nowhere.pgm", &folder.join("clip/7.pgm"));
}

#[cfg(unix)]
const MIXED_FOLDER_WARNINGS: [&str; 5] = [
    "2 entries of `clip` are skipped, such as `clip/2.webp`: images of the type WebP are not read",
    "2 entries of `clip` are skipped, such as `clip/4`: it is an image or a video, but has the extension of neither",
    "`clip/7.pgm` is skipped: the target of the link does not exist",
    "`clip/8.pgm` is skipped: it has the name of an image or a video, but is not a file",
    "`clip/README` is skipped: it has no extension",
];

#[cfg(unix)]
#[test]
fn every_command_says_what_it_leaves_out_of_a_folder() {
    let dir = tempfile::tempdir().unwrap();
    write_mixed_folder(dir.path());
    files(dir.path(), &[("space.toml", b"[vary]\nregion.size = [8]\n")]);
    let few = ["--set", "frame={width=16,height=16}"];
    for args in [
        &["simulate", "clip", "-o", "out"][..],
        &["simulate", "clip", "-o", "out", "--images", "cifar-sheet"],
        &["analyze", "temporal", "clip", "-o", "out"],
        &["explore", "space.toml", "clip", "--no-area", "-o", "out"],
        &["explain", "clip", "--frame", "1", "--region", "0,0"],
    ] {
        let outcome = run_in(dir.path(), args);
        let _ = fs::remove_dir_all(dir.path().join("out"));
        // Sheets are read one at a time, but the warnings are printed nevertheless.
        assert_eq!(
            outcome.code,
            if args.contains(&"cifar-sheet") { 2 } else { 0 },
            "{}",
            outcome.stderr
        );
        assert_warnings(&warnings_in(&outcome.stderr), &MIXED_FOLDER_WARNINGS);
    }
    // The warning comes before the search for tools.
    for args in [&["fit", "clip"][..], &["link", "clip", "-o", "out"], &["cosim", "clip"]] {
        let bare = foveate(&[args, if args[0] == "cosim" { &few } else { &[] }].concat())
            .current_dir(dir.path())
            .env("PATH", "")
            .envs(
                ["YOSYS", "FFMPEG", "VERILATOR", "IVERILOG"]
                    .map(|t| (format!("FOVEATE_{t}"), "gone")),
            )
            .output();
        assert_warnings(
            &warnings_in(&String::from_utf8_lossy(&bare.unwrap().stderr)),
            &MIXED_FOLDER_WARNINGS,
        );
    }
    let summary = |args: &[&str]| -> Value {
        serde_json::from_str(&run_in(dir.path(), args).stdout).unwrap()
    };
    let out = summary(&["simulate", "clip", "-o", "out", "--json"]);
    assert_eq!(out["frames"], 2);
    let of_pattern = MIXED_FOLDER_WARNINGS.map(|text| text.replace("of `clip`", "of `clip/*`"));
    let of_pattern: Vec<&str> = of_pattern.iter().map(String::as_str).collect();
    assert_warnings(
        &warnings(dir.path(), &["simulate", "clip/*", "-o", "out", "--force"]),
        &of_pattern,
    );
}

#[cfg(unix)]
#[test]
fn a_set_says_what_it_leaves_out() {
    let dir = tempfile::tempdir().unwrap();
    let (one, film) = (pgm(3), y4m());
    files(
        dir.path(),
        &[
            ("set/cat/1.pgm", &one),
            ("set/cat/2.webp", WEBP),
            ("set/cat/more/3.pgm", &one),
            ("set/cat/film.y4m", &film),
            ("set/dog/1.tif", TIFF),
            ("set/labels/1.txt", b"0"),
        ],
    );
    link("gone", &dir.path().join("set/bird"));
    let expected = [
        "`set/bird` is skipped: the target of the link",
        "2 entries of `set` are skipped, such as `set/cat/2.webp`: images of the type WebP",
        "a set consists of images: videos in `set`, 1 in all, such as `set/cat/film.y4m`",
        "`set/cat/more` is skipped: it lies deeper",
    ];
    assert_warnings(&warnings(dir.path(), &["dataset", "set", "-o", "out"]), &expected);
    assert_warnings(
        &warnings(dir.path(), &["simulate", "set", "--images", "set", "-o", "out"]),
        &expected,
    );
}

#[cfg(unix)]
#[test]
fn a_tree_says_what_is_no_clip_and_takes_no_text_for_one() {
    let dir = tempfile::tempdir().unwrap();
    let (one, film) = (pgm(3), y4m());
    files(
        dir.path(),
        &[
            ("clips/a.y4m", &film),
            ("clips/README", b"how they were made"),
            ("clips/notes.txt", b"notes"),
            ("clips/b", &film),
            ("clips/c.h264", b"\0\0\x01\x67"),
            ("clips/scans/1.tif", TIFF),
            ("clips/cars/frames/1.pgm", &one),
            ("clips/cars/frames/2.webp", WEBP),
            ("clips/cars/frames/more/1.pgm", &one),
            ("clips/sets/train-images-idx3-ubyte", &[0, 0, 8, 3, 0, 0, 0, 0]),
            ("clips/1/2/3/4/5/6/7/8/9/a.y4m", &film),
        ],
    );
    link("..", &dir.path().join("clips/cars/up"));
    link("nowhere", &dir.path().join("clips/d.mp4"));
    let said = warnings(dir.path(), &["simulate", "clips", "-o", "out"]);
    assert_warnings(
        &said,
        &[
            "`clips/1/2/3/4/5/6/7/8/9` is skipped: it lies deeper",
            "`clips/README` is skipped: it has no extension",
            "`clips/b` is skipped: it is an image or a video, but has the extension of neither",
            "`clips/c.h264` is skipped: videos with this extension",
            "2 entries of `clips` are skipped, such as `clips/cars/frames/2.webp`: images of the type WebP",
            "images and videos in folders below `clips`, such as `clips/cars/frames/more`",
            "`clips/cars/up` is skipped: it links to a folder in which it lies itself",
            "`clips/d.mp4` is skipped: the target",
            "`clips/sets/train-images-idx3-ubyte` is skipped: data sets",
        ],
    );
    let summary = fs::read(dir.path().join("out/summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    let inputs: Vec<&str> = summary["clips"]
        .as_array()
        .unwrap()
        .iter()
        .map(|clip| clip["inputs"][0].as_str().unwrap())
        .collect();
    assert_eq!(inputs, ["clips/a.y4m", "clips/cars/frames"]);
    // A text file is not a clip of its own either.
    let parts = ["`clips/notes.txt` is not an image", "it is text"];
    expect_failure(dir.path(), 2, &["simulate", "clips/notes.txt", "-o", "no"], &parts);
    let outcome =
        run_in(dir.path(), &["simulate", "clips/a.y4m", "clips/notes.txt", "-o", "out", "--force"]);
    assert_eq!(outcome.code, 1);
    assert!(outcome.stderr.contains("1 of 2 clips are not complete"), "{}", outcome.stderr);
}

#[test]
fn images_of_a_type_that_is_not_read_are_refused_wherever_they_are() {
    let dir = tempfile::tempdir().unwrap();
    let one = pgm(3);
    files(
        dir.path(),
        &[
            ("tifs/1.tif", TIFF),
            ("tifs/2.tif", TIFF),
            ("tree/deep/1.tif", TIFF),
            ("photo.webp", WEBP),
            ("photo", WEBP),
            ("a.pgm", &one),
        ],
    );
    for inputs in [
        &["tifs/1.tif"][..],
        &["tifs/1.tif", "tifs/2.tif"],
        &["a.pgm", "tifs/1.tif"],
        &["tifs"],
        &["tifs/*.tif"],
        &["tifs/*"],
        &["tree"],
        &["photo.webp"],
        &["photo"],
    ] {
        let name = if inputs[0].starts_with("photo") { "WebP" } else { "TIFF" };
        let parts = [
            &format!("is an image of the type {name}, which is not read"),
            "convert it to PNG",
            "magick",
        ];
        for command in ["simulate", "dataset", "analyze temporal"] {
            let command: Vec<&str> = command.split(' ').collect();
            expect_failure(dir.path(), 2, &[&command[..], inputs, &["-o", "no"]].concat(), &parts);
        }
        assert!(!dir.path().join("no").exists());
    }
}

#[test]
fn frames_that_occur_twice_or_differ_in_case_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    let one = pgm(3);
    files(dir.path(), &[("a/f1.pgm", &one), ("a/f01.pgm", &one), ("a/f2.pgm", &one)]);
    files(dir.path(), &[("b/f1.pgm", &one), ("b/f2.PGM", &one), ("b/f3.ppm", &one)]);
    let twice = ["`a/f01.pgm` and `a/f1.pgm` have the same number, and both are read"];
    for input in ["a", "a/*.pgm"] {
        assert_warnings(&warnings(dir.path(), &["simulate", input, "-o", "out"]), &twice);
    }
    assert_warnings(&warnings(dir.path(), &["simulate", "b", "-o", "out"]), &[]);
    let case = ["`b/f2.PGM` is skipped: the pattern matches it only if"];
    assert_warnings(&warnings(dir.path(), &["simulate", "b/*.pgm", "-o", "out"]), &case);
    assert_warnings(&warnings(dir.path(), &["simulate", "b/f[123].p[pg]m", "-o", "out"]), &case);
}
