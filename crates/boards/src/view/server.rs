// SPDX-License-Identifier: MIT OR Apache-2.0
//! A server of one page for browsers of this machine ([`PageServer`]). Only a browser with the
//! link gets anything, and slow, idle or stuck connections do not affect it.
//!
//! * Every path begins with the random token of the link. The name of the host must be the
//!   server's, so that a foreign page cannot reach it under another name.
//! * A new connection always finds room in the [`ConnectionTable`]: of its [`CONNECTIONS`], the
//!   one that has been silent for the longest time is closed, and those that have not shown the
//!   token are closed first.
//! * A [`RequestStream`] knows only the part of HTTP/1.1 that a browser needs, with limits in
//!   bytes, lines and time.
//! * A [`PageSite`] provides the content; for `foveate view` it is a [`StreamSite`](super::site::StreamSite).

use super::timed_stream::TimedStream;
use crate::view::ViewError;
use foveate_output::page::colour_variables;
use foveate_output::palette::{DARK, LIGHT};
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The time to wait for the connection that wakes the server.
const WAKE_TIME: Duration = Duration::from_millis(200);

/// The pause before the next connection if the system gives none, because too many files are open.
const ACCEPT_PAUSE: Duration = Duration::from_millis(50);

/// The content that a server has below its link.
pub(crate) trait PageSite: Send + Sync + 'static {
    /// Returns the command that prints the link.
    fn command(&self) -> &'static str;

    /// Returns the page, with scripts that `nonce` allows.
    fn page(&self, nonce: &str) -> String;

    /// Returns what the page may load, as a Content-Security-Policy. The default allows scripts and
    /// styles with `nonce`, and requests to this server.
    fn policy(&self, nonce: &str) -> String {
        format!(
            "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; connect-src 'self'; \
             img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        )
    }

    /// Returns the answer to a request for `subpath`, the path below the link; `None` if there is
    /// nothing at this path. It is not called for the page itself, whose path is empty.
    fn answer(&self, method: &str, subpath: &str, query: &str, body: &[u8]) -> Option<HttpAnswer>;

    /// Returns true if the server must end.
    fn is_over(&self) -> bool;
}

/// A running server, and its address.
#[derive(Debug)]
pub(crate) struct PageServer {
    address: SocketAddr,
    link: String,
}

/// The values that all connections share.
struct ServerContext<S> {
    token: String,
    nonce: String,
    policy: String,
    hosts: [String; 2],
    site: Arc<S>,
}

impl PageServer {
    /// Starts a server that listens until the site is over.
    pub(crate) fn start(address: SocketAddr, site: Arc<impl PageSite>) -> Result<Self, ViewError> {
        if !address.ip().is_loopback() {
            return Err(ViewError::Address { address });
        }
        let listen = |source| ViewError::Listen { address, source };
        let listener = TcpListener::bind(address).map_err(listen)?;
        let address = listener.local_addr().map_err(listen)?;
        let token = random_token()?;
        let link = format!("http://{address}/{token}/");
        let nonce = random_token()?;
        let shared = Arc::new(ServerContext {
            token,
            policy: site.policy(&nonce),
            nonce,
            hosts: [address.to_string(), format!("localhost:{}", address.port())],
            site,
        });
        crate::view::start_thread("server", move || accept_connections(&listener, &shared))?;
        Ok(Self { address, link })
    }

    pub(crate) fn link(&self) -> &str {
        &self.link
    }

    /// Wakes the server, so that it notices that the site is over.
    pub(crate) fn wake(&self) {
        let _ = TcpStream::connect_timeout(&self.address, WAKE_TIME);
    }
}

fn accept_connections(listener: &TcpListener, shared: &Arc<ServerContext<impl PageSite>>) {
    let connections = Arc::<ConnectionTable>::default();
    for stream in listener.incoming() {
        if shared.site.is_over() {
            return;
        }
        let Ok(stream) = stream.map(Arc::new) else {
            sleep(ACCEPT_PAUSE);
            continue;
        };
        let Some(place) = connections.register(&stream) else { continue };
        let context = Arc::clone(shared);
        // It is no error that a browser goes away. If the thread does not start, the connection
        // ends.
        let _ = crate::view::start_thread("browser", move || {
            drop(context.answer_requests(stream, &place));
        });
    }
}

impl<S: PageSite> ServerContext<S> {
    fn answer_requests(&self, stream: Arc<TcpStream>, place: &ConnectionPlace) -> io::Result<()> {
        stream.set_nodelay(true)?;
        let mut requests = RequestStream::new(stream);
        while let Some(request) = requests.next()? {
            let admitted = self.admit(&request);
            if admitted.is_ok() {
                place.admit();
            }
            // A browser without the token gets one answer, and its connection is closed.
            let is_refused = admitted.is_err();
            let answer = admitted.map_or_else(
                |refusal| refusal,
                |(subpath, query)| self.answer(&request, subpath, query),
            );
            let is_last = is_refused || self.site.is_over();
            requests.answer(&answer, &self.policy, is_last)?;
            if is_last {
                break;
            }
        }
        Ok(())
    }

