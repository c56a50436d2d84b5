// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `simulate --packets` and `decode`, end to end.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{expect_failure, foveate, foveate_with_signals, run_in, run_successfully};
use serde_json::Value;

const SENDING_COMMAND: [&str; 9] =
    ["simulate", "scene:street", "-o", "sent", "--frames", "4", "--preset", "steady", "--quiet"];

#[test]
fn a_stream_becomes_what_was_simulated() {
    let dir = tempfile::tempdir().unwrap();
    let events = ["--packets=scores", "--events", "csv"];
    run_successfully(dir.path(), &[&SENDING_COMMAND[..], &events].concat());
    let seen =
        ["decode", "sent/packets.bin", "-o", "seen", "--preset", "steady", "--events", "csv"];
    let told = run_successfully(dir.path(), &[&seen[..], &["--overlay"]].concat());
    assert!(told.starts_with("seen: 4 frames of 224 x 224 pixels"), "{told}");
    for name in ["events.csv", "t_count.npy", "active.npy", "rendered/000003.png"] {
        let of = |folder: &str| fs::read(dir.path().join(folder).join(name)).unwrap();
        assert!(of("sent") == of("seen"), "{name}");
    }
    assert!(dir.path().join("seen/overlay/000003.png").exists());
    assert!(!dir.path().join("seen/losses.csv").exists());
    expect_failure(dir.path(), 2, &seen, &["seen", "not empty"]);

    // The stream comes from a pipe and ends in the middle of the last frame.
    let bytes = fs::read(dir.path().join("sent/packets.bin")).unwrap();
    let piped = ["decode", "-", "-o", "seen", "--force", "--preset", "steady", "--json"];
    let output = foveate(&piped)
        .current_dir(dir.path())
        .write_stdin(&bytes[..bytes.len() - 100])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("frame 3: its END packet is missing"), "{told}");
    assert!(told.contains("`seen` is not complete"), "{told}");
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&summary["frames"], &summary["complete"]), (&4.into(), &false.into()));
    assert!(dir.path().join("seen/losses.csv").exists());
}

#[test]
fn displacements_come_back_as_they_were_sent() {
    let dir = tempfile::tempdir().unwrap();
    let flow = "spatial=[{feature=\"edge\"},{feature=\"flow\",radius=2}]";
    let design = ["--preset", "serial", "--set", flow, "--events", "csv,parquet", "--quiet"];
    let simulate = ["simulate", "scene:street", "-o", "sent", "--frames", "4", "--packets=scores"];
    run_successfully(dir.path(), &[&simulate[..], &design].concat());
    let decode = ["decode", "sent/packets.bin", "-o", "seen"];
    run_successfully(dir.path(), &[&decode[..], &design].concat());
    for name in ["flow.npy", "score_flow.npy", "events.csv", "events.parquet"] {
        let of = |folder: &str| fs::read(dir.path().join(folder).join(name)).unwrap();
        assert!(of("sent") == of("seen"), "{name}");
    }
    let array = fs::read(dir.path().join("sent/flow.npy")).unwrap();
    let (header, numbers) = array.split_at(128);
    let header = String::from_utf8_lossy(header);
    assert!(header.contains("'descr': '|i1'") && header.contains("(4, 28, 28, 2)"), "{header}");
    assert_eq!(numbers.len(), 4 * 28 * 28 * 2);
    assert!(numbers[..28 * 28 * 2].iter().all(|&number| number == 0));
    assert!(numbers.contains(&2) && numbers.contains(&254) && !numbers.contains(&3));
    let sums = |folder: &str| {
        let bytes = fs::read(dir.path().join(folder).join("summary.json")).unwrap();
        serde_json::from_slice::<Value>(&bytes).unwrap()["bandwidth"].clone()
    };
    assert_eq!(sums("sent"), sums("seen"));
}

