// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `link`, end to end, on small scenes.

use std::fs;
use std::path::Path;

use crate::common::{expect_failure, files_below, run_in, run_successfully};
use foveate_tools::{Tool, testing::require_tools};
use serde_json::Value;

const FRAME: &str = "frame={width=160,height=120}";
/// The options that make every region relevant, so that a region that was not sent is as old as
/// possible, but never blank.
const ALL: [&str; 2] = ["--set", "spatial.0.min_score=0"];

fn report(folder: &Path, more: &[&str]) -> Value {
    let args = ["link", "scene:street", "-o", "out", "--max-frames", "6", "--json", "--force"];
    let args = [&args[..], &["--set", FRAME], &ALL, more].concat();
    serde_json::from_str(&run_successfully(folder, &args)).unwrap()
}

fn senders<'a>(report: &'a Value, name: &str) -> Vec<&'a Value> {
    let senders = report["clips"][0]["senders"].as_array().unwrap();
    senders.iter().filter(|sender| sender["sender"] == name).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
#[ignore = "a comparison of a link with two codecs; scripts/release.sh whole runs it"]
fn a_codec_is_the_coarsest_that_is_as_good() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let found = report(dir.path(), &["--codecs", "mjpeg,h264"]);
    let own = senders(&found, "region by rows")[0];
    let points = found["clips"][0]["curves"].as_array().unwrap();
    for codec in ["mjpeg", "h264"] {
        for sender in senders(&found, codec) {
            let part = sender["equal"].as_str().unwrap();
            assert_eq!(sender["found"], "equal", "{sender}");
            assert!(number(&sender["quality"][part]) >= number(&own["quality"][part]), "{sender}");
            // The next coarser quantizer is not as good, and the search has tried it.
            let next = |point: &&Value| {
                point["sender"] == codec
                    && point["value"].as_u64() == sender["quantizer"].as_u64().map(|q| q + 1)
            };
            let next = points.iter().find(next).unwrap();
            assert!(number(&next["quality"][part]) < number(&own["quality"][part]), "{next}");
        }
    }
    // The bytes that the camera sends are those that `simulate` counts.
    let args = ["simulate", "scene:street", "-o", "sim", "--max-frames", "6", "--json"];
    let more = ["--pixel-events=csv", "--set", FRAME];
    let simulated = run_successfully(dir.path(), &[&args[..], &more, &ALL].concat());
    let simulated: Value = serde_json::from_str(&simulated).unwrap();
    for (sender, camera) in [
        ("region by rows", "region"),
        ("region array", "region"),
        ("pixel events", "pixel"),
        ("raw", "raw"),
    ] {
        let bytes = &senders(&found, sender)[0]["figures"]["bytes"];
        assert_eq!(bytes, &simulated["bandwidth"][camera]["bytes"], "{sender}");
    }
    // The design is a point of its own curves.
    let own_rate = &own["figures"]["bytes_per_second"];
    let is_own = |point: &&Value| point["knob"] == "temporal.level" && point["value"] == 8;
    assert_eq!(&points.iter().find(is_own).unwrap()["bytes_per_second"], own_rate);
}

#[test]
fn the_folder_is_whole_and_the_same_every_time() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    report(dir.path(), &["--codecs", "mjpeg"]);
    let first = files_below(dir.path());
    // A codec that is named twice is compared once.
    report(dir.path(), &["--codecs", "mjpeg,mjpeg"]);
    assert_eq!(files_below(dir.path()), first);
    let names: Vec<_> = first.iter().map(|(name, _)| name.display().to_string()).collect();
    for name in [
        "link.csv",
        "link.json",
        "link.parquet",
        "rate-distortion.csv",
        "rate-distortion.parquet",
        "rate-distortion.png",
        "rate-distortion.svg",
        "rate-distortion-ssim.png",
        "rate-distortion-ssim.svg",
    ] {
        assert!(names.iter().any(|found| found.ends_with(name)), "{name} in {names:?}");
    }
    let table = fs::read_to_string(dir.path().join("out/link.csv")).unwrap();
    // The rows are four cameras, and one codec at two qualities.
    assert_eq!(table.lines().count(), 1 + 4 + 2, "{table}");
}

#[test]
#[ignore = "two comparisons of a link; scripts/release.sh whole runs it"]
fn a_slow_link_needs_a_buffer_and_adds_latency() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let raw = |rate: &str| {
        let found = report(dir.path(), &["--codecs", "mjpeg", "--link", rate]);
        senders(&found, "raw")[0]["figures"].clone()
    };
    // 160 bytes per row every 277 us are 4.6 Mbit/s.
    let (fast, slow) = (raw("100Mbit"), raw("1Mbit"));
    assert_eq!((&fast["overloaded"], &slow["overloaded"]), (&false.into(), &true.into()));
    assert_eq!(fast["buffer_bytes"], 160);
    assert_eq!(fast["delivery_ns"]["longest"], 12_800);
    let sent = 160 * 120 * 6;
    assert!(number(&slow["buffer_bytes"]) > 0.7 * f64::from(sent), "{slow}");
    // Bytes and windows count what is given to the link, whatever its rate.
    assert_eq!(fast["windows"], slow["windows"]);
}

