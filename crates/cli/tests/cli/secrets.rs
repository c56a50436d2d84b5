// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that users, passwords and keys in addresses appear in no result, message or file, for all
//! commands and all forms of an address.
#![cfg(unix)]

use std::fs;
use std::process::Command;

use foveate_tools::{Tool, testing::require_tools};

use crate::common::{files_below, foveate};

/// The word in every secret of the addresses below, written as it is or percent-encoded. The
/// addresses name one camera.
const SECRET: &str = "secret";
const ADDRESSES: [&str; 7] = [
    "rtsp://me:secret@cam/live",
    "RTSP://secret:x@cam/live",
    "rtsp://cam/live?user=secret&password=s%65cret",
    "rtsp://cam/user=secret&password=secret&channel=1",
    "rtsps://me:secret?secret@cam/live",
    "rtsp://me:secret@cam",
    "rtsp://cam?secret",
];

/// A stub of ffmpeg that shows test pictures and repeats all its arguments, also with other words.
const CAMERA: &str = r#"#!/bin/sh
[ "$1" = -version ] && exec ffmpeg -version
for word in "$@"; do case "$word" in *://*) echo "[rtsp @ 0x1] [error] DESCRIBE of $word failed: secret" >&2;; esac; done
exec ffmpeg -hide_banner -nostats -loglevel repeat+level+info -f lavfi -i testsrc=size=64x48:rate=25:duration=0.2 \
    -vf format=yuv420p,extractplanes=y,showinfo=checksum=0 -f rawvideo pipe:1
"#;

#[test]
fn no_secret_of_an_address_is_in_any_result() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let camera = dir.path().join("camera");
    fs::write(&camera, CAMERA).unwrap();
    assert!(Command::new("chmod").arg("+x").arg(&camera).status().unwrap().success());
    for (turn, address) in ADDRESSES.into_iter().enumerate() {
        let commands: [&[&str]; 6] = [
            &["simulate", address, "-o", "out", "--json"],
            &["analyze", "temporal", address, "-o", "out"],
            &["link", address, "-o", "out", "--codecs", "h264"],
            &["explain", address, "--frame", "90", "--region", "0,0"],
            &["simulate", address, "scene:street", "-o", "out"],
            &["explore", "designs", address, "-o", "out"],
        ];
        for args in
            commands.into_iter().enumerate().filter(|(at, _)| at % 2 == turn % 2 || turn == 2)
        {
            let run =
                foveate(args.1).current_dir(dir.path()).env("FOVEATE_FFMPEG", &camera).output();
            let run = run.unwrap();
            let mut all = vec![("stdout".into(), run.stdout), ("stderr".into(), run.stderr)];
            let out = dir.path().join("out");
            if out.exists() {
                all.extend(files_below(&out));
                fs::remove_dir_all(&out).unwrap();
            } else {
                assert!(!args.1.contains(&"--json"), "{}", String::from_utf8_lossy(&all[1].1));
            }
            for (file, bytes) in all {
                let text = String::from_utf8_lossy(&bytes).to_lowercase();
                assert!(!text.contains(SECRET), "{:?}: {}: {text}", args.1, file.display());
                assert!(!file.display().to_string().contains(SECRET), "{}", file.display());
            }
        }
    }
}