/// Returns a stream of `simulate` in which each FRAME has one of these versions of the map, as from
/// a core on AXI.
fn with_map_versions(stream: &[u8], versions: &[u16]) -> Vec<u8> {
    let (mut forged, mut at, mut versions) = (stream.to_vec(), 0, versions.iter());
    while at < forged.len() {
        let end = at + 8 * usize::from(u16::from_le_bytes([forged[at + 2], forged[at + 3]]));
        let packet = &mut forged[at..end];
        if packet[1] & 15 == 1 {
            packet[6..8].copy_from_slice(&versions.next().unwrap().to_le_bytes());
            let (checked, check) = packet.split_at_mut(52);
            let mut crc = flate2::Crc::new();
            crc.update(checked);
            check.copy_from_slice(&crc.sum().to_le_bytes());
        }
        at = end;
    }
    assert_eq!(versions.next(), None);
    forged
}

/// Returns the heading of a table of frames, and the last column.
fn last_column(folder: &Path) -> (String, Vec<String>) {
    let table = fs::read_to_string(folder.join("frames.csv")).unwrap();
    let last = |line: &str| line.rsplit(',').next().unwrap().to_owned();
    (table.lines().next().unwrap().to_owned(), table.lines().skip(1).map(last).collect())
}

#[test]
fn the_versions_of_the_map_are_listed_with_the_frames() {
    let dir = tempfile::tempdir().unwrap();
    let zones = ["--set", "zones={keen={temporal={level=3}}}"];
    run_successfully(dir.path(), &[&SENDING_COMMAND[..], &["--packets"], &zones].concat());
    let (sent, _) = last_column(&dir.path().join("sent"));
    assert!(!sent.contains("map_version"), "{sent}");
    let decode = ["decode", "packets.bin", "-o", "seen", "--force", "--preset", "steady"];
    let stream = fs::read(dir.path().join("sent/packets.bin")).unwrap();
    for versions in [[0; 4], [0, 1, 1, 256], [7, 65_534, 65_535, 0]] {
        // The map of `simulate` does not change, so its stream has version 0 everywhere.
        let forged = with_map_versions(&stream, &versions);
        assert_eq!(forged == stream, versions == [0; 4]);
        fs::write(dir.path().join("packets.bin"), forged).unwrap();
        run_successfully(dir.path(), &[&decode[..], &zones].concat());
        let (heading, column) = last_column(&dir.path().join("seen"));
        assert_eq!(heading, format!("{sent},map_version"));
        assert_eq!(column, versions.map(|version| version.to_string()));
        for name in ["active.npy", "rendered/000003.png"] {
            let of = |folder: &str| fs::read(dir.path().join(folder).join(name)).unwrap();
            assert!(of("sent") == of("seen"), "{name}");
        }
    }
}

#[test]
fn a_version_of_the_map_is_damage_without_zones() {
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &[&SENDING_COMMAND[..], &["--packets"]].concat());
    let decode = ["decode", "packets.bin", "-o", "seen", "--force", "--preset", "steady"];
    let stream = fs::read(dir.path().join("sent/packets.bin")).unwrap();
    let write = |versions| {
        fs::write(dir.path().join("packets.bin"), with_map_versions(&stream, versions)).unwrap();
    };
    write(&[0, 0, 1, 0]);
    let outcome = run_in(dir.path(), &decode);
    assert_eq!(outcome.code, 1, "{}", outcome.stderr);
    for part in ["56 bytes", "frame 2: its FRAME packet is missing"] {
        assert!(outcome.stderr.contains(part), "{part}: {}", outcome.stderr);
    }
    let (heading, rows) = last_column(&dir.path().join("seen"));
    assert_eq!((heading, rows.len()), (last_column(&dir.path().join("sent")).0, 3));
    // The first FRAME tells that it comes from this design.
    write(&[1, 0, 0, 0]);
    expect_failure(dir.path(), 2, &decode, &["not its version of the map"]);
}

