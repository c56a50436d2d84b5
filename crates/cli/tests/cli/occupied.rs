// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that an output path that cannot be written is refused at once, before inputs are read,
//! whether they are missing, slow or damaged.

use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;

use crate::common::{expect_failure, foveate};
use crate::own_files::options_of;

/// The commands that write the folder `out`, by the option that names it. Except for `clip.mp4`,
/// every other file that they name is missing.
const FOLDERS: [(&str, &str); 11] = [
    ("simulate --output", "simulate clip.mp4 -o out"),
    ("dataset --output", "dataset clip.mp4 -o out"),
    ("decode --output", "decode missing.bin -o out"),
    ("infer --output", "infer missing.onnx clip.mp4 -o out"),
    ("analyze --output", "analyze activity clip.mp4 -o out"),
    ("explore --output", "explore designs clip.mp4 -o out"),
    ("link --output", "link clip.mp4 -o out"),
    ("cosim --replay", "cosim clip.mp4 --replay out"),
    ("cosim --end-to-end", "cosim --preset raster clip.mp4 --end-to-end out"),
    ("generate --output", "generate --config missing.toml -o out"),
    ("build --output", "build --board icebreaker --config missing.toml -o out"),
];

/// The options without a refusal: manual pages are replaced by their names, and the folder of
/// `--rtl` is only read.
const NOT_REFUSED: [&str; 2] = ["man --output", "cosim --rtl"];

/// The commands that write a file, here into a folder that does not exist.
const FILES: [&str; 4] = [
    "fit clip.mp4 -o nowhere/camera.toml",
    "fit clip.mp4 --config missing.toml -o nowhere/camera.toml",
    "cosim clip.mp4 --junit nowhere/cosim.xml",
    "cosim --preset raster clip.mp4 --packets nowhere/packets.bin",
];

/// Writes programs `ffprobe` and `ffmpeg` that record each call, and fail.
fn write_recording_tools(folder: &Path) {
    fs::create_dir(folder).unwrap();
    for name in ["ffprobe", "ffmpeg"] {
        let (program, called) = (folder.join(name), folder.join("called"));
        fs::write(&program, format!("#!/bin/sh\necho {name} >>'{}'\nexit 1\n", called.display()))
            .unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    }
}

/// Runs a command with these programs first in the search path. Returns its exit code and its
/// messages.
fn run_with_recording_tools(dir: &Path, command: &str) -> (Option<i32>, String) {
    let path = format!("{}:{}", dir.join("tools").display(), std::env::var("PATH").unwrap());
    let words: Vec<&str> = command.split(' ').collect();
    let output = foveate(&words).current_dir(dir).env("PATH", path).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

/// Expects a command to refuse `place` and to call none of these programs.
fn refuse_at_once(dir: &Path, command: &str, place: &str) {
    let (code, said) = run_with_recording_tools(dir, command);
    assert_eq!(code, Some(2), "{command}: {said}");
    assert!(said.lines().count() == 1 && said.contains(place), "{command}: {said}");
    assert!(!dir.join("tools/called").exists(), "{command} looks at its inputs first");
}

#[test]
fn a_folder_is_refused_before_inputs_are_looked_at() {
    let named = FOLDERS.iter().map(|(option, _)| *option).chain(NOT_REFUSED);
    assert_eq!(options_of("DIR"), named.map(str::to_owned).collect::<BTreeSet<_>>());
    let dir = tempfile::tempdir().unwrap();
    write_recording_tools(&dir.path().join("tools"));
    fs::write(dir.path().join("clip.mp4"), "no video").unwrap();
    fs::create_dir(dir.path().join("out")).unwrap();
    fs::write(dir.path().join("out/thesis.tex"), "mine").unwrap();
    for (_, command) in FOLDERS {
        refuse_at_once(dir.path(), command, "`out`");
        let missing = command.replace("clip.mp4", "missing.mp4");
        let missing: Vec<&str> = missing.split(' ').collect();
        expect_failure(dir.path(), 2, &missing, &["`out`"]);
    }
    assert_eq!(fs::read(dir.path().join("out/thesis.tex")).unwrap(), b"mine");
    // The programs do record a call.
    fs::remove_dir_all(dir.path().join("out")).unwrap();
    assert_eq!(run_with_recording_tools(dir.path(), FOLDERS[0].1).0, Some(3));
    assert!(dir.path().join("tools/called").exists());
}

#[test]
fn a_file_is_refused_before_inputs_are_looked_at() {
    let dir = tempfile::tempdir().unwrap();
    write_recording_tools(&dir.path().join("tools"));
    fs::write(dir.path().join("clip.mp4"), "no video").unwrap();
    for command in FILES {
        refuse_at_once(dir.path(), command, "`nowhere/");
    }
}
