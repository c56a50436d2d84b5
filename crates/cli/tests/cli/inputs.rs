// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the inputs of `simulate`, end to end: streams, video, sets, batches, and the exit code
//! of each fault.

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::Command;

use crate::common::{expect_failure, foveate, run_in, run_successfully};
use foveate_tools::{Tool, testing::require_tools};
use serde_json::Value;

/// Returns a stream of `frames` frames of 16x16 pixels, 25 per second.
fn y4m(frames: u8) -> Vec<u8> {
    let mut bytes = b"YUV4MPEG2 W16 H16 F25:1 Cmono\n".to_vec();
    for frame in 0..frames {
        bytes.extend(b"FRAME\n");
        bytes.extend((0..=255u8).map(|pixel| pixel.wrapping_mul(frame + 1)));
    }
    bytes
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

#[test]
fn a_stream_comes_through_standard_input() {
    let dir = tempfile::tempdir().unwrap();
    let args =
        ["simulate", "-", "-o", "out", "--input-fps", "5", "--start", "0.2", "--resize", "8x8"];
    let output = foveate(&args).current_dir(dir.path()).write_stdin(y4m(20)).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = fs::read_to_string(dir.path().join("out/frames.csv")).unwrap();
    let times: Vec<&str> = table.lines().skip(1).map(|l| l.split(',').nth(1).unwrap()).collect();
    assert_eq!(times, ["200000", "400000", "600000"]);
    let cut = y4m(3)[..700].to_vec();
    let args = ["simulate", "-", "-o", "cut"];
    let output = foveate(&args).current_dir(dir.path()).write_stdin(cut).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("`cut` is not complete: after 2 frames"), "{said}");
    assert_eq!(json(&dir.path().join("cut/summary.json"))["complete"], false);
    let archive =
        foveate(&["simulate", "-", "-o", "none"]).write_stdin("PK\x03\x04").output().unwrap();
    let said = String::from_utf8(archive.stderr).unwrap();
    assert!(
        said.contains("ZIP archive `standard input`") && said.contains("write it into a file"),
        "{said}"
    );
    let output = foveate(&["simulate", "-", "-o", "none"]).write_stdin("").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}

/// Every summary of a video names the range of its luma, and the full range has other pixels.
#[test]
fn the_range_of_luma_is_chosen_and_named() {
    let dir = tempfile::tempdir().unwrap();
    // The gradients are 96 as the luma was coded, and 112 in the full range; the threshold is 100.
    let pixels: Vec<u8> = (0..256).map(|pixel| if pixel % 4 < 2 { 16 } else { 40 }).collect();
    let frame = [b"FRAME\n".to_vec(), pixels, vec![128; 128]].concat();
    let header = b"YUV4MPEG2 W16 H16 F25:1 C420 XCOLORRANGE=LIMITED\n".to_vec();
    fs::write(dir.path().join("a.y4m"), [header, frame.repeat(4)].concat()).unwrap();
    let space = "preset = 'bare'\nmethod = 'grid'\n[vary]\n";
    fs::write(dir.path().join("space.toml"), space).unwrap();
    let mut active = Vec::new();
    for (range, option) in
        [("coded", &[][..]), ("full", &["--luma", "full"]), ("coded", &["--luma=coded"])]
    {
        let with = |args: &[&str]| run_successfully(dir.path(), &[args, option].concat());
        with(&["simulate", "a.y4m", "--preset", "bare", "--quiet", "-o", "out", "--force"]);
        let summary = json(&dir.path().join("out/summary.json"));
        assert_eq!(summary["luma"], range);
        active.push(summary["active_share"].clone());
        let explore = ["explore", "space.toml", "a.y4m", "--no-area", "--quiet", "--json"];
        let explored = with(&[&explore[..], &["-o", "space"]].concat());
        let explored: Value = serde_json::from_str(&explored).unwrap();
        assert_eq!(explored["luma"], range);
        let analyzed =
            with(&["analyze", "size", "a.y4m", "--quiet", "--json", "-o", "size", "--force"]);
        let analyzed: Value = serde_json::from_str(&analyzed).unwrap();
        assert_eq!(analyzed["luma"], range);
        // Finished results of another range are not used.
        assert_eq!(explored["rows"][0]["figures"]["active"], summary["active_share"]);
    }
    assert_eq!(active, [0.0, 0.25, 0.0]);
    let scene = ["simulate", "scene:street", "--frames", "2", "--luma", "full", "-o", "scene"];
    run_successfully(dir.path(), &[&scene[..], &["--quiet"]].concat());
    assert!(json(&dir.path().join("scene/summary.json")).get("luma").is_none());
}

/// Inputs in the folder that `--force` replaces would be deleted, so they are refused.
#[test]
fn inputs_in_the_output_folder_are_kept() {
    let dir = tempfile::tempdir().unwrap();
    let simulated = ["simulate", "scene:street", "--frames", "2", "-o", "s", "--packets"];
    run_successfully(dir.path(), &simulated);
    let said = "lies in the folder";
    for args in [
        &["decode", "s/packets.bin", "-o", "s"][..],
        &["simulate", "s/rendered", "-o", "s"],
        &["simulate", "s/rendered/*.png", "-o", "s"],
        &["simulate", "s", "-o", "s"],
    ] {
        expect_failure(dir.path(), 2, &[args, &["--force"]].concat(), &[said, "another folder"]);
    }
    assert!(dir.path().join("s/packets.bin").exists());
    run_successfully(dir.path(), &[&simulated[..], &["--force"]].concat());
}

