// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of a full disk. The results until then remain, complete in themselves and marked as
//! partial. The disk is a small file system in a name space of its own, if the system allows one.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::common::files_below;
use foveate_tools::{
    Tool,
    testing::{report_skip, require_tools},
};
use serde_json::Value;

/// Runs a command on a file system of `kib` KiB, and copies the files that are left to the returned
/// folder. Returns `None` if no file system can be mounted.
pub(crate) fn run_within(kib: u32, folder: &Path, args: &str) -> Option<(Output, PathBuf)> {
    let (place, copy) = (folder.join("small"), folder.join(format!("copy of {kib}")));
    fs::create_dir_all(&place).unwrap();
    let foveate = assert_cmd::cargo::cargo_bin("foveate");
    let script = format!(
        "mount -t tmpfs -o size={kib}k none '{place}' || exit 99
         '{foveate}' {args} -o '{place}/out' --quiet --json; code=$?
         cp -r '{place}' '{copy}'; exit $code",
        place = place.display(),
        foveate = foveate.display(),
        copy = copy.display(),
    );
    for apart in [&["unshare", "-m"][..], &["unshare", "-rm"]] {
        let (program, options) = apart.split_first()?;
        let ran = Command::new(program).args(options).args(["sh", "-c", &script]).output();
        match ran {
            Ok(ran) if copy.is_dir() => return Some((ran, copy)),
            _ => {}
        }
    }
    report_skip("no file system can be mounted here");
    None
}

/// Returns the number of frames of an array, from its header and from its length.
fn frames_of(array: &[u8], bytes_of_frame: usize) -> (usize, usize) {
    let header = String::from_utf8_lossy(&array[..128]).into_owned();
    let shape = header.split_once("'shape': (").unwrap().1;
    let said = shape.split(',').next().unwrap().parse().unwrap();
    assert_eq!((array.len() - 128) % bytes_of_frame, 0);
    (said, (array.len() - 128) / bytes_of_frame)
}

#[test]
fn what_fits_is_there_whole_and_marked_as_partial() {
    let dir = tempfile::tempdir().unwrap();
    // The scene has 784 regions; the table alone would need some 15 MB.
    let args = "simulate scene:street --frames 500 --events csv,parquet --pixel-events=npz,csv";
    let Some((ran, copy)) = run_within(6144, dir.path(), args) else { return };
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert_eq!(ran.status.code(), Some(1), "{said}");
    assert!(said.contains("is not complete: disk full after"), "{said}");
    assert_eq!(fs::read_dir(&copy).unwrap().count(), 1, "nothing is beside the output");
    let out = copy.join("out");
    let read = |name: &str| fs::read(out.join(name)).unwrap();
    let summary: Value = serde_json::from_slice(&read("summary.json")).unwrap();
    assert_eq!(summary["complete"], false);
    assert!(summary["problem"].as_str().unwrap().starts_with("disk full after"));
    let frames = usize::try_from(summary["frames"].as_u64().unwrap()).unwrap();
    assert!(frames > 0 && frames < 500, "{frames}");
    for (name, size) in [("srs", 1), ("trs", 1), ("active", 1), ("t_count", 1), ("score_edge", 1)] {
        let array = read(&format!("{name}.npy"));
        assert_eq!(frames_of(&array, 784 * size), (frames, frames), "{name}");
    }
    let lines = |name: &str| {
        let text = String::from_utf8(read(name)).unwrap();
        assert!(text.ends_with('\n'), "{name}");
        text.lines().count() - 1
    };
    assert_eq!((lines("frames.csv"), lines("events.csv")), (frames, 784 * frames));
    let events = usize::try_from(summary["bandwidth"]["pixel"]["events"].as_u64().unwrap());
    assert_eq!(lines("pixel_events.csv"), events.unwrap());
    assert!(read("pixel_events.npz").windows(4).rev().take(40).any(|w| w == b"PK\x05\x06"));
    assert!(read("events.parquet").ends_with(b"PAR1"));
    let pictures = files_below(&out.join("rendered"));
    assert_eq!(pictures.len(), frames);
    assert!(pictures.iter().all(|(_, bytes)| bytes.ends_with(b"IEND\xAEB`\x82")));
    assert!(!out.join(".reserve").exists());
}

