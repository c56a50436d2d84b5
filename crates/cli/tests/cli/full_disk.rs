// SPDX-License-Identifier: MIT OR Apache-2.0
//! A full disk: what was done until then is there, whole, and marked as partial. On a small file
//! system in a name space of its own, where the system allows one.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::common::files_below;
use foveate_toolchain::Tool;
use foveate_toolchain::testing::{require_tools, skip};
use serde_json::Value;

/// Runs a command on a file system of so many KiB, and copies to `copy` what is there afterwards; none
/// where no file system can be mounted.
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
    skip("no file system can be mounted here");
    None
}

/// Frames of an array, by its header and by its length.
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
    // 784 regions; the table alone would need some 15 MB.
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

#[test]
fn a_disk_that_is_full_at_once_leaves_nothing_and_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let Some((ran, copy)) = run_within(64, dir.path(), "simulate scene:street --frames 50") else {
        return;
    };
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert_eq!(ran.status.code(), Some(2), "{said}");
    assert!(said.contains("No space left on device"), "{said}");
    assert_eq!(fs::read_dir(copy).unwrap().count(), 0);
}

/// The outputs of a network are kept whole or not at all.
#[test]
fn outputs_for_which_there_is_no_room_leave_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let network = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");
    for format in ["npy", "png"] {
        let args = format!("infer '{network}' scene:street --max-frames 60 --outputs {format}");
        let Some((ran, copy)) = run_within(640, dir.path(), &args) else { return };
        let said = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert_eq!(ran.status.code(), Some(2), "{format}: {said}");
        assert!(said.contains("outputs/clean") && said.contains("No space left"), "{said}");
        assert_eq!(fs::read_dir(&copy).unwrap().count(), 0, "{format}");
        fs::remove_dir(copy).unwrap();
    }
}