    /// Returns the path below the link and the query of a request that has the token. Any other
    /// request gives the answer that refuses it.
    fn admit<'a>(&self, request: &'a HttpRequest) -> Result<(&'a str, &'a str), HttpAnswer> {
        if !self.hosts.contains(&request.host.to_ascii_lowercase()) {
            return Err(HttpAnswer::text("403 Forbidden", "this page has another address"));
        }
        let (path, query) = request.target.split_once('?').unwrap_or((&request.target, ""));
        let subpath = path.strip_prefix('/').and_then(|path| path.split_once('/'));
        match subpath.filter(|(token, _)| equal_in_constant_time(token, &self.token)) {
            Some((_, subpath)) => Ok((subpath, query)),
            None => {
                let text = format!("open the link that `{}` prints", self.site.command());
                Err(HttpAnswer::text("403 Forbidden", &text))
            }
        }
    }

    fn answer(&self, request: &HttpRequest, subpath: &str, query: &str) -> HttpAnswer {
        match (request.method.as_str(), subpath) {
            ("GET", "") => {
                let body = self.site.page(&self.nonce).into_bytes();
                HttpAnswer { status: "200 OK", kind: "text/html; charset=utf-8", body }
            }
            (_, "") => HttpAnswer::method_not_allowed(),
            (method, subpath) => {
                let answer = self.site.answer(method, subpath, query, &request.body);
                answer.unwrap_or_else(|| {
                    HttpAnswer::text("404 Not Found", "there is no page at this address")
                })
            }
        }
    }
}

/// Compares two texts in a time that does not depend on the place where they differ.
fn equal_in_constant_time(given: &str, expected: &str) -> bool {
    let differ = given.bytes().zip(expected.bytes()).fold(0, |differ, (a, b)| differ | (a ^ b));
    given.len() == expected.len() && differ == 0
}

/// Returns a random text of 128 bits.
fn random_token() -> Result<String, ViewError> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| ViewError::Random { reason: error.to_string() })?;
    Ok(format!("{:032x}", u128::from_le_bytes(bytes)))
}

/// The number of connections at a time.
const CONNECTIONS: usize = 32;

/// The time that a new connection waits for the thread of a closed one to end.
const NEW_CONNECTION_LIMIT: Duration = Duration::from_secs(1);

/// The time after which another connection is closed, too.
const CLOSE_INTERVAL: Duration = Duration::from_millis(100);

/// The open connections.
#[derive(Debug, Default)]
pub(crate) struct ConnectionTable {
    state: Mutex<OpenConnections>,
    connection_ended: Condvar,
}

#[derive(Debug, Default)]
struct OpenConnections {
    next: u64,
    open: BTreeMap<u64, Connection>,
}

#[derive(Debug)]
struct Connection {
    stream: Arc<TcpStream>,
    /// True if the connection has shown the token.
    is_admitted: bool,
    /// The time of its last request, or of its opening.
    last_request: Instant,
    is_closed: bool,
}

/// The place of a connection in the table. The place is free again when this value is dropped.
#[derive(Debug)]
pub(crate) struct ConnectionPlace {
    table: Arc<ConnectionTable>,
    number: u64,
}

impl ConnectionTable {
    /// Registers a new connection. Returns `None` only if the threads of [`CONNECTIONS`] closed
    /// connections do not end in time.
    pub(crate) fn register(self: &Arc<Self>, stream: &Arc<TcpStream>) -> Option<ConnectionPlace> {
        let until = Instant::now() + NEW_CONNECTION_LIMIT;
        let mut state = self.lock();
        while state.open.len() >= CONNECTIONS {
            if Instant::now() > until {
                return None;
            }
            state.close_one();
            let waited = self.connection_ended.wait_timeout(state, CLOSE_INTERVAL);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        let number = state.next;
        state.next += 1;
        let (stream, now) = (Arc::clone(stream), Instant::now());
        let connection =
            Connection { stream, is_admitted: false, last_request: now, is_closed: false };
        state.open.insert(number, connection);
        Some(ConnectionPlace { table: Arc::clone(self), number })
    }

    fn lock(&self) -> MutexGuard<'_, OpenConnections> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl OpenConnections {
    /// Closes the connection that has been silent for the longest time. Connections that have not
    /// shown the token are closed first.
    fn close_one(&mut self) {
        let open = self.open.values_mut().filter(|connection| !connection.is_closed);
        if let Some(oldest) =
            open.min_by_key(|connection| (connection.is_admitted, connection.last_request))
        {
            oldest.is_closed = true;
            // The thread of the connection sees the end of the stream. A failure means that the
            // connection is closed already.
            let _ = oldest.stream.shutdown(Shutdown::Both);
        }
    }
}

impl ConnectionPlace {
    /// Notes that the connection has sent a request with the token.
    pub(crate) fn admit(&self) {
        if let Some(connection) = self.table.lock().open.get_mut(&self.number) {
            (connection.is_admitted, connection.last_request) = (true, Instant::now());
        }
    }
}

impl Drop for ConnectionPlace {
    fn drop(&mut self) {
        self.table.lock().open.remove(&self.number);
        self.table.connection_ended.notify_all();
    }
}

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

/// Returns the page, with a script that `nonce` allows.
pub(crate) fn stream_page(nonce: &str, registers: &Value) -> String {
    // The registers become part of a script, which `<` could end.
    let registers = registers.to_string().replace('<', "\\u003c");
    include_str!("page.html")
        .replace("NONCE", nonce)
        .replace("/*LIGHT*/", &colour_variables(&LIGHT))
        .replace("/*DARK*/", &colour_variables(&DARK))
        .replace("/*REGISTERS*/ null", &registers)
}
