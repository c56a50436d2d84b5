// SPDX-License-Identifier: MIT OR Apache-2.0
//! As much of HTTP/1.1 as a browser on the same machine needs: requests with a length, one after the other on a
//! connection.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::TcpStream;

/// Longest head of a request.
const HEAD: u64 = 16 << 10;
/// Longest body of a request.
const BODY: usize = 4 << 10;

/// A request.
#[derive(Debug)]
pub(crate) struct Request {
    pub(crate) method: String,
    pub(crate) target: String,
    /// Whom the browser means to talk to.
    pub(crate) host: String,
    pub(crate) body: Vec<u8>,
}

/// An answer.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) status: &'static str,
    pub(crate) kind: &'static str,
    pub(crate) body: Vec<u8>,
}

impl Answer {
    pub(crate) fn text(status: &'static str, text: &str) -> Self {
        let body = format!("{text}\n").into_bytes();
        Self { status, kind: "text/plain; charset=utf-8", body }
    }

    /// To a method that is not for this.
    pub(crate) fn not_so() -> Self {
        Self::text("405 Method Not Allowed", "not so")
    }

    pub(crate) fn binary(body: Vec<u8>) -> Self {
        Self { status: "200 OK", kind: "application/octet-stream", body }
    }
}

/// The next request; none where the browser has no more.
pub(crate) fn read(stream: &mut BufReader<TcpStream>) -> io::Result<Option<Request>> {
    let invalid = |what: &str| io::Error::new(io::ErrorKind::InvalidData, what.to_owned());
    let mut head = stream.by_ref().take(HEAD);
    let line = |head: &mut io::Take<_>| {
        let mut text = Vec::new();
        BufRead::read_until(head, b'\n', &mut text)?;
        match text.strip_suffix(b"\n") {
            Some(text) => Ok(Some(String::from_utf8_lossy(text).trim_end().to_owned())),
            None if text.is_empty() => Ok(None),
            None => Err(invalid("a line without an end")),
        }
    };
    let Some(first) = line(&mut head)? else { return Ok(None) };
    let mut words = first.split(' ');
    let (method, target) = words.next().zip(words.next()).ok_or_else(|| invalid("no request"))?;
    let (method, target) = (method.to_owned(), target.to_owned());
    let (mut host, mut length) = (String::new(), 0);
    loop {
        let text = line(&mut head)?.ok_or_else(|| invalid("a head without an end"))?;
        if text.is_empty() {
            break;
        }
        let Some((name, value)) = text.split_once(':') else { continue };
        match name.to_ascii_lowercase().as_str() {
            "host" => host = value.trim().to_owned(),
            "content-length" => {
                length = value.trim().parse().map_err(|_| invalid("no length"))?;
            }
            _ => {}
        }
    }
    if length > BODY {
        return Err(invalid("a body that is too long"));
    }
    let mut body = vec![0; length];
    stream.read_exact(&mut body)?;
    Ok(Some(Request { method, target, host, body }))
}

/// Writes an answer. Nothing of it is kept or shown in other pages; `policy` says what it may load.
pub(crate) fn write(stream: &mut TcpStream, answer: &Answer, policy: &str) -> io::Result<()> {
    let Answer { status, kind, body } = answer;
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n\
         Content-Security-Policy: {policy}\r\nCache-Control: no-store\r\n\
         Referrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\nCross-Origin-Resource-Policy: same-origin\r\n\r\n",
        body.len()
    );
    stream.write_all(&[head.as_bytes(), body].concat())?;
    stream.flush()
}
