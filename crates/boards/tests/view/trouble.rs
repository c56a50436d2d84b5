// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that damage, other designs, silence, and ports that go away are reported on the page and
//! in the terminal, and do not end the view.

use std::fs;

use foveate_boards::view::View;
use foveate_design::DesignConfig;
use serde_json::json;

use crate::client::{open, wait_for};
use crate::line::SerialLine;
use crate::sent::{CORE, first_packet, street_stream};

/// Collects messages until one contains all of `parts`.
fn wait_for_message(view: &View, parts: &[&str]) -> Vec<String> {
    let mut all = Vec::new();
    for _ in 0..2000 {
        all.extend(view.take_messages());
        if all.iter().any(|text: &String| parts.iter().all(|part| text.contains(part))) {
            return all;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    panic!("no {parts:?}: {all:?}");
}

#[test]
fn a_damaged_packet_is_listed_and_all_other_frames_are_shown() {
    let sent = street_stream(&CORE, 3);
    let mut line = SerialLine::new();
    let view = open(&line.path, &CORE, None).unwrap();
    line.send(&sent.frames[0]);
    let mut damaged = sent.frames[1].clone();
    let frame = first_packet(&damaged).len();
    // The damaged packet is the first ROW packet of the second frame.
    assert_eq!(damaged[frame + 1] & 15, 2);
    damaged[frame + 9] ^= 1;
    let row = first_packet(&damaged[frame..]).len();
    line.send(&damaged);
    line.send(&sent.frames[2]);
    let page = wait_for(view.link(), "third frame", |state| state["frames"] == 3);
    assert_eq!(page.state["losses"], json!({"bytes": 1, "row": 1}));
    let listed = [
        "frame 1, row 0: decisions are missing".to_owned(),
        format!("{row} bytes from byte {} on are not a packet", sent.frames[0].len() + frame),
    ];
    assert_eq!(page.state["listed"], json!(listed));
    wait_for_message(&view, &["row 0: decisions are missing"]);
}

#[test]
fn many_losses_are_counted_but_not_all_reported() {
    let folder = tempfile::tempdir().unwrap();
    let (sent, file) = (street_stream(&CORE, 40), folder.path().join("packets.bin"));
    // Every second frame has no END packet.
    let odd = |(number, frame): (usize, &Vec<u8>)| {
        let end = if number % 2 == 1 { frame.len() - 24 } else { frame.len() };
        frame[..end].to_vec()
    };
    let bytes: Vec<u8> = sent.frames.iter().enumerate().flat_map(odd).collect();
    fs::write(&file, bytes).unwrap();
    let view = open(&file, &CORE, Some(foveate_boards::view::PlayMode::AtOnce)).unwrap();
    let page = wait_for(view.link(), "end", |state| state["status"] == "ended");
    assert_eq!((&page.state["losses"], &page.state["frames"]), (&json!({"end": 20}), &40.into()));
    let messages = wait_for_message(&view, &["has ended"]);
    assert_eq!(messages.iter().filter(|text| text.contains("END packet is missing")).count(), 10);
    assert_eq!(
        messages.iter().filter(|text| text.contains("more losses")).count(),
        1,
        "{messages:?}"
    );
}

#[test]
fn another_design_is_refused_until_the_right_one_comes() {
    let other = ["frame={width=40,height=30}", "region.size=5"];
    let (right, wrong) = (street_stream(&CORE, 1), street_stream(&other, 2));
    let mut line = SerialLine::new();
    let view = open(&line.path, &CORE, None).unwrap();
    let fingerprint_of = |set: &[&str]| {
        DesignConfig::from_toml_with("", set).unwrap().validate().unwrap().fingerprint()
    };
    line.send(&wrong.bytes());
    let parts = [&*fingerprint_of(&CORE), &*fingerprint_of(&other)];
    let names_both = |text: &str| parts.iter().all(|part| text.contains(part));
    let page =
        wait_for(view.link(), "message", |state| state["refused"].as_str().is_some_and(names_both));
    assert!(page.picture.is_empty());
    wait_for_message(&view, &parts);
    line.send(&right.bytes());
    let page = wait_for(view.link(), "frame", |state| state["frames"] == 1);
    assert!(page.picture == right.pictures[0]);
    assert_eq!((&page.state["refused"], &page.state["losses"]), (&json!(null), &json!({})));
    // The refusal is reported once, not with every frame.
    assert_eq!(view.take_messages().iter().filter(|text| names_both(text)).count(), 0);
    // The design changes during the stream.
    line.send(&wrong.bytes());
    wait_for(view.link(), "message again", |state| {
        state["refused"].as_str().is_some_and(names_both)
    });
}

/// Returns the packets of a frame with another time.
fn at_time(packets: &[u8], time: u64) -> Vec<u8> {
    let mut packets = packets.to_vec();
    packets[24..32].copy_from_slice(&time.to_le_bytes());
    let mut crc = flate2::Crc::new();
    crc.update(&packets[..52]);
    packets[52..56].copy_from_slice(&crc.sum().to_le_bytes());
    packets
}

#[test]
fn a_time_that_cannot_be_right_does_not_stop_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let sent = street_stream(&CORE, 4);
    for wrong in [1 << 63, u64::MAX, 0] {
        let file = folder.path().join("packets.bin");
        let mut frames = sent.frames.clone();
        frames[2] = at_time(&frames[2], wrong);
        fs::write(&file, frames.concat()).unwrap();
        let view = open(&file, &CORE, None).unwrap();
        let page = wait_for(view.link(), "end", |state| state["status"] == "ended");
        assert_eq!(page.state["frames"], 4, "{wrong}");
        assert!(page.picture == sent.pictures[3]);
        let losses = page.state["losses"]["time"].as_u64().unwrap();
        assert!((1..=2).contains(&losses), "{losses} losses");
        wait_for_message(&view, &["frame 2: its time is before the last frame or more than a day"]);
    }
}

#[test]
fn a_long_pause_is_reported_and_cut() {
    let folder = tempfile::tempdir().unwrap();
    let sent = street_stream(&CORE, 2);
    let file = folder.path().join("packets.bin");
    let late = at_time(&sent.frames[1], 3_600_000_000);
    fs::write(&file, [&sent.frames[0][..], &late].concat()).unwrap();
    let start = std::time::Instant::now();
    let view = open(&file, &CORE, None).unwrap();
    let is_due =
        |state: &serde_json::Value| state["text"].as_str().unwrap().contains("frame 1 is due in");
    wait_for(view.link(), "message", is_due);
    wait_for_message(&view, &["frame 1 comes 3600 s after", "cut"]);
    let page = wait_for(view.link(), "end", |state| state["status"] == "ended");
    assert!(page.picture == sent.pictures[1] && start.elapsed().as_secs() >= 10);
}

#[test]
fn refusals_that_alternate_with_frames_do_not_flood_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let other = ["frame={width=40,height=30}", "region.size=5"];
    let (right, wrong) = (street_stream(&CORE, 40), street_stream(&other, 1));
    let wrong_then_right = |frame: &Vec<u8>| [&wrong.frames[0][..56], frame].concat();
    let file = folder.path().join("packets.bin");
    fs::write(&file, right.frames.iter().flat_map(wrong_then_right).collect::<Vec<u8>>()).unwrap();
    let view = open(&file, &CORE, Some(foveate_boards::view::PlayMode::AtOnce)).unwrap();
    let page = wait_for(view.link(), "end", |state| state["status"] == "ended");
    assert_eq!(page.state["frames"], 40);
    let messages = wait_for_message(&view, &["has ended"]);
    assert_eq!(messages.iter().filter(|text| text.contains("was sent by design")).count(), 10);
}