#[test]
#[ignore = "three comparisons of a link; scripts/release.sh whole runs it"]
fn a_raster_core_says_what_a_link_without_a_buffer_loses() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let set = ["--codecs", "mjpeg", "--set", "hardware.organization=\"raster\""];
    let unbuffered = |rate: &str| {
        let found = report(dir.path(), &[&set[..], &["--clock", "20MHz", "--link", rate]].concat());
        assert!(senders(&found, "raw")[0]["unbuffered"].is_null());
        senders(&found, "region array")[0]["unbuffered"].clone()
    };
    // The first frame is sent whole: 4.6 Mbit/s are as many pixels as come.
    let (fast, slow) = (unbuffered("100Mbit"), unbuffered("1Mbit"));
    assert_eq!(fast["clock_hz"], 20_000_000);
    assert_eq!(fast["lost_regions"], 0, "{fast}");
    assert_eq!(fast["frames_with_losses"], Value::Array(Vec::new()));
    assert!(number(&slow["lost_regions"]) > 100.0, "{slow}");
    assert_eq!(slow["frames_with_losses"][0], 0, "{slow}");
    assert!(number(&slow["last_word_ns"]) > number(&fast["last_word_ns"]), "{slow}");
    // The table has the same, for the array alone.
    let table = fs::read_to_string(dir.path().join("out/link.csv")).unwrap();
    let header = "unbuffered_clock_hz,unbuffered_lost_regions,unbuffered_frames_with_losses,\
                  unbuffered_last_word_ns";
    assert!(table.lines().next().unwrap().contains(header), "{table}");
    let array = table.lines().find(|line| line.contains(",region array,")).unwrap();
    let cells = format!(",20000000,{},0", slow["lost_regions"]);
    assert!(array.contains(&cells), "{array}");
    assert!(table.lines().any(|line| line.contains(",raw,") && line.contains(",,,,")), "{table}");
    let args = ["link", "scene:street", "-o", "text", "--max-frames", "2"];
    let more = ["--link", "1Mbit", "--set", FRAME];
    let text = run_successfully(dir.path(), &[&args[..], &set, &more, &ALL].concat());
    let stated = "Without a buffer behind the array, at 0.";
    assert!(text.contains(stated) && text.contains(" MHz, lost regions: "), "{text}");
}

#[test]
fn tables_are_markdown_and_quiet_is_quiet() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let args = ["link", "scene:street", "scene:fade", "-o", "out", "--max-frames", "3"];
    let args = [&args[..], &["--codecs", "mjpeg", "--set", FRAME]].concat();
    let text = run_successfully(dir.path(), &args);
    assert!(text.starts_with("street: 3 frames of 160 x 120 pixels in 100 ms, "), "{text}");
    assert_eq!(text.matches("| region array | - |").count(), 2, "{text}");
    assert_eq!(text.matches("| mjpeg | PSNR |").count(), 2, "{text}");
    assert!(dir.path().join("out/rate-distortion-1.svg").is_file());
    let quiet = ["link", "scene:fade", "-o", "quiet", "--max-frames", "2", "--codecs", "mjpeg"];
    let quiet = [&quiet[..], &["--set", FRAME, "--quiet"]].concat();
    assert_eq!(run_successfully(dir.path(), &quiet), "");
}

#[test]
fn a_clip_that_ends_early_is_compared_as_far_as_it_goes() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let frame = |value: u8| [&b"FRAME\n"[..], &[value; 64 * 48]].concat();
    let whole =
        [&b"YUV4MPEG2 W64 H48 F25:1 Cmono\n"[..], &frame(9), &frame(99), &frame(30)].concat();
    fs::write(dir.path().join("cut.y4m"), &whole[..whole.len() - 100]).unwrap();
    let args = ["link", "cut.y4m", "-o", "out", "--codecs", "mjpeg"];
    let cut = expect_failure(dir.path(), 1, &args, &["`out` is not complete: cut: "]);
    assert!(cut.stdout.contains("kB/s, NOT COMPLETE\n"), "{}", cut.stdout);
    let report = fs::read_to_string(dir.path().join("out/link.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["clips"][0]["frames"], 2);
    assert!(report["clips"][0]["problem"].is_string(), "{report}");
    // A frame takes 64 clocks to enter, and 20 more to its decisions; 48 rows of 8 pixels come in
    // 40 ms.
    let stated = "Without --clock: at 0.0096 MHz, the slowest clock that keeps up, the array adds up \
                  to 84 clocks to the times of the region camera.\n";
    assert!(cut.stdout.contains(stated) && report["clock_hz"].is_null(), "{}", cut.stdout);
    let given = run_in(dir.path(), &[&args[..], &["--force", "--clock", "50MHz"]].concat());
    assert!(given.stdout.contains("The array runs at 50 MHz.\n"), "{}", given.stdout);
}
