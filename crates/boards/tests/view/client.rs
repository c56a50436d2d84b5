// SPDX-License-Identifier: MIT OR Apache-2.0
//! A client that behaves as the page in a browser.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};

use foveate_boards::view::{PlayMode, View, ViewError, ViewOptions};
use foveate_design::DesignConfig;
use serde_json::Value;

/// A time limit that is longer than anything takes on a busy machine.
const TIME_LIMIT: Duration = Duration::from_secs(60);

/// Opens a view on any free port.
pub(crate) fn open(input: &Path, set: &[&str], play: Option<PlayMode>) -> Result<View, ViewError> {
    View::open(ViewOptions {
        input: input.to_owned(),
        config: DesignConfig::from_toml_with("", set).unwrap(),
        baud: 3_000_000,
        address: "127.0.0.1:0".parse().unwrap(),
        play,
    })
}

/// The answer of a server.
pub(crate) struct HttpResponse {
    pub(crate) status: u32,
    pub(crate) head: String,
    pub(crate) body: Vec<u8>,
}

/// Returns the parts of a link: `127.0.0.1:port` and the token.
pub(crate) fn link_parts(link: &str) -> (&str, &str) {
    let rest = link.strip_prefix("http://").unwrap().strip_suffix('/').unwrap();
    rest.split_once('/').unwrap()
}

/// Sends a request unchanged, and reads the answer.
pub(crate) fn request(host: &str, text: &str) -> HttpResponse {
    let mut stream = TcpStream::connect(host).unwrap();
    stream.write_all(text.as_bytes()).unwrap();
    let mut bytes = Vec::new();
    let head_end = loop {
        let found = bytes.windows(4).position(|four| four == b"\r\n\r\n");
        let mut more = [0; 4096];
        match found {
            Some(at) => break at + 4,
            None => match stream.read(&mut more).unwrap_or(0) {
                0 => return HttpResponse { status: 0, head: String::new(), body: bytes },
                read => bytes.extend(&more[..read]),
            },
        }
    };
    let mut body = bytes.split_off(head_end);
    let head = String::from_utf8(bytes).unwrap();
    let length = head.lines().find_map(|line| line.strip_prefix("Content-Length: ")).unwrap();
    let received = body.len();
    body.resize(length.parse().unwrap(), 0);
    stream.read_exact(&mut body[received..]).unwrap();
    HttpResponse { status: head.split(' ').nth(1).unwrap().parse().unwrap(), head, body }
}

/// Requests a path below the link.
pub(crate) fn get(link: &str, what: &str) -> HttpResponse {
    let (host, token) = link_parts(link);
    request(host, &format!("GET /{token}/{what} HTTP/1.1\r\nHost: {host}\r\n\r\n"))
}

/// Writes a register as the page does.
pub(crate) fn write(link: &str, address: u32, value: u64) -> HttpResponse {
    let (host, token) = link_parts(link);
    let body = format!("{{\"address\":{address},\"value\":{value}}}");
    let length = body.len();
    request(
        host,
        &format!(
            "POST /{token}/register HTTP/1.1\r\nHost: {host}\r\nContent-Length: {length}\r\n\r\n{body}"
        ),
    )
}

pub(crate) struct PageData {
    pub(crate) state: Value,
    /// A byte per region, and then a byte per pixel; empty if no frame is new.
    pub(crate) picture: Vec<u8>,
}

pub(crate) fn page_after(link: &str, after: u64) -> PageData {
    let answer = get(link, &format!("next?after={after}"));
    assert_eq!(answer.status, 200);
    let (length, rest) = answer.body.split_first_chunk().unwrap();
    let (text, picture) = rest.split_at(u32::from_le_bytes(*length) as usize);
    PageData { state: serde_json::from_slice(text).unwrap(), picture: picture.to_owned() }
}

/// Asks until the state of the page fulfils `wanted`. Each answer has the whole state.
pub(crate) fn wait_for(link: &str, what: &str, wanted: impl Fn(&Value) -> bool) -> PageData {
    let deadline = Instant::now() + TIME_LIMIT;
    loop {
        let page = page_after(link, 0);
        if wanted(&page.state) {
            return page;
        }
        assert!(Instant::now() < deadline, "no {what}: {}", page.state);
        std::thread::sleep(Duration::from_millis(5));
    }
}
