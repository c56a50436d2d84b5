// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the frames of an input for the page that runs a camera. Each frame of a clip comes
//! once, in order, with the pixels of the file.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use foveate_boards::view::{Player, PlayerOptions, ViewError};
use foveate_camera::CameraConfig;
use foveate_media::{InputOptions, open};
use foveate_pixels::FramePixels;
use serde_json::Value;

use crate::client::{HttpResponse, get, link_parts, request};

fn play(inputs: &[&str]) -> Result<Player, ViewError> {
    play_at(inputs, "127.0.0.1:0")
}

fn play_at(inputs: &[&str], address: &str) -> Result<Player, ViewError> {
    Player::open(PlayerOptions {
        inputs: inputs.iter().copied().map(str::to_owned).collect(),
        input: InputOptions { frames: Some(3), ..InputOptions::default() },
        preset: None,
        camera: None,
        address: address.parse().unwrap(),
    })
}

/// Returns the head and the pixels of an answer.
fn frame(link: &str, after: i64) -> (Value, Vec<u8>) {
    let answer = get(link, &format!("frames?after={after}"));
    assert_eq!(answer.status, 200);
    let (length, rest) = answer.body.split_first_chunk().unwrap();
    let (text, pixels) = rest.split_at(u32::from_le_bytes(*length) as usize);
    (serde_json::from_slice(text).unwrap(), pixels.to_owned())
}

/// Returns the status of an answer for a page of this name.
fn status_for(link: &str, viewer: &str, after: i64) -> String {
    let answer = get(link, &format!("frames?after={after}&viewer={viewer}"));
    let (length, rest) = answer.body.split_first_chunk().unwrap();
    let head: Value =
        serde_json::from_slice(&rest[..u32::from_le_bytes(*length) as usize]).unwrap();
    head["status"].as_str().unwrap().to_owned()
}

#[test]
fn only_the_page_that_began_last_gets_frames() {
    let player = play(&["scene:street"]).unwrap();
    let link = player.link();
    assert_eq!(status_for(&link, "one", -1), "running");
    assert_eq!(status_for(&link, "two", -1), "running");
    assert_eq!(status_for(&link, "one", 0), "taken");
    assert_eq!(status_for(&link, "two", 0), "running");
    // A page takes the input back under another name. A page without a name gets frames in any
    // case.
    assert_eq!(status_for(&link, "three", -1), "running");
    assert_eq!(status_for(&link, "two", 1), "taken");
    assert_eq!(frame(&link, 0).0["status"], "running");
    // A page that waits for a frame learns that another one has begun.
    let number =
        (0..70).map(|number| status_for(&link, &format!("{number}{}", "x".repeat(200)), -1));
    assert_eq!(number.filter(|status| status == "running").count(), 70);
}

fn restart(link: &str) -> HttpResponse {
    let (host, token) = link_parts(link);
    request(host, &format!("POST /{token}/restart HTTP/1.1\r\nHost: {host}\r\n\r\n"))
}

/// Returns the frames of a scene as `simulate` reads them.
fn expected() -> Vec<Vec<u8>> {
    let options = InputOptions { frames: Some(3), ..InputOptions::default() };
    let mut source = open(&["scene:street"], &CameraConfig::default(), &options).unwrap();
    let mut frames = Vec::new();
    while let Some(next) = source.next_frame().unwrap() {
        match next.frame.borrowed_pixels() {
            FramePixels::Bytes(pixels) => frames.push(pixels.to_vec()),
            FramePixels::Words(_) => panic!("8 bits are bytes"),
        }
    }
    assert!(frames.len() == 3 && frames[0] != frames[1] && frames[1] != frames[2]);
    frames
}

