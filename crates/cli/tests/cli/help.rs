// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that run the examples of the help texts, unchanged, in a folder with the files that they
//! name.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{run_in, run_successfully};
use foveate_tools::{
    Tool,
    testing::{require_tools, takes_whole_lists},
};

/// The examples that are not run here. They take minutes or need what is not shipped, other tests
/// cover them, and `examples` in the sources checks that the command line accepts them.
const NOT_RUN: [&str; 18] = [
    "foveate build --board icebreaker",
    "foveate build --board ulx3s",
    "foveate cosim",
    "foveate estimate",
    "foveate bench",
    "FOVEATE_CACHE=off foveate bench",
    "foveate stress",
    "foveate explore approximations scene:street",
    "foveate explore space.toml",
    "foveate explore designs",
    "foveate fit",
    // These networks are not shipped.
    "foveate infer resnet50.onnx",
    "foveate infer yolox_nano.onnx",
    // These commands run until Ctrl-C.
    "foveate live",
    "foveate view",
    "cat packets.bin | foveate view",
    // These need events of a real sensor, or a folder of the system.
    "foveate analyze sensor",
    "foveate completions bash > /etc/",
];

/// Returns the lines of a help text that are commands.
fn examples(help: &str) -> Vec<String> {
    let (_, examples) = help.rsplit_once("Example").unwrap();
    let examples = examples.split_once(':').unwrap().1.lines().map(|line| line.trim().to_owned());
    examples.filter(|line| line.contains("foveate ")).collect()
}

fn ffmpeg(folder: &Path, args: &str) {
    let args = args.split_whitespace();
    let status =
        Command::new("ffmpeg").args(["-v", "error"]).args(args).current_dir(folder).status();
    assert!(status.unwrap().success());
}

/// Writes small files with the names that the examples use.
fn write_example_inputs(folder: &Path) {
    for name in ["frames", "clips", "photos", "core"] {
        fs::create_dir(folder.join(name)).unwrap();
    }
    ffmpeg(folder, "-f lavfi -i testsrc2=size=128x104:rate=25:duration=0.4 -c:v mpeg4 street.mp4");
    ffmpeg(folder, "-i street.mp4 frames/%03d.png");
    for copy in ["bus.mp4", "clips/a.mp4", "clips/b.mp4"] {
        fs::copy(folder.join("street.mp4"), folder.join(copy)).unwrap();
    }
    for (from, to) in [("001", "photos/a.png"), ("005", "photos/b.png"), ("002", "photo.png")] {
        fs::copy(folder.join(format!("frames/{from}.png")), folder.join(to)).unwrap();
    }
    fs::write(folder.join("gt.txt"), "2,1,9,9,64,64,1,1,1\n").unwrap();
    run_successfully(folder, &["generate", "-o", "core", "--quiet"]);
    fs::copy(folder.join("core/design.toml"), folder.join("camera.toml")).unwrap();
    let sent =
        ["simulate", "street.mp4", "--packets", "--preset", "steady", "-o", "sent", "--quiet"];
    run_successfully(folder, &sent);
    fs::rename(folder.join("sent/packets.bin"), folder.join("packets.bin")).unwrap();
    let header = [0, 0, 8, 3, 0, 0, 0, 2, 0, 0, 0, 16, 0, 0, 0, 16];
    let idx: Vec<u8> = header.into_iter().chain((0..512_u32).map(|p| p.to_le_bytes()[0])).collect();
    let denoiser = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../networks/denoiser.onnx");
    fs::copy(denoiser, folder.join("denoiser.onnx")).unwrap();
    // The reader goes by the content of a file, not by its name.
    fs::write(folder.join("train-images-idx3-ubyte.gz"), idx).unwrap();
    for batch in ["data_batch_1.bin", "data_batch_2.bin"] {
        fs::write(folder.join(batch), [3; 3073]).unwrap();
    }
    let labels = [0, 0, 8, 1, 0, 0, 0, 2, 7, 1];
    fs::write(folder.join("train-labels-idx1-ubyte"), labels).unwrap();
}

#[test]
fn examples_run_as_they_stand() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    write_example_inputs(dir.path());
    let program = Path::new(env!("CARGO_BIN_EXE_foveate"));
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{path}", program.parent().unwrap().display());
    let help = run_successfully(dir.path(), &["--help"]);
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let commands: Vec<&str> = commands
        .take_while(|line| !line.is_empty())
        // A line that continues the description of a command is indented further.
        .filter(|line| !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    assert!(commands.contains(&"simulate") && commands.contains(&"completions"), "{commands:?}");
    let mut ran = 0;
    let mut left_out = BTreeSet::new();
    for command in commands {
        let help = run_in(dir.path(), &[command, "--help"]).stdout;
        // Most runs take the first example of each command that is run.
        let mut is_run = false;
        for example in examples(&help) {
            if let Some(long) = NOT_RUN.iter().find(|long| example.starts_with(**long)) {
                left_out.insert(*long);
                continue;
            }
            if is_run && !takes_whole_lists() {
                continue;
            }
            is_run = true;
            let output = Command::new("sh")
                .args(["-c", &example])
                .current_dir(dir.path())
                .env("PATH", &path)
                .env("FOVEATE_PROGRESS", "0")
                .output()
                .unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{example}: {said}");
            for folder in ["out", "regions", "core16"] {
                let _ = fs::remove_dir_all(dir.path().join(folder));
            }
            ran += 1;
        }
    }
    let expected = if takes_whole_lists() { 17 } else { 9 };
    assert!(ran >= expected, "only {ran} examples were run");
    assert_eq!(left_out, BTreeSet::from(NOT_RUN), "what is left out must be an example");
}
