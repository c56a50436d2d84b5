// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that slow, idle or too many connections do not keep the page from a browser that behaves
//! well.

use std::fs;
use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use foveate_boards::view::{PlayMode, Player, PlayerOptions};
use foveate_media::InputOptions;

use crate::client::{get, link_parts, open, request};
use crate::sent::{CORE, street_stream};

/// The number of foreign connections, which is more than the server keeps.
const CONNECTION_COUNT: usize = 100;
/// The time within which a browser that behaves well is served, also on a busy machine.
const SERVING_LIMIT: Duration = Duration::from_secs(3);

/// Runs a test on both pages that the library serves.
fn on_both_pages(test: impl Fn(&str)) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("packets.bin");
    fs::write(&file, street_stream(&CORE, 1).bytes()).unwrap();
    let view = open(&file, &CORE, Some(PlayMode::AtOnce)).unwrap();
    test(view.link());
    let player = Player::open(PlayerOptions {
        inputs: Vec::new(),
        input: InputOptions::default(),
        preset: None,
        camera: None,
        address: "127.0.0.1:0".parse().unwrap(),
    });
    let player = player.unwrap();
    // The engine is compressed for the first browser.
    assert_eq!(get(&player.link(), "").status, 200);
    test(&player.link());
}

/// Returns connections that have sent the beginning of a request and nothing else.
fn begin_requests(host: &str, text: &str) -> Vec<TcpStream> {
    let begin = |_| {
        let mut stream = TcpStream::connect(host).unwrap();
        // The server may have closed the connection already.
        let _ = stream.write_all(text.as_bytes());
        stream
    };
    (0..CONNECTION_COUNT).map(begin).collect()
}

fn assert_served_promptly(link: &str, what: &str) {
    let start = Instant::now();
    assert_eq!(get(link, what).status, 200, "{what:?} is not served");
    assert!(start.elapsed() < SERVING_LIMIT, "{what:?} took {:?}", start.elapsed());
}

#[test]
fn connections_without_the_token_do_not_block_the_page() {
    on_both_pages(|link| {
        let (host, _) = link_parts(link);
        for text in ["", "G", "GET /x/ HTTP/1.1\r\n", "GET /x/ HTTP/1.1\r\nHost: x\r\n\r\n"] {
            let held = begin_requests(host, text);
            assert_served_promptly(link, "");
            drop(held);
        }
    });
}

#[test]
fn browsers_that_are_idle_or_do_not_read_do_not_block_the_page() {
    on_both_pages(|link| {
        let (host, token) = link_parts(link);
        let whole = format!("GET /{token}/ HTTP/1.1\r\nHost: {host}\r\n\r\n");
        // The first request is served and its connection stays open. The others ask for more than a
        // connection holds, and do not read it.
        for text in [whole.clone(), whole.repeat(30)] {
            let held = begin_requests(host, &text);
            assert_served_promptly(link, "");
            drop(held);
        }
    });
}

/// Sends a byte every now and then. Returns the time until the server closes the connection.
fn drip_request(host: &str, text: &str) -> Duration {
    let mut stream = TcpStream::connect(host).unwrap();
    stream.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
    let start = Instant::now();
    for byte in text.bytes().cycle() {
        if stream.write_all(&[byte]).is_err() {
            break;
        }
        match stream.read(&mut [0; 64]) {
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Ok(0) | Err(_) => break,
            Ok(_) => panic!("half a request was answered"),
        }
        assert!(
            start.elapsed() < Duration::from_secs(20),
            "a byte at a time is listened to for ever"
        );
    }
    start.elapsed()
}

#[test]
fn a_request_has_a_time_in_total_not_for_each_byte() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("packets.bin");
    fs::write(&file, street_stream(&CORE, 1).bytes()).unwrap();
    let view = open(&file, &CORE, Some(PlayMode::AtOnce)).unwrap();
    let (host, token) = link_parts(view.link());
    let texts = [
        "GET /xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx".to_owned(),
        format!("POST /{token}/register HTTP/1.1\r\nHost: {host}\r\nContent-Length: 4000\r\n\r\n"),
    ];
    std::thread::scope(|scope| {
        let start_drip = |text| scope.spawn(move || drip_request(host, text));
        let drips: Vec<_> = texts.iter().map(|text| start_drip(text.as_str())).collect();
        for duration in drips {
            let duration = duration.join().unwrap();
            assert!(duration > Duration::from_secs(4), "only {duration:?}");
        }
    });
}

#[test]
fn a_request_that_is_too_long_or_repeats_a_header_ends_the_connection() {
    on_both_pages(|link| {
        let (host, token) = link_parts(link);
        let status = |more: &str| {
            request(host, &format!("GET /{token}/ HTTP/1.1\r\nHost: {host}\r\n{more}\r\n")).status
        };
        assert_eq!(status(&"X: y\r\n".repeat(50)), 200);
        for more in [
            "X: y\r\n".repeat(200),
            format!("X: {}\r\n", "y".repeat(20_000)),
            format!("Host: {host}\r\n"),
            "Content-Length: 0\r\nContent-Length: 0\r\n".to_owned(),
            "Content-Length: 4097\r\n".to_owned(),
            "Content-Length: 99999999999999999999999\r\n".to_owned(),
            "Content-Length: -1\r\n".to_owned(),
            "Content-Length: +0\r\n".to_owned(),
            "Transfer-Encoding: chunked\r\n".to_owned(),
        ] {
            assert_eq!(status(&more), 0, "{more:.60}");
        }
    });
}
