// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests with endless files. Each argument that names a file to read gets one, and the command must
//! refuse it in bounded time and memory.
#![cfg(target_os = "linux")]

use std::collections::BTreeSet;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use flate2::Compression;
use flate2::write::GzEncoder;

/// The address space of a command in KiB, which is too small for an endless file.
const MEMORY_KIB: u32 = 3 << 20;
/// The time limit of a refusal. Each takes far below a second; a loaded machine takes longer.
const LIMIT: Duration = Duration::from_secs(60);

/// The arguments that name files to read: the command, the argument, and a call with an endless
/// file in its place.
const CALLS: &[(&str, &str, &str)] = &[
    ("check", "[FILE]", "check ENDLESS"),
    ("check", "--clip", "check --clip ENDLESS"),
    ("build", "--config", "build --board icebreaker --project -o out --config ENDLESS"),
    ("build", "--board", "build --board endless.toml --project -o out"),
    ("cosim", "--rtl", "cosim --rtl rtl"),
    ("cosim", "[INPUT]...", "cosim --preset bare ENDLESS"),
    ("estimate", "--liberty", "estimate --preset bare --liberty ENDLESS"),
    ("estimate", "--activity", "estimate --preset bare --liberty cells.lib --activity ENDLESS"),
    ("estimate", "--macros", "estimate --preset bare --liberty cells.lib --macros ENDLESS"),
    ("simulate", "<INPUT>...", "simulate ENDLESS -o out"),
    (
        "simulate",
        "--sink-stalls",
        "simulate scene:street --frames 2 --clocks --sink-stalls ENDLESS -o out",
    ),
    ("dataset", "<INPUT>...", "dataset ENDLESS -o out"),
    ("stress", "[INPUT]...", "stress ENDLESS"),
    ("stress", "--task", "stress scene:street --task ENDLESS"),
    ("explain", "<INPUT>...", "explain ENDLESS --frame 1 --region 0,0"),
    ("analyze", "<INPUT>...", "analyze activity ENDLESS -o out"),
    (
        "analyze",
        "--sensor-events",
        "analyze sensor scene:street --frames 2 --sensor-events ENDLESS -o out",
    ),
    ("analyze", "--boxes", "analyze recall scene:street --frames 2 --boxes ENDLESS -o out"),
    ("bench", "[INPUT]...", "bench ENDLESS"),
    ("explore", "[SPACE]", "explore ENDLESS scene:street -o out"),
    ("explore", "[INPUT]...", "explore approximations ENDLESS --no-area -o out"),
    (
        "explore",
        "--liberty",
        "explore approximations scene:street --frames 12 -o out --liberty ENDLESS",
    ),
    (
        "explore",
        "--macros",
        "explore approximations scene:street --frames 12 -o out --liberty cells.lib --macros ENDLESS",
    ),
    ("fit", "<INPUT>...", "fit ENDLESS"),
    ("fit", "--boxes", "fit scene:street --frames 8 --min-recall 50% --boxes ENDLESS"),
    ("fit", "--network", "fit scene:street --frames 8 --network ENDLESS"),
    ("fit", "--liberty", "fit scene:street --frames 12 --liberty ENDLESS"),
    ("fit", "--macros", "fit scene:street --frames 12 --liberty cells.lib --macros ENDLESS"),
    ("infer", "<MODEL>", "infer ENDLESS scene:street -o out"),
    ("infer", "[INPUT]...", "infer NETWORK ENDLESS -o out"),
    (
        "infer",
        "--accelerator",
        "infer NETWORK scene:street --framing stretch --accelerator endless.toml -o out",
    ),
    (
        "infer",
        "--boxes",
        "infer NETWORK scene:street --frames 2 --framing stretch --detect yolox --whole-frames --boxes ENDLESS -o out",
    ),
    ("link", "<INPUT>...", "link ENDLESS -o out"),
    ("several", "--config", "check --config ENDLESS"),
    ("several", "--timestamps", "simulate image.pgm --timestamps ENDLESS -o out"),
    ("several", "--labels", "simulate images-idx3-ubyte --labels ENDLESS -o out"),
];

/// The arguments that name streams of any length. These are read until they end or the user stops
/// the command, in bounded memory.
const STREAMS: &[(&str, &str)] =
    &[("decode", "<STREAM>"), ("view", "<INPUT>"), ("live", "[INPUT]...")];

/// The value names that mean files or folders.
const VALUES: &[&str] = &["FILE", "DIR", "INPUT", "MODEL", "STREAM", "SPACE", "NAME|FILE"];