/// The camera without zones learns from every FRAME with zones that another design follows.
#[test]
fn a_decoder_without_zones_takes_nothing_of_a_stream_with_them() {
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &[&SENDING_COMMAND[..], &["--packets"]].concat());
    let own = fs::read(dir.path().join("sent/packets.bin")).unwrap();
    let zones = ["--packets", "--set", "zones={}", "--force"];
    run_successfully(dir.path(), &[&SENDING_COMMAND[..], &zones].concat());
    let other = fs::read(dir.path().join("sent/packets.bin")).unwrap();
    for versions in [[0; 4], [3, 4, 5, 6]] {
        let other = with_map_versions(&other, &versions);
        fs::write(dir.path().join("packets.bin"), [&own[..], &other, &own].concat()).unwrap();
        let decode = ["decode", "packets.bin", "-o", "seen", "--force", "--preset", "steady"];
        let outcome = run_in(dir.path(), &decode);
        assert_eq!(outcome.code, 1, "{}", outcome.stderr);
        assert!(outcome.stderr.contains("is of another camera or format"), "{}", outcome.stderr);
        let losses = fs::read_to_string(dir.path().join("seen/losses.csv")).unwrap();
        let losses: Vec<&str> = losses.lines().skip(1).collect();
        assert_eq!(losses, ["foreign,0,,,,", "foreign,1,,,,", "foreign,2,,,,", "foreign,3,,,,"]);
        assert_eq!(last_column(&dir.path().join("seen")).1.len(), 8);
        fs::write(dir.path().join("packets.bin"), other).unwrap();
        expect_failure(dir.path(), 2, &decode, &["was sent by design"]);
    }
}

#[cfg(unix)]
#[test]
fn a_stream_that_sends_nothing_is_left_at_once() {
    let dir = tempfile::tempdir().unwrap();
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let mut decode = foveate_with_signals()
            .args(["decode", "-", "-o", "out"])
            .current_dir(dir.path())
            .stdin(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let patience = Instant::now() + Duration::from_secs(60);
        // The temporary folder exists when the command listens for signals.
        while fs::read_dir(dir.path()).unwrap().next().is_none() {
            assert!(Instant::now() < patience, "it does not begin");
            std::thread::sleep(Duration::from_millis(5));
        }
        std::thread::sleep(Duration::from_millis(200));
        let id = decode.id().to_string();
        assert!(
            Command::new("kill").args([&format!("-{signal}"), &id]).status().unwrap().success()
        );
        let start = Instant::now();
        while decode.try_wait().unwrap().is_none() {
            if start.elapsed() > Duration::from_secs(3) {
                decode.kill().unwrap();
                panic!("it does not hear {signal}");
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        assert_eq!(decode.wait().unwrap().code(), Some(code));
        assert!(fs::read_dir(dir.path()).unwrap().next().is_none(), "something is left");
    }
}

#[test]
fn many_losses_are_counted_and_kept() {
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &[&SENDING_COMMAND[..], &["--packets"]].concat());
    let mut bytes = fs::read(dir.path().join("sent/packets.bin")).unwrap();
    let length = bytes.len();
    bytes.iter_mut().take(length / 2).skip(100).step_by(301).for_each(|byte| *byte ^= 0x10);
    fs::write(dir.path().join("bad.bin"), bytes).unwrap();
    let outcome = run_in(dir.path(), &["decode", "bad.bin", "-o", "out", "--preset", "steady"]);
    assert_eq!(outcome.code, 1, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("more, in `out/losses.csv`"), "{}", outcome.stderr);
    let losses = fs::read_to_string(dir.path().join("out/losses.csv")).unwrap();
    assert!(losses.lines().count() > 12);
}

#[test]
fn a_stream_of_another_design_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    run_successfully(dir.path(), &[&SENDING_COMMAND[..], &["--packets"]].concat());
    let refused = |stream: &str, more: &[&str], parts: &[&str]| {
        expect_failure(dir.path(), 2, &[&["decode", stream, "-o", "out"], more].concat(), parts);
        assert!(!dir.path().join("out").exists());
    };
    let summary = fs::read(dir.path().join("sent/summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    let fingerprint = summary["design_fingerprint"].as_str().unwrap();
    refused("sent/packets.bin", &["--preset", "fovea"], &[fingerprint, "configuration"]);
    refused("sent/packets.bin", &["--preset", "steady", "--heatmap"], &["without scores"]);
}
