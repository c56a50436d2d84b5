// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of inputs that are not of the type for which they were taken, and of the messages about
//! them.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{expect_failure, run_in};
use foveate_tools::{
    Tool,
    testing::{data_folder, require_tools},
};

fn ffmpeg(folder: &Path, args: &str) {
    let args = args.split_whitespace();
    let status =
        Command::new("ffmpeg").args(["-v", "error"]).args(args).current_dir(folder).status();
    assert!(status.unwrap().success());
}

/// Returns the messages on standard error of a run that succeeds.
fn messages(folder: &Path, args: &[&str]) -> String {
    let _ = fs::remove_dir_all(folder.join("out"));
    let outcome = run_in(folder, &[args, &["-o", "out", "--quiet"]].concat());
    assert_eq!(outcome.code, 0, "{args:?}: {}", outcome.stderr);
    outcome.stderr
}

fn pgm(path: &Path, (width, height): (usize, usize), pixel: impl Fn(usize, usize) -> u8) {
    let mut bytes = format!("P5 {width} {height} 255\n").into_bytes();
    bytes.extend(
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)),
    );
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_file_of_several_videos_is_told_of_and_one_is_chosen() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let source = |size: &str| format!("-f lavfi -i testsrc2=size={size}:rate=10:duration=0.3");
    let sources = [source("64x48"), source("32x24")].join(" ");
    ffmpeg(dir.path(), &format!("{sources} -map 0 -map 1 -c:v ffv1 two.mkv"));
    for (choice, size) in [(&[][..], "64x48"), (&["--video-stream", "1"], "32x24")] {
        let said = messages(dir.path(), &[&["simulate", "two.mkv"], choice].concat());
        assert_eq!(said.contains("warning: `two.mkv` has 2 video streams"), choice.is_empty());
        let summary = fs::read(dir.path().join("out/summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
        let found = format!("{}x{}", summary["width"], summary["height"]);
        assert_eq!((found.as_str(), &summary["complete"]), (size, &true.into()), "{said}");
    }
    let other = ["simulate", "two.mkv", "--video-stream", "2", "-o", "no"];
    expect_failure(dir.path(), 2, &other, &["no video stream 2"]);
}

#[test]
fn an_animated_png_is_a_clip() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("frames")).unwrap();
    ffmpeg(dir.path(), "-f lavfi -i testsrc2=size=64x48:rate=10:duration=0.5 frames/%d.png");
    ffmpeg(dir.path(), "-framerate 10 -i frames/%d.png -f apng moving.png");
    let scores = |input: &str| {
        assert_eq!(messages(dir.path(), &["simulate", input, "--rate", "10"]), "");
        fs::read(dir.path().join("out/score_edge.npy")).unwrap()
    };
    // The clip has all five frames, with the same pixels as the pictures.
    assert_eq!(scores("moving.png"), scores("frames"));
    fs::copy(dir.path().join("moving.png"), dir.path().join("frames/6.png")).unwrap();
    let parts = ["`frames/6.png` holds several frames", "on its own"];
    expect_failure(dir.path(), 2, &["simulate", "frames", "-o", "no"], &parts);
    expect_failure(dir.path(), 2, &["dataset", "frames", "-o", "no"], &parts);
}

/// The inputs are a picture whose rows are pictures themselves, and a photograph of the same shape.
#[test]
fn a_sheet_is_told_from_a_photograph() {
    let dir = tempfile::tempdir().unwrap();
    // Every row is a ramp of 32x32 pixels with another brightness and direction.
    pgm(&dir.path().join("sheet.pgm"), (1024, 40), |x, y| {
        let (column, row) = (x % 32, x / 32);
        ((y * 97) % 150 + if y % 2 == 0 { column + row } else { 62 - column - row }).to_le_bytes()
            [0]
    });
    pgm(&dir.path().join("photo.pgm"), (1024, 40), |x, y| ((x / 5 + y * 2) % 256).to_le_bytes()[0]);
    let warned = messages(dir.path(), &["simulate", "sheet.pgm"]);
    assert!(warned.contains("`sheet.pgm` looks like a CIFAR sheet"), "{warned}");
    assert_eq!(messages(dir.path(), &["simulate", "photo.pgm"]), "");
    let sheet = ["--images", "cifar-sheet"];
    assert_eq!(messages(dir.path(), &[&["simulate", "sheet.pgm"], &sheet[..]].concat()), "");
    let warned = messages(dir.path(), &[&["simulate", "photo.pgm"], &sheet[..]].concat());
    assert!(warned.contains("`photo.pgm` looks like a photograph"), "{warned}");
}

/// This test uses real sheets, if the environment variable FOVEATE_DATA names their folder.
#[test]
fn a_real_sheet_is_recognized() {
    let Some(data) = data_folder() else { return };
    let dir = tempfile::tempdir().unwrap();
    let sheet = data.join("cifar10/cifar10_batch_0.png");
    let sheet = sheet.to_str().unwrap();
    assert!(messages(dir.path(), &["simulate", sheet]).contains("looks like a CIFAR sheet"));
    assert_eq!(
        messages(dir.path(), &["simulate", sheet, "--images", "cifar-sheet", "--frames", "9"]),
        ""
    );
    let photo = data.join("mosquito/aedes");
    let args = ["simulate", photo.to_str().unwrap(), "--frames", "1", "--resize", "64x64"];
    assert_eq!(messages(dir.path(), &args), "");
}