/// A clip whose name is that of the summary of a batch gets another folder.
#[test]
fn a_clip_may_be_called_like_a_summary() {
    let dir = tempfile::tempdir().unwrap();
    for name in ["clips/summary.json", "clips/b"] {
        fs::create_dir_all(dir.path().join(name)).unwrap();
        let image = [b"P5 8 8 255\n".as_slice(), &[7; 64]].concat();
        fs::write(dir.path().join(name).join("0.pgm"), image).unwrap();
    }
    run_successfully(dir.path(), &["simulate", "clips", "-o", "out", "--preset", "bare"]);
    assert!(dir.path().join("out/summary.json").is_file());
    assert!(dir.path().join("out/summary.json-2").is_dir());
}

#[test]
fn a_folder_of_clips_is_a_batch() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir_all(dir.path().join("clips/cars")).unwrap();
    fs::write(dir.path().join("clips/a.y4m"), y4m(3)).unwrap();
    fs::write(dir.path().join("clips/cars/b.y4m"), y4m(4)).unwrap();
    let text = run_successfully(dir.path(), &["simulate", "clips", "-o", "out"]);
    assert!(text.contains("2 clips, 7 frames"), "{text}");
    assert_eq!(json(&dir.path().join("out/cars/b/summary.json"))["frames"], 4);
    fs::write(dir.path().join("clips/c.y4m"), "YUV4MPEG2 broken").unwrap();
    let outcome = run_in(dir.path(), &["simulate", "clips", "-o", "out", "--force", "--json"]);
    assert_eq!(outcome.code, 1, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("1 of 3 clips are not complete"), "{}", outcome.stderr);
    let printed: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(printed, json(&dir.path().join("out/summary.json")));
    assert!(printed["clips"][1]["problem"].as_str().unwrap().contains("c.y4m"));
}

#[test]
fn a_video_runs_and_a_cut_one_ends_with_1() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let made = Command::new("ffmpeg")
        .args(["-v", "error", "-f", "lavfi", "-i", "testsrc=size=64x48:rate=25:duration=2"])
        .args(["-c:v", "mpeg4"])
        .arg(dir.path().join("a.avi"))
        .status();
    assert!(made.unwrap().success());
    let text = run_successfully(dir.path(), &["simulate", "a.avi", "-o", "out"]);
    assert!(text.contains("50 frames of 64 x 48 pixels"), "{text}");
    let whole = fs::read(dir.path().join("a.avi")).unwrap();
    fs::write(dir.path().join("cut.avi"), &whole[..whole.len() / 2]).unwrap();
    let parts = ["`cut` is not complete: the file is truncated", "bytes are missing"];
    expect_failure(dir.path(), 1, &["simulate", "cut.avi", "-o", "cut"], &parts);
    assert_eq!(json(&dir.path().join("cut/summary.json"))["complete"], false);
}

/// Numbered images with times of their own, an archive, and raw video give the same decisions.
#[test]
fn numbered_images_archives_and_raw_video_are_the_same_clip() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let mut raw = Vec::new();
    let mut archive = zip::ZipWriter::new(fs::File::create(at("clip.zip")).unwrap());
    for frame in 0..4_u8 {
        let pixels: Vec<u8> =
            (0..=255).map(|at: u8| at.wrapping_mul(7) ^ frame.wrapping_mul(91)).collect();
        let image = [&b"P5 16 16 255\n"[..], &pixels].concat();
        let name = format!("f{frame:02}.pgm");
        fs::write(at(&name), &image).unwrap();
        archive.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        archive.write_all(&image).unwrap();
        raw.extend(pixels);
    }
    archive.finish().unwrap();
    fs::write(at("clip.raw"), &raw).unwrap();
    fs::write(at("times.txt"), "0\n40\n80\n200\n").unwrap();
    let base = ["simulate", "--quiet", "--timestamps", "times.txt", "--timestamp-unit", "ms"];
    for (output, input) in [
        ("images", &["f%02d.pgm"][..]),
        ("zip", &["clip.zip"]),
        ("raw", &["clip.raw", "--raw", "16x16,gray"]),
    ] {
        run_successfully(dir.path(), &[&base, input, &["-o", output]].concat());
    }
    let piped = foveate(&["simulate", "--quiet", "-", "--raw", "16x16,gray", "-o", "piped"])
        .current_dir(dir.path())
        .write_stdin(raw)
        .output()
        .unwrap();
    assert!(piped.status.success());
    let active = |folder: &str| fs::read(at(folder).join("active.npy")).unwrap();
    let times = |folder: &str| -> Vec<String> {
        let table = fs::read_to_string(at(folder).join("frames.csv")).unwrap();
        table.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().to_owned()).collect()
    };
    for folder in ["zip", "raw", "piped"] {
        assert!(active(folder) == active("images"), "{folder}");
    }
    for folder in ["images", "zip", "raw"] {
        assert_eq!(times(folder), ["0", "40000", "80000", "200000"], "{folder}");
    }
    assert_eq!(times("piped"), ["0", "33333", "66667", "100000"]);
}