/// The frames until then remain, whatever else is written, and no message names a temporary path.
#[test]
fn frames_are_kept_whatever_is_written_beside_them() {
    let dir = tempfile::tempdir().unwrap();
    let sent = dir.path().join("sent");
    let foveate = assert_cmd::cargo::cargo_bin("foveate");
    let sending = ["simulate", "scene:random", "--frames", "40", "--packets", "--quiet", "-o"];
    assert!(Command::new(foveate).args(sending).arg(&sent).status().unwrap().success());
    let decode = format!("decode '{}' --overlay", sent.join("packets.bin").display());
    let images = dir.path().join("train-images-idx3-ubyte");
    let header = [0u8, 0, 8, 3, 0, 0, 3, 232, 0, 0, 0, 56, 0, 0, 0, 56];
    fs::write(&images, [&header[..], &vec![77; 1000 * 56 * 56]].concat()).unwrap();
    let dataset = format!("dataset '{}'", images.display());
    let clip = "simulate scene:random --frames 300";
    let mut cases: Vec<(String, u32, bool)> = [
        "--overlay",
        "--overlay --heatmap",
        "--packets --no-rendered",
        "--packets=scores",
        "--events parquet",
        "--events csv --heatmap",
        "--pixel-events=npz",
    ]
    .map(|options| (format!("{clip} {options}"), 3000, false))
    .into();
    for options in [
        "--overlay=mp4 --no-rendered",
        "--overlay=mkv",
        "--rendered mkv --overlay=mkv",
        "--heatmap=mp4 --events parquet",
    ] {
        cases.push((format!("{clip} {options}"), 4096, true));
    }
    // The table has more than one group, and the disk is full when the first is written.
    let clocks = "simulate scene:random --frames 1500 --clocks=parquet --no-rendered";
    cases.push((clocks.to_owned(), 2500, false));
    cases.extend([(decode, 1200, false), (dataset, 1500, false)]);
    for (args, kib, has_video) in cases {
        if has_video && !require_tools(&[Tool::Ffmpeg]) {
            continue;
        }
        let Some((ran, copy)) = run_within(kib, dir.path(), &args) else { return };
        let said = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert_eq!(ran.status.code(), Some(1), "{args}: {said}");
        assert!(said.contains("disk full after") && !said.contains("partial"), "{args}: {said}");
        assert_eq!(fs::read_dir(&copy).unwrap().count(), 1, "{args}: nothing is beside the output");
        let out = copy.join("out");
        let summary = fs::read(out.join("summary.json")).unwrap();
        let summary: Value = serde_json::from_slice(&summary).unwrap();
        let frames = usize::try_from(summary["frames"].as_u64().unwrap()).unwrap();
        let active = fs::read(out.join("active.npy")).unwrap();
        let regions = usize::try_from(summary["regions"].as_u64().unwrap()).unwrap();
        assert_eq!(frames_of(&active, regions), (frames, frames), "{args}");
        assert!(frames > 0, "{args}: {said}");
        let table = fs::read_to_string(out.join("frames.csv")).unwrap();
        assert_eq!(table.lines().count(), frames + 1, "{args}");
        // Every file that exists is complete, and every missing file is named.
        let problem = summary["problem"].as_str().unwrap();
        for name in ["rendered", "overlay"] {
            let pictures = out.join(name);
            if pictures.is_dir() {
                assert_eq!(fs::read_dir(pictures).unwrap().count(), frames, "{args}: {name}");
            }
        }
        let is_asked = args.contains("--overlay") && !args.contains("--overlay=");
        if is_asked && !out.join("overlay").exists() {
            assert!(problem.contains("overlay is left out"), "{args}: {problem}");
        }
        fs::remove_dir_all(copy).unwrap();
    }
}