#[test]
fn noise_without_packets_is_reported() {
    let sent = street_stream(&CORE, 1);
    let mut line = SerialLine::new();
    let view = open(&line.path, &CORE, None).unwrap();
    for _ in 0..20 {
        line.send(&[0x5A; 1 << 16]);
    }
    let page = wait_for(view.link(), "loss", |state| state["losses"]["bytes"] == 1);
    assert_eq!(page.state["frames"], 0);
    wait_for_message(&view, &["bytes from byte 0 on are not a packet"]);
    line.send(&sent.frames[0]);
    let page = wait_for(view.link(), "frame", |state| state["frames"] == 1);
    assert!(page.picture == sent.pictures[0]);
}

#[test]
fn silence_is_reported_until_bytes_come() {
    let sent = street_stream(&CORE, 2);
    let mut line = SerialLine::new();
    let view = open(&line.path, &CORE, None).unwrap();
    line.send(&sent.frames[0]);
    let page = wait_for(view.link(), "frame", |state| state["frames"] == 1);
    assert_eq!(page.state["silent"], false);
    wait_for_message(&view, &["nothing has come", "2 s"]);
    let page = wait_for(view.link(), "silence", |state| state["silent"] == true);
    assert_eq!(page.state["status"], "running");
    line.send(&sent.frames[1]);
    let page = wait_for(view.link(), "frame", |state| state["frames"] == 2);
    assert_eq!(page.state["silent"], false);
}

#[test]
fn a_port_that_is_gone_is_reported() {
    let sent = street_stream(&CORE, 1);
    let mut line = SerialLine::new();
    let view = open(&line.path, &CORE, None).unwrap();
    line.send(&sent.frames[0]);
    wait_for(view.link(), "frame", |state| state["frames"] == 1);
    let path = line.path.display().to_string();
    drop(line);
    let page = wait_for(view.link(), "message", |state| state["status"] == "gone");
    assert!(page.state["text"].as_str().unwrap().contains(&path), "{}", page.state);
    // The last frame is still shown.
    assert!(page.picture == sent.pictures[0]);
    wait_for_message(&view, &[&path, "is gone"]);
}
