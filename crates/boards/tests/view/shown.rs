// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the page gets the simulated frames, at their times.

use std::fs;
use std::io::Write;
use std::net::TcpStream;
use std::time::{Duration, Instant};

use foveate_boards::view::PlayMode;
use foveate_design::DesignConfig;
use foveate_packets::{PacketLayout, packet_encoding};

use crate::client::{get, link_parts, open, page_after, wait_for};
use crate::line::SerialLine;
use crate::sent::{CORE, SentStream, street_stream};

/// Designs with every rendering of irrelevant regions, some with more bits per pixel than a page.
const DESIGNS: [&[&str]; 4] = [
    &["frame={width=45,height=38}"],
    &["frame={width=33,height=50,pixel_bits=10}", "render.irrelevant='hold'"],
    &[
        "frame={width=45,height=38}",
        "render.irrelevant='mean'",
        "spatial=[{feature='edge',min_score=12}]",
    ],
    &CORE,
];

#[test]
fn frames_over_a_line_are_those_of_the_simulator() {
    for set in DESIGNS {
        let SentStream { frames, pictures } = street_stream(set, 5);
        let mut line = SerialLine::new();
        let view = open(&line.path, set, None).unwrap();
        let mut bytes = 0;
        for (number, (packets, picture)) in (0u64..).zip(frames.iter().zip(&pictures)) {
            // A line delivers bytes in pieces.
            packets.chunks(1000).for_each(|piece| line.send(piece));
            let page = wait_for(view.link(), "frame", |state| state["frames"] == number + 1);
            assert!(page.picture == *picture, "frame {number} of {set:?} differs");
            let newest = &page.state["history"][0];
            assert_eq!(
                (&newest["number"], &newest["bytes"]),
                (&number.into(), &packets.len().into())
            );
            let regions = picture.iter().take(picture.len() - pixels(&page.state));
            assert_eq!(newest["active"], regions.filter(|&byte| byte & 3 == 3).count());
            bytes += packets.len();
            assert_eq!(
                (&page.state["bytes"], &page.state["status"]),
                (&bytes.into(), &"running".into())
            );
            assert_eq!(page.state["losses"], serde_json::json!({}));
        }
        // A browser that knows all changes gets nothing again.
        let state = page_after(view.link(), 0).state;
        let again = page_after(view.link(), state["change"].as_u64().unwrap());
        assert!(again.picture.is_empty() && again.state["history"] == serde_json::json!([]));
        assert_eq!(view.frames_shown(), 5);
    }
}

#[test]
fn the_version_of_the_map_is_shown_only_with_zones() {
    let set = ["frame={width=45,height=38}", "zones={}"];
    for (set, map_versions) in [(&set[..1], [0, 0, 0]), (&set[..], [0, 1, 65_535])] {
        let config = DesignConfig::from_toml_with("", set).unwrap();
        let layout = PacketLayout::new(&config.validate().unwrap(), false, 1_000_000).unwrap();
        let mut line = SerialLine::new();
        let view = open(&line.path, set, None).unwrap();
        let numbered = street_stream(set, 3).frames;
        for ((number, packets), version) in (0u32..).zip(&numbered).zip(map_versions) {
            // The FRAME is replaced by one with another version.
            let start = (u64::from(number) * 33_333, number == 0);
            let mut sent = Vec::new();
            packet_encoding::append_frame_of_map(&mut sent, &layout, number, start, version)
                .unwrap();
            sent.extend(&packets[layout.frame_bytes()..]);
            line.send(&sent);
            let page = wait_for(view.link(), "frame", |state| state["frames"] == number + 1);
            let shown = page.state["history"][0].get("map_version").cloned();
            assert_eq!(shown, layout.has_zones().then(|| version.into()), "{set:?}");
            assert_eq!(page.state["losses"], serde_json::json!({}));
        }
    }
}

/// Returns the number of pixels of a frame.
fn pixels(state: &serde_json::Value) -> usize {
    let side = |name: &str| state["design"][name].as_u64().unwrap();
    usize::try_from(side("width") * side("height")).unwrap()
}

