// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the page is protected: it needs the link and the right host name, and cannot be
//! reached from another machine.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use foveate_boards::view::{PlayMode, View, ViewError, ViewOptions};
use foveate_design::DesignConfig;

use crate::client::{get, link_parts, open, request};
use crate::sent::{CORE, street_stream};

fn view(folder: &Path) -> View {
    let file = folder.join("packets.bin");
    fs::write(&file, street_stream(&CORE, 1).bytes()).unwrap();
    open(&file, &CORE, None).unwrap()
}

#[test]
fn only_the_link_opens_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let view = view(folder.path());
    let (host, token) = link_parts(view.link());
    let status = |line: &str, named: &str| {
        request(host, &format!("{line} HTTP/1.1\r\nHost: {named}\r\n\r\n")).status
    };
    let port = host.rsplit_once(':').unwrap().1;
    assert!(token.len() == 32 && token.bytes().all(|byte| byte.is_ascii_hexdigit()), "{token}");
    assert_eq!(status(&format!("GET /{token}/"), host), 200);
    assert_eq!(status(&format!("GET /{token}/"), &format!("localhost:{port}")), 200);

    let wrong_token = format!("{}{}", &token[..31], if token.ends_with('0') { '1' } else { '0' });
    let paths = ["", "next?after=0", "register"];
    for path in paths {
        for (token, named) in [
            (wrong_token.as_str(), host),
            (&token[..31], host),
            ("", host),
            ("x", host),
            (token, "evil.example"),
            (token, &format!("evil.example:{port}")),
            (token, "127.0.0.1"),
            (token, &format!("127.0.0.1.evil.example:{port}")),
            (token, ""),
        ] {
            let line = if path == "register" { "POST" } else { "GET" };
            assert_eq!(
                status(&format!("{line} /{token}/{path}"), named),
                403,
                "{token} {named} {path}"
            );
        }
    }
    for line in ["GET /", "GET //", "GET /favicon.ico", &format!("GET /{token}"), "GET *"] {
        assert_eq!(status(line, host), 403, "{line}");
    }
    assert_eq!(request(host, &format!("GET /{token}/ HTTP/1.1\r\n\r\n")).status, 403);
    assert_eq!(status(&format!("GET /{token}/other"), host), 404);
    assert_eq!(status(&format!("GET /{token}/../etc/passwd"), host), 404);
    assert_eq!(status(&format!("DELETE /{token}/"), host), 405);
    assert_eq!(status(&format!("GET /{token}/register"), host), 405);
    // A request that is too long, or that is no request, ends the connection.
    assert_eq!(status(&format!("GET /{token}/{}", "x".repeat(40_000)), host), 0);
    assert_eq!(status("nonsense", host), 403);
    let announced = format!(
        "POST /{token}/register HTTP/1.1\r\nHost: {host}\r\nContent-Length: 99999999\r\n\r\n"
    );
    // The connection ends at once: no memory is kept for a client that only announces much data.
    let start = Instant::now();
    assert_eq!(request(host, &announced).status, 0);
    assert!(start.elapsed() < Duration::from_secs(15), "{:?}", start.elapsed());
    assert_ne!(open(&folder.path().join("packets.bin"), &CORE, None).unwrap().link(), view.link());
}

#[test]
fn the_page_loads_nothing_and_is_not_stored() {
    let folder = tempfile::tempdir().unwrap();
    let view = view(folder.path());
    let answer = get(view.link(), "");
    let page = String::from_utf8(answer.body).unwrap();
    let loads = ["src=", "href=\"http", "url(", "@import", "//cdn", "https:"];
    assert!(loads.iter().all(|part| !page.contains(part)), "the page loads something");
    for part in [
        "default-src 'none'",
        "connect-src 'self'",
        "frame-ancestors 'none'",
        "no-store",
        "no-referrer",
    ] {
        assert!(answer.head.contains(part), "{part}: {}", answer.head);
    }
    let nonce = answer.head.split("script-src 'nonce-").nth(1).unwrap().split('\'').next().unwrap();
    assert!(page.contains(&format!("<script nonce=\"{nonce}\">")), "{nonce}");
    assert!(!page.contains("NONCE") && !page.contains("/*LIGHT*/"));
    assert!(page.contains("--k4:#009e73"), "no colours of the palette");
}

#[test]
fn an_input_that_cannot_be_shown_is_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let refusal = |input: &Path, play| open(input, &CORE, play).unwrap_err().to_string();
    assert!(refusal(&folder.path().join("none"), None).contains("none"));
    assert!(refusal(folder.path(), None).contains("is a folder"));
    assert!(refusal(Path::new("/dev/null"), None).contains("not a serial port"));
    assert!(refusal(Path::new("-"), Some(PlayMode::Looped)).contains("not a file"));
    let file = folder.path().join("packets.bin");
    fs::write(&file, "").unwrap();
    for (address, is_refused) in
        [("0.0.0.0:0", true), ("192.168.1.5:0", true), ("[::]:0", true), ("127.0.0.1:0", false)]
    {
        let options = ViewOptions {
            input: file.clone(),
            config: DesignConfig::default(),
            baud: 9600,
            address: address.parse().unwrap(),
            play: None,
        };
        let opened = View::open(options);
        assert_eq!(matches!(opened, Err(ViewError::Address { .. })), is_refused, "{address}");
    }
}