/// Returns the arguments on the page of commands that name a file or folder to read: the command,
/// and the option or positional argument.
fn arguments_that_are_read(page: &str) -> BTreeSet<(String, String)> {
    let mut found = BTreeSet::new();
    let mut command = String::new();
    for line in page.lines() {
        if let Some(title) = line.strip_prefix("## ") {
            title.split(' ').next().unwrap_or_default().clone_into(&mut command);
            if title.starts_with("Options of several") {
                "several".clone_into(&mut command);
            }
        }
        let Some(row) = line.strip_prefix("| `") else { continue };
        let (argument, text) = row.split_once("` | ").unwrap_or((row, ""));
        let Some(value) =
            argument.split(['<', '[']).next_back().and_then(|rest| rest.split(['>', ']']).next())
        else {
            continue;
        };
        let is_written = ["Write", "Folder to write", "Folder for", "File for"]
            .iter()
            .any(|verb| text.starts_with(verb));
        if !VALUES.contains(&value) || is_written {
            continue;
        }
        let name = argument.split(", ").last().unwrap_or(argument);
        let name = if name.starts_with('-') {
            name.split([' ', '[']).next().unwrap_or(name)
        } else {
            name
        };
        found.insert((command.clone(), name.to_owned()));
    }
    found
}

#[test]
fn every_argument_that_names_a_file_is_tried() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/commands.md");
    let found = arguments_that_are_read(&fs::read_to_string(page).unwrap());
    let tried = CALLS.iter().map(|(command, argument, _)| (*command, *argument));
    let tried: BTreeSet<_> = tried.chain(STREAMS.iter().copied()).collect();
    let is_tried = |one: &(String, String)| tried.contains(&(one.0.as_str(), one.1.as_str()));
    let missing: Vec<_> = found.iter().filter(|one| !is_tried(one)).collect();
    assert!(found.len() > 20, "the page is read wrongly: {found:?}");
    assert!(missing.is_empty(), "{missing:?} need a call in CALLS, or a reason to be in STREAMS");
}

/// Writes the files that calls name beside the endless one.
fn prepare(folder: &Path) {
    let link = |name: &str| std::os::unix::fs::symlink("/dev/zero", folder.join(name)).unwrap();
    link("endless.toml");
    fs::create_dir(folder.join("rtl")).unwrap();
    link("rtl/rcm.v");
    fs::write(folder.join("cells.lib"), "library (a) { cell (b) { area : 1; } }").unwrap();
    fs::write(folder.join("image.pgm"), "P2 2 1 255 1 2\n").unwrap();
    let images = [0, 0, 8, 3, 0, 0, 0, 1, 0, 0, 0, 8, 0, 0, 0, 8];
    fs::write(folder.join("images-idx3-ubyte"), [&images[..], &[7; 64]].concat()).unwrap();
}

/// Runs a command with little memory. Returns its exit code and its messages.
fn run(folder: &Path, args: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new("sh");
    command.args([
        "-c",
        &format!("ulimit -v {MEMORY_KIB}; exec \"$0\" \"$@\""),
        env!("CARGO_BIN_EXE_foveate"),
    ]);
    let mut child = command
        .args(args)
        .current_dir(folder)
        .env("FOVEATE_PROGRESS", "0")
        .stdin(std::process::Stdio::null())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > LIMIT {
            child.kill().unwrap();
            child.wait().unwrap();
            return (None, format!("no end within {LIMIT:?}"));
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_file_without_an_end_is_refused() {
    let network =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../network/tests/network/golden/lenet.onnx");
    for (command, argument, call) in CALLS {
        let folder = tempfile::tempdir().unwrap();
        prepare(folder.path());
        let args: Vec<&str> = call
            .split(' ')
            .map(|arg| match arg {
                "ENDLESS" => "/dev/zero",
                "NETWORK" => network,
                other => other,
            })
            .collect();
        let (code, said) = run(folder.path(), &args);
        assert_eq!(code, Some(2), "{command} {argument}: {said}");
        // Another refusal would mean that the file was not read.
        let is_named =
            ["/dev/zero", "endless.toml", "rtl/rcm.v"].iter().any(|name| said.contains(name));
        assert!(is_named, "{command} {argument}: {said}");
        let is_refused = !said.contains("panicked") && !said.contains("memory");
        assert!(is_refused, "{command} {argument}: {said}");
        assert!(!folder.path().join("out").exists(), "{command} {argument} left a folder");
    }
}

/// The packed line has 4 GiB, as members of 1 MiB each.
#[test]
fn an_endless_line_in_a_packed_table_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut member = GzEncoder::new(Vec::new(), Compression::fast());
    member.write_all(&[b'7'; 1 << 20]).unwrap();
    let member = member.finish().unwrap();
    fs::write(folder.path().join("events.csv.gz"), member.repeat(4096)).unwrap();
    let call = [
        "analyze",
        "sensor",
        "scene:street",
        "--frames",
        "2",
        "--sensor-events",
        "events.csv.gz",
        "-o",
        "out",
    ];
    let (code, said) = run(folder.path(), &call);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("events.csv.gz`: a record has more than 1 MiB, which is the limit"),
        "{said}"
    );
}