#[test]
fn a_file_is_played_by_its_times_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let (sent, file) = (street_stream(&CORE, 7), folder.path().join("packets.bin"));
    fs::write(&file, sent.bytes()).unwrap();
    // The frames have 1/30 s between them.
    for (play, least, most) in [(None, 199, 5000), (Some(PlayMode::AtOnce), 0, 199)] {
        let view = open(&file, &CORE, play).unwrap();
        let page = wait_for(view.link(), "end", |state| state["status"] == "ended");
        assert!(page.picture == sent.pictures[6]);
        assert_eq!(page.state["frames"], 7);
        let shown: Vec<u64> = page.state["history"]
            .as_array()
            .unwrap()
            .iter()
            .map(|figures| figures["shown_ms"].as_u64().unwrap())
            .collect();
        let took = shown[0] - shown[6];
        assert!((least..most).contains(&took), "{play:?}: {took} ms");
        let messages = view.take_messages();
        assert!(
            messages.iter().any(|text| text.contains("has ended; frames shown: 7")),
            "{messages:?}"
        );
    }
}

#[test]
fn a_file_is_played_again_and_again() {
    let folder = tempfile::tempdir().unwrap();
    let (sent, file) = (street_stream(&CORE, 3), folder.path().join("packets.bin"));
    fs::write(&file, sent.bytes()).unwrap();
    let view = open(&file, &CORE, Some(PlayMode::Looped)).unwrap();
    let page = wait_for(view.link(), "third round", |state| state["frames"].as_u64() > Some(8));
    assert_eq!(
        (&page.state["status"], &page.state["losses"]),
        (&"running".into(), &serde_json::json!({}))
    );
    assert_eq!(view.take_messages().len(), 1);
}

#[test]
fn a_fifo_is_shown_as_it_comes() {
    let folder = tempfile::tempdir().unwrap();
    let (sent, fifo) = (street_stream(&CORE, 3), folder.path().join("fifo"));
    let made = std::process::Command::new("mkfifo").arg(&fifo).status().unwrap();
    assert!(made.success());
    let view = open(&fifo, &CORE, None).unwrap();
    assert_eq!(page_after(view.link(), 0).state["status"], "waiting");
    let mut writer = fs::OpenOptions::new().write(true).open(&fifo).unwrap();
    writer.write_all(&sent.frames[0]).unwrap();
    let page = wait_for(view.link(), "frame", |state| state["frames"] == 1);
    assert!(page.picture == sent.pictures[0]);
    drop(writer);
    wait_for(view.link(), "end", |state| state["status"] == "ended");
}

/// The frames have a megabyte, so that no buffer of a connection holds many of them.
#[test]
fn a_browser_that_does_not_read_does_not_stop_the_stream() {
    let set = ["frame={width=1280,height=800}", "region.size=16"];
    let sent = street_stream(&set, 2);
    let (first, second) = (&sent.frames[0], &sent.frames[1]);
    let mut line = SerialLine::new();
    let view = open(&line.path, &set, None).unwrap();
    line.send(first);
    wait_for(view.link(), "frame", |state| state["frames"] == 1);
    let (host, token) = link_parts(view.link());
    let mut stuck = TcpStream::connect(host).unwrap();
    for _ in 0..20 {
        let ask = format!("GET /{token}/next?after=0 HTTP/1.1\r\nHost: {host}\r\n\r\n");
        stuck.write_all(ask.as_bytes()).unwrap();
    }
    std::thread::sleep(Duration::from_millis(300));
    let start = Instant::now();
    for _ in 0..20 {
        // The frame has the number and the time of the first one, which restarts the stream.
        line.send(first);
    }
    line.send(second);
    let page = wait_for(view.link(), "last frame", |state| state["frames"] == 22);
    assert!(page.picture == sent.pictures[1]);
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    drop(stuck);
    assert_eq!(get(view.link(), "").status, 200);
}
