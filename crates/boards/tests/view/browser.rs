// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the page in Chromium, if Chromium is installed.

use std::collections::HashSet;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use foveate_output::page::browser::chromium;

use crate::client::{open, wait_for};
use crate::sent::{CORE, first_packet, street_stream};

/// The longest time that Chromium may take.
const LIMIT: Duration = Duration::from_secs(120);

/// Returns the output of a program. A program that does not end in time is killed.
fn printed(command: &mut Command, file: &Path) -> String {
    let mut child =
        command.stdout(File::create(file).unwrap()).stderr(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > LIMIT {
            child.kill().unwrap();
            panic!("Chromium did not end within {LIMIT:?}");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    fs::read_to_string(file).unwrap()
}

/// Returns what Chromium prints of a page, with its profile in a folder.
fn browse(program: &Path, folder: &Path, more: &str, link: &str) -> String {
    let mut command = Command::new(program);
    command
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-sync"])
        .args([
            "--disable-background-networking",
            "--disable-component-update",
            "--hide-scrollbars",
        ])
        .arg(format!("--user-data-dir={}", folder.join("profile").display()))
        .args(["--window-size=1000,900", "--virtual-time-budget=500", more, link]);
    printed(&mut command, &folder.join("printed"))
}

#[test]
fn a_browser_shows_the_version_of_the_map() {
    let Some(program) = chromium() else { return eprintln!("skipped: there is no Chromium") };
    let folder = tempfile::tempdir().unwrap();
    for (zones, shown) in [(&["zones={}"][..], "map 0"), (&[], "")] {
        let set = [&["frame={width=40,height=30}"], zones].concat();
        let file = folder.path().join("packets.bin");
        fs::write(&file, street_stream(&set, 3).bytes()).unwrap();
        let view = open(&file, &set, None).unwrap();
        wait_for(view.link(), "end", |state| state["status"] == "ended");
        let page = browse(&program, folder.path(), "--dump-dom", view.link());
        let part = format!("<dd id=\"number\">2</dd><dd id=\"map\">{shown}</dd>");
        assert!(page.contains(&part), "{part}: {page}");
    }
}

#[test]
fn a_browser_draws_the_screen_and_lists_the_losses() {
    let Some(program) = chromium() else { return eprintln!("skipped: there is no Chromium") };
    let folder = tempfile::tempdir().unwrap();
    let (sent, file) = (street_stream(&CORE, 3), folder.path().join("packets.bin"));
    let mut bytes = sent.bytes();
    // The damaged packet is the first ROW packet.
    let row = first_packet(&bytes).len();
    bytes[row + 9] ^= 1;
    fs::write(&file, bytes).unwrap();
    let view = open(&file, &CORE, None).unwrap();
    wait_for(view.link(), "end", |state| state["status"] == "ended");
    let picture = folder.path().join("page.png");
    let run = |more: &str| browse(&program, folder.path(), more, view.link());
    let page = run("--dump-dom");
    for part in [
        "<dd id=\"number\">2</dd>",
        "<dd id=\"frames\">3</dd>",
        "<dd id=\"losses\">2</dd>",
        "class=\"ended\">the stream has ended; frames shown: 3</p>",
        "frame 0, row 0: decisions are missing",
        "<canvas id=\"pixels\" width=\"40\" height=\"30\">",
        "<canvas id=\"regions\" width=\"5\" height=\"4\"",
        "40 x 30 pixels, 5 x 4 regions of 8 x 8",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }

    // The greens of active regions appear in the picture of the page, over the screen.
    run(&format!("--screenshot={}", picture.display()));
    let picture = image::open(&picture).unwrap().to_rgb8();
    let tinted = |pixel: &&image::Rgb<u8>| {
        let [red, green, blue] = pixel.0;
        green > red.saturating_add(30) && green > blue.saturating_add(10)
    };
    let is_active = sent.pictures[2][..20].iter().any(|&byte| byte & 3 == 3);
    let count = picture.pixels().filter(tinted).count();
    // The screen is left of the charts, whose lines are green, too.
    let screen = picture.enumerate_pixels().filter(|(x, ..)| *x < 500);
    let colours: HashSet<_> = screen.map(|(.., pixel)| pixel).filter(tinted).collect();
    assert!(is_active && count > 1000, "{count} pixels are green");
    assert!(colours.len() > 9, "only {} greens: no picture below them", colours.len());
}
