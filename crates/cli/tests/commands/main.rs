// SPDX-License-Identifier: MIT OR Apache-2.0
//! What commands print, their errors above all: each file of `tests/commands` has the calls of a
//! command with their whole output. `TRYCMD=overwrite` writes the outputs anew; read their diff like
//! a page.
//!
//! All run at once in a copy of `files`, in which they may write the folder `out` and nothing else.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use foveate_tools::{Tool, testing::require_tools};

/// The library that `--liberty` takes without a name, from Debian's package `qflow-tech-osu018`.
const LIBRARY: &str = "/usr/share/qflow/tech/osu018/osu018_stdcells.lib";

fn copy(from: &Path, to: &Path) {
    fs::create_dir(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let to = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &to);
        } else {
            fs::copy(&path, to).unwrap();
        }
    }
}

/// Adds what cannot be kept in the repository: empty folders, of which one is called like a space,
/// links, and a shipped network.
fn add_files(folder: &Path, repository: &Path) {
    for name in ["empty", "designs"] {
        fs::create_dir(folder.join(name)).unwrap();
    }
    fs::copy(repository.join("networks/denoiser.onnx"), folder.join("denoiser.onnx")).unwrap();
    for (target, link) in [
        ("nowhere.pgm", "skipped/clip/7.pgm"),
        ("gone", "skipped/set/bird"),
        ("..", "skipped/clips/cars/up"),
        ("nowhere", "skipped/clips/d.mp4"),
    ] {
        std::os::unix::fs::symlink(target, folder.join(link)).unwrap();
    }
}

/// Returns all paths below `folder` with the contents of files, except for those below `out`.
fn contents_below(folder: &Path) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
    let mut found = BTreeMap::new();
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    for path in paths.filter(|path| !path.ends_with("out")) {
        if path.is_dir() && !path.is_symlink() {
            found.extend(contents_below(&path));
        }
        let content = fs::read(&path).ok();
        found.insert(path, content);
    }
    found
}

#[test]
fn commands_print_what_their_files_say() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let cases = own.join("tests/commands");
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("files");
    copy(&cases.join("files"), &folder);
    add_files(&folder, &own.join("../.."));
    let before = contents_below(&folder);
    std::env::set_current_dir(&folder).unwrap();

    let commands = trycmd::TestCases::new();
    commands.register_bin("foveate", PathBuf::from(env!("CARGO_BIN_EXE_foveate")));
    // The number of progress lines depends on the load of the machine.
    commands.env("FOVEATE_PROGRESS", "0").env("COLUMNS", "100");
    commands.case(cases.join("*.trycmd"));
    if require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        commands.case(cases.join("ffmpeg/*.trycmd"));
    }
    let is_required = std::env::var_os("FOVEATE_REQUIRE_TOOLS").is_some();
    let has_library = is_required || Path::new(LIBRARY).exists();
    if require_tools(&[Tool::Yosys, Tool::OpenSta]) && has_library {
        commands.case(cases.join("yosys/*.trycmd"));
    }
    commands.run();
    let after = contents_below(&folder);
    let changed: Vec<_> =
        after.iter().filter(|(path, now)| before.get(*path) != Some(*now)).collect();
    assert!(changed.is_empty() && after.len() == before.len(), "{changed:?}");
}