#[test]
fn a_video_for_which_there_is_no_room_is_left_out_by_name() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let args = "simulate scene:random --frames 300 --rendered mkv --events csv";
    let Some((ran, copy)) = run_within(6144, dir.path(), args) else { return };
    assert_eq!(ran.status.code(), Some(1), "{}", String::from_utf8_lossy(&ran.stderr));
    let summary = fs::read(copy.join("out/summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    let problem = summary["problem"].as_str().unwrap();
    let there = copy.join("out/rendered.mkv").exists();
    assert!(there != problem.ends_with("rendered.mkv is left out"), "{problem}");
}

/// The disk has four pages, fewer than there are files. With some more, it depends on the time at
/// which an output is left out whether a frame is kept.
#[test]
fn a_disk_that_is_full_at_once_leaves_nothing_and_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let Some((ran, copy)) = run_within(16, dir.path(), "simulate scene:street --frames 50") else {
        return;
    };
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert_eq!(ran.status.code(), Some(2), "{said}");
    assert!(said.contains("No space left on device"), "{said}");
    assert!(said.contains("small/out/") && !said.contains("partial"), "{said}");
    assert_eq!(fs::read_dir(copy).unwrap().count(), 0);
}

/// The outputs of a network are kept completely or not at all.
#[test]
fn outputs_for_which_there_is_no_room_leave_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let network = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");
    for format in ["npy", "png"] {
        let args = format!("infer '{network}' scene:street --max-frames 60 --outputs {format}");
        let Some((ran, copy)) = run_within(640, dir.path(), &args) else { return };
        let said = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert_eq!(ran.status.code(), Some(2), "{format}: {said}");
        assert!(
            said.contains("small/out/outputs/clean") && said.contains("No space left"),
            "{said}"
        );
        assert!(!said.contains("partial"), "{said}");
        assert_eq!(fs::read_dir(&copy).unwrap().count(), 0, "{format}");
        fs::remove_dir(copy).unwrap();
    }
}

/// A command without frames, or with files that are written at the end, writes all of them or none,
/// and names the file that did not fit.
#[test]
fn other_commands_leave_nothing_and_name_the_file() {
    let dir = tempfile::tempdir().unwrap();
    for (args, kib) in [
        ("generate", 64),
        ("build --board icebreaker --project", 64),
        ("analyze temporal scene:street --frames 3", 12),
        ("link scene:street --max-frames 3 --codecs mjpeg", 12),
    ] {
        if args.starts_with("link") && !require_tools(&[Tool::Ffmpeg]) {
            continue;
        }
        let Some((ran, copy)) = run_within(kib, dir.path(), args) else { return };
        let said = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert_eq!(ran.status.code(), Some(2), "{args}: {said}");
        assert!(said.contains("small/out/") && said.contains("No space left"), "{args}: {said}");
        assert!(!said.contains("partial"), "{args}: {said}");
        assert_eq!(fs::read_dir(&copy).unwrap().count(), 0, "{args}");
        fs::remove_dir_all(copy).unwrap();
    }
}

/// An existing file stays unchanged.
#[test]
fn a_file_for_which_there_is_no_room_stays_as_it_was() {
    let dir = tempfile::tempdir().unwrap();
    let place = dir.path().join("small");
    fs::create_dir(&place).unwrap();
    let script = format!(
        "mount -t tmpfs -o size=64k none '{place}' || exit 99
         echo before > '{place}/page.html'; ln '{place}/page.html' '{place}/other'
         '{foveate}' live --page '{place}/page.html'; code=$?
         rm '{place}/other'; '{foveate}' live --page '{place}/page.html'
         cat '{place}/page.html'; ls -A '{place}'; exit $code",
        place = place.display(),
        foveate = assert_cmd::cargo::cargo_bin("foveate").display(),
    );
    let ran = Command::new("unshare").args(["-m", "sh", "-c", &script]).output();
    let Ok(ran) = ran.inspect_err(|_| report_skip("no file system can be mounted here")) else {
        return;
    };
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    if ran.status.code() == Some(99) || said.starts_with("unshare:") {
        return report_skip("no file system can be mounted here");
    }
    assert_eq!(ran.status.code(), Some(2), "{said}");
    assert_eq!(String::from_utf8_lossy(&ran.stdout), "before\npage.html\n", "{said}");
    assert_eq!(said.matches("small/page.html`: No space left").count(), 2, "{said}");
}