#[test]
fn a_clip_waits_for_the_page_and_loses_no_frame() {
    let (player, expected) = (play(&["scene:street"]).unwrap(), expected());
    let link = player.link();
    let mut after = -1;
    for round in 0..2_i64 {
        for (number, pixels) in (0_i64..).zip(&expected) {
            // The page waits before each frame but the first, and asks twice.
            std::thread::sleep(Duration::from_millis(30 * u64::from(number > 0)));
            let (head, found) = frame(&link, after);
            assert_eq!(head["number"], 3 * round + number, "{head}");
            assert_eq!((&head["status"], &head["live"]), (&"running".into(), &false.into()));
            assert_eq!((&head["width"], &head["height"]), (&224.into(), &224.into()));
            assert_eq!(head["t_us"], [0, 33_333, 66_667][usize::try_from(number).unwrap()]);
            assert!(found == *pixels, "frame {number}");
            assert!(frame(&link, after).1 == *pixels, "frame {number} a second time");
            after = head["number"].as_i64().unwrap();
        }
        let (head, found) = frame(&link, after);
        assert_eq!((&head["status"], found.len()), (&"ended".into(), 0), "{head}");
        assert!(head["text"].as_str().unwrap().contains("has ended"), "{head}");
        // The page begins again as a new page does.
        assert_eq!(restart(&link).status, 200);
        after = if round == 0 { -1 } else { after };
    }
    assert!(player.take_messages().is_empty() && player.frames_decoded() >= 6);
}

#[test]
fn a_request_for_a_frame_far_ahead_does_not_read_the_whole_clip() {
    let player = play(&["scene:street"]).unwrap();
    let link = player.link();
    let (head, found) = frame(&link, i64::MAX);
    assert!(head["status"] == "running" && found.is_empty(), "{head}");
    assert!(player.frames_decoded() < 3, "all {} frames were read", player.frames_decoded());
    assert!(frame(&link, 0).1 == expected()[1], "the clip goes on with another frame");
}

#[test]
fn only_the_link_opens_the_page_and_its_frames() {
    let player = play(&["scene:street"]).unwrap();
    let link = player.link();
    let page = String::from_utf8(get(&link, "").body).unwrap();
    assert!(page.contains("data-frames=\"frames\"") && page.contains("Content-Security-Policy"));
    assert!(get(&link, "").head.contains("frame-ancestors 'none'"));
    assert_eq!(get(&link, "restart").status, 405);
    assert_eq!(get(&link, "register").status, 404);
    let (host, token) = link_parts(&link);
    for path in ["", "frames?after=-1"] {
        for (token, named) in [("x", host), (&token[1..], host), (token, "evil.example")] {
            let text = format!("GET /{token}/{path} HTTP/1.1\r\nHost: {named}\r\n\r\n");
            assert_eq!(request(host, &text).status, 403, "{path}");
        }
    }
    // Without an input the page offers what the browser has.
    let player = play(&[]).unwrap();
    let page = String::from_utf8(get(&player.link(), "").body).unwrap();
    assert!(!page.contains("data-frames=") && page.contains("Foveate, live"));
    assert_eq!(get(&player.link(), "frames?after=-1").status, 404);
}

#[test]
fn an_input_that_breaks_off_is_reported_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cut.y4m");
    let mut clip = b"YUV4MPEG2 W4 H2 F25:1 Cmono\n".to_vec();
    for _ in 0..2 {
        clip.extend(b"FRAME\n12345678");
    }
    clip.truncate(clip.len() - 3);
    fs::write(&file, clip).unwrap();
    let player = play(&[file.to_str().unwrap()]).unwrap();
    let link = player.link();
    assert_eq!(frame(&link, -1).1, b"12345678");
    let (head, found) = frame(&link, 0);
    assert!(head["status"] != "running" && found.is_empty(), "{head}");
    let deadline = Instant::now() + Duration::from_secs(20);
    let messages = loop {
        let messages = player.take_messages();
        if !messages.is_empty() || Instant::now() > deadline {
            break messages;
        }
    };
    assert_eq!(messages, [head["text"].as_str().unwrap()]);
}

#[test]
fn an_input_that_cannot_be_played_is_refused_at_once() {
    let refusal = |input: &str| play(&[input]).unwrap_err().to_string();
    assert!(refusal("missing.mp4").contains("`missing.mp4` does not exist"));
    assert!(refusal("scene:nothing").contains("nothing"));
    assert!(refusal("rtsp://me:secret@127.0.0.1:9/x").contains("rtsp://127.0.0.1:9/x"));
    let outside = play_at(&["scene:street"], "0.0.0.0:0");
    assert!(matches!(outside, Err(ViewError::Address { .. })), "{outside:?}");
    assert!(!Path::new("missing.mp4").exists());
}
