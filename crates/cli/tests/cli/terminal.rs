// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of progress on terminals of any width, as a pseudo-terminal receives it.

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::process::{ChildStdin, Command, Stdio};
use std::time::Duration;

use foveate_tools::testing::takes_whole_lists;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Winsize, tcsetwinsize};

/// Returns the lines that a command draws on a terminal of `columns` columns, one for each drawing.
fn drawn_lines(columns: u16, arguments: &[&str], feed: impl FnOnce(ChildStdin)) -> Vec<String> {
    let own = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&own).unwrap();
    unlockpt(&own).unwrap();
    let size = Winsize { ws_row: 24, ws_col: columns, ws_xpixel: 0, ws_ypixel: 0 };
    tcsetwinsize(&own, size).unwrap();
    let path = ptsname(&own, Vec::new()).unwrap().into_string().unwrap();
    let screen = File::options().read(true).write(true).open(path).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_foveate"))
        .args(arguments)
        .current_dir(dir.path())
        .env("TERM", "xterm")
        .env_remove("NO_COLOR")
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(screen)
        .spawn()
        .unwrap();
    let reader = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        // Reading a terminal ends with an error when no process has it open for writing.
        let _ = File::from(own).read_to_end(&mut bytes);
        bytes
    });
    feed(child.stdin.take().unwrap());
    assert!(child.wait().unwrap().success());
    let bytes = reader.join().unwrap();
    let said = String::from_utf8(bytes).unwrap();
    said.split(['\r', '\n'])
        .map(|line| without_controls(line).trim_end().to_owned())
        .filter(|line| !line.is_empty())
        .collect()
}

/// Returns the text without sequences that move the cursor or choose a colour.
fn without_controls(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text.chars();
    while let Some(next) = rest.next() {
        if next == '\u{1b}' {
            let _ = rest.by_ref().find(|c| c.is_ascii_alphabetic());
        } else if !next.is_control() {
            plain.push(next);
        }
    }
    plain
}

/// Writes six frames, one every 0.7 seconds.
fn write_slowly(mut input: ChildStdin) {
    input.write_all(b"YUV4MPEG2 W16 H16 F1:1 Cmono\n").unwrap();
    for _ in 0..6 {
        input.write_all(b"FRAME\n").unwrap();
        input.write_all(&[7; 256]).unwrap();
        input.flush().unwrap();
        std::thread::sleep(Duration::from_millis(700));
    }
}

const STREAM: &[&str] = &["simulate", "-", "-o", "out", "--no-rendered"];

/// Returns the number before ` frames/s`, if the line has one.
fn rate(line: &str) -> Option<f64> {
    let (before, _) = line.split_once(" frames/s")?;
    before.rsplit([' ', '[']).next()?.parse().ok()
}

#[test]
fn a_stream_shows_its_count_and_a_true_rate() {
    let lines = drawn_lines(80, STREAM, write_slowly);
    assert!(lines.iter().any(|line| line.contains("5 frames")), "{lines:?}");
    let rates: Vec<f64> = lines.iter().filter_map(|line| rate(line)).collect();
    assert!(!rates.is_empty(), "{lines:?}");
    // The rate is at most 1.43 frames per second; a busy machine is slower.
    for rate in rates {
        assert!((0.3..=1.6).contains(&rate), "{rate} in {lines:?}");
    }
    for line in &lines {
        assert!(!line.contains("/s]") || line.contains(" frames/s]"), "{line}");
        assert!(!line.contains("left"), "the length of a stream is not known: {line}");
    }
}

#[test]
fn no_line_is_wider_than_the_terminal() {
    // `stress` takes seconds for each width.
    let widths: &[u16] = if takes_whole_lists() { &[20, 40, 80] } else { &[20] };
    for &columns in widths {
        let counted: &[&str] = &["simulate", "scene:street", "-o", "out", "--max-frames", "40"];
        let counted = if takes_whole_lists() { &["stress", "--short"] } else { counted };
        let runs =
            [drawn_lines(columns, STREAM, write_slowly), drawn_lines(columns, counted, drop)];
        for line in runs.iter().flatten() {
            assert!(line.chars().count() <= columns.into(), "{columns} columns: {line}");
        }
        let told = |text: &str| runs.iter().flatten().any(|line| line.contains(text));
        assert!(told(if columns > 20 { "5 frames" } else { " 5 [" }), "{columns}: {:?}", runs[0]);
        assert!(told("/"), "{columns} columns: {:?}", runs[1]);
        assert!(runs[0].iter().all(|line| line.contains(char::is_numeric)), "{:?}", runs[0]);
    }
}

#[test]
fn progress_never_shows_zero_of_zero() {
    // A source of known length shows its length from the first line on, never 0 of 0.
    let scene: &[&str] = &["simulate", "scene:street", "-o", "out", "--max-frames", "40"];
    for arguments in [scene, STREAM] {
        let lines = drawn_lines(80, arguments, |input| {
            if arguments == STREAM {
                write_slowly(input);
            }
        });
        assert!(!lines.is_empty());
        for line in &lines {
            assert!(!line.contains("0/0"), "{lines:?}");
        }
    }
}

#[test]
fn a_quiet_command_draws_nothing() {
    assert_eq!(
        drawn_lines(80, &[STREAM, &["--quiet"]].concat(), write_slowly),
        Vec::<String>::new()
    );
}
