// SPDX-License-Identifier: MIT OR Apache-2.0
//! The part of HTTP/1.1 that a browser on the same machine needs: requests with a length, one after
//! the other on a connection. Requests and answers have limits in bytes, lines and time.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::Duration;

use crate::view::timed_stream::TimedStream;

/// The largest head of a request, in bytes.
const HEAD_LIMIT: u64 = 16 << 10;
/// The largest number of lines in a head.
const LINE_LIMIT: usize = 100;
/// The largest body of a request, in bytes.
const BODY_LIMIT: usize = 4 << 10;
/// The time for a whole request, from its first byte on. For the first request of a connection it
/// begins with the connection.
const REQUEST_TIME: Duration = Duration::from_secs(5);
/// The longest silence between two requests.
const IDLE_TIME: Duration = Duration::from_secs(30);
/// The time in which a browser must take an answer. It gets one more second for every
/// [`BYTES_PER_SECOND`] bytes.
const ANSWER_TIME: Duration = Duration::from_secs(10);
const BYTES_PER_SECOND: usize = 64 << 10;

/// A request of a browser.
#[derive(Debug)]
pub(crate) struct HttpRequest {
    pub(crate) method: String,
    pub(crate) target: String,
    /// The name of the server in the request.
    pub(crate) host: String,
    pub(crate) body: Vec<u8>,
}

/// An answer to a request.
#[derive(Debug)]
pub(crate) struct HttpAnswer {
    pub(crate) status: &'static str,
    pub(crate) kind: &'static str,
    pub(crate) body: Vec<u8>,
}

impl HttpAnswer {
    pub(crate) fn text(status: &'static str, text: &str) -> Self {
        let body = format!("{text}\n").into_bytes();
        Self { status, kind: "text/plain; charset=utf-8", body }
    }

    /// Returns the answer to a method that the path does not have.
    pub(crate) fn method_not_allowed() -> Self {
        Self::text("405 Method Not Allowed", "this address does not support that method")
    }

    pub(crate) fn binary(body: Vec<u8>) -> Self {
        Self { status: "200 OK", kind: "application/octet-stream", body }
    }
}

/// The requests of a browser on one connection, each with its answer.
#[derive(Debug)]
pub(crate) struct RequestStream {
    requests: BufReader<TimedStream>,
    is_begun: bool,
}

impl RequestStream {
    pub(crate) fn new(stream: Arc<TcpStream>) -> Self {
        Self { requests: BufReader::new(TimedStream::new(stream)), is_begun: false }
    }

    /// Returns the next request; `None` if the browser sends no more.
    pub(crate) fn next(&mut self) -> io::Result<Option<HttpRequest>> {
        if std::mem::replace(&mut self.is_begun, true) {
            self.requests.get_mut().set_deadline(IDLE_TIME);
            if self.requests.fill_buf()?.is_empty() {
                return Ok(None);
            }
        }
        self.requests.get_mut().set_deadline(REQUEST_TIME);
        read_request(&mut self.requests)
    }

    /// Writes an answer. Browsers do not store it, and other pages cannot show it; `policy` says
    /// what it may load. `is_last` announces the end of the connection.
    pub(crate) fn answer(
        &mut self,
        answer: &HttpAnswer,
        policy: &str,
        is_last: bool,
    ) -> io::Result<()> {
        let HttpAnswer { status, kind, body } = answer;
        let connection = if is_last { "close" } else { "keep-alive" };
        let head = format!(
            "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: {connection}\r\n\
             Content-Security-Policy: {policy}\r\nCache-Control: no-store\r\n\
             Referrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\nCross-Origin-Resource-Policy: same-origin\r\n\r\n",
            body.len()
        );
        let stream = self.requests.get_mut();
        let extra_seconds = u64::try_from(body.len() / BYTES_PER_SECOND).unwrap_or(u64::MAX);
        stream.set_deadline(ANSWER_TIME.saturating_add(Duration::from_secs(extra_seconds)));
        stream.write_all(&[head.as_bytes(), body].concat())
    }
}

fn invalid(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what.to_owned())
}

/// Reads a line without its end; `None` at the end of the stream.
fn read_line(head: &mut impl BufRead) -> io::Result<Option<String>> {
    let mut text = Vec::new();
    head.read_until(b'\n', &mut text)?;
    match text.strip_suffix(b"\n") {
        Some(text) => Ok(Some(String::from_utf8_lossy(text).trim_end().to_owned())),
        None if text.is_empty() => Ok(None),
        None => Err(invalid("a line of the request has no end")),
    }
}

/// Sets a header that may occur only once.
fn set_once<T>(header: &mut Option<T>, value: T) -> io::Result<()> {
    match header.replace(value) {
        None => Ok(()),
        Some(_) => Err(invalid("a header of the request appears twice")),
    }
}

fn read_request(stream: &mut impl BufRead) -> io::Result<Option<HttpRequest>> {
    let mut head = stream.by_ref().take(HEAD_LIMIT);
    let Some(first) = read_line(&mut head)? else { return Ok(None) };
    let mut words = first.split(' ');
    let (method, target) = words
        .next()
        .zip(words.next())
        .ok_or_else(|| invalid("the first line of the request has no method and path"))?;
    let (method, target) = (method.to_owned(), target.to_owned());
    let (mut host, mut length) = (None, None);
    for number in 1.. {
        let text =
            read_line(&mut head)?.ok_or_else(|| invalid("the head of the request has no end"))?;
        if text.is_empty() {
            break;
        }
        if number >= LINE_LIMIT {
            return Err(invalid("the head of the request has too many lines"));
        }
        let Some((name, value)) = text.split_once(':') else { continue };
        match name.to_ascii_lowercase().as_str() {
            "host" => set_once(&mut host, value.trim().to_owned())?,
            "content-length" => set_once(&mut length, parse_body_length(value.trim())?)?,
            "transfer-encoding" => return Err(invalid("the body of the request has no length")),
            _ => {}
        }
    }
    let mut body = vec![0; length.unwrap_or(0)];
    stream.read_exact(&mut body)?;
    Ok(Some(HttpRequest { method, target, host: host.unwrap_or_default(), body }))
}

/// Parses the length of a body, up to [`BODY_LIMIT`].
fn parse_body_length(text: &str) -> io::Result<usize> {
    let digits = text.bytes().all(|byte| byte.is_ascii_digit());
    let length: Option<usize> = if digits { text.parse().ok() } else { None };
    length
        .filter(|&length| length <= BODY_LIMIT)
        .ok_or_else(|| invalid("the length of the request's body is not a number, or too large"))
}
