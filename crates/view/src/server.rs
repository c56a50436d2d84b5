// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page for browsers of this machine. Whoever does not know the link gets nothing: every path begins with a
//! random token, and the name of the host must be ours, so that a page from elsewhere cannot reach it under another
//! name.

use std::io::BufReader;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use serde_json::Value;

use crate::board::Board;
use crate::http::{self, Answer, Request};
use crate::live::Live;
use crate::{ViewError, page};

/// Connections at a time.
const CONNECTIONS: usize = 32;
/// How long a browser is waited for.
const IDLE: Duration = Duration::from_secs(30);
/// How long a browser waits for something new.
const PATIENCE: Duration = Duration::from_secs(1);

/// A server, and how it is reached.
#[derive(Debug)]
pub(crate) struct Server {
    address: SocketAddr,
    link: String,
}

/// What each connection needs.
struct Shared {
    token: String,
    nonce: String,
    hosts: [String; 2],
    live: Arc<Live>,
    board: Arc<Board>,
    connections: AtomicUsize,
}

impl Server {
    /// Listens until the view is over.
    pub(crate) fn start(
        address: SocketAddr,
        live: Arc<Live>,
        board: Arc<Board>,
    ) -> Result<Self, ViewError> {
        if !address.ip().is_loopback() {
            return Err(ViewError::Address { address });
        }
        let listen = |source| ViewError::Listen { address, source };
        let listener = TcpListener::bind(address).map_err(listen)?;
        let address = listener.local_addr().map_err(listen)?;
        let token = random()?;
        let link = format!("http://{address}/{token}/");
        let shared = Arc::new(Shared {
            token,
            nonce: random()?,
            hosts: [address.to_string(), format!("localhost:{}", address.port())],
            live,
            board,
            connections: AtomicUsize::new(0),
        });
        crate::thread("server", move || serve(&listener, &shared))?;
        Ok(Self { address, link })
    }

    pub(crate) fn link(&self) -> &str {
        &self.link
    }

    /// Lets it see that the view is over.
    pub(crate) fn wake(&self) {
        let _ = TcpStream::connect(self.address);
    }
}

fn serve(listener: &TcpListener, shared: &Arc<Shared>) {
    for stream in listener.incoming() {
        if shared.live.is_over() {
            return;
        }
        let Ok(stream) = stream else { continue };
        if shared.connections.fetch_add(1, Ordering::Relaxed) < CONNECTIONS {
            let own = Arc::clone(shared);
            let talk = move || {
                // A browser that goes away is no problem of ours.
                let _ = own.talk(stream);
                own.connections.fetch_sub(1, Ordering::Relaxed);
            };
            if crate::thread("browser", talk).is_ok() {
                continue;
            }
        }
        shared.connections.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Shared {
    fn talk(&self, mut stream: TcpStream) -> std::io::Result<()> {
        stream.set_read_timeout(Some(IDLE))?;
        stream.set_write_timeout(Some(IDLE))?;
        stream.set_nodelay(true)?;
        let mut requests = BufReader::new(stream.try_clone()?);
        while let Some(request) = http::read(&mut requests)? {
            http::write(&mut stream, &self.answer(&request), &self.nonce)?;
            if self.live.is_over() {
                break;
            }
        }
        Ok(())
    }

    fn answer(&self, request: &Request) -> Answer {
        if !self.hosts.contains(&request.host.to_ascii_lowercase()) {
            return Answer::text("403 Forbidden", "this page has another address");
        }
        let (path, query) = request.target.split_once('?').unwrap_or((&request.target, ""));
        let within = path.strip_prefix('/').and_then(|path| path.split_once('/'));
        let Some((_, within)) = within.filter(|(token, _)| same(token, &self.token)) else {
            let text = "open the link that `foveate view` prints";
            return Answer::text("403 Forbidden", text);
        };
        match (request.method.as_str(), within) {
            ("GET", "") => {
                let body = page::render(&self.nonce, &self.board.describe()).into_bytes();
                Answer { status: "200 OK", kind: "text/html; charset=utf-8", body }
            }
            ("GET", "next") => {
                let after = query.strip_prefix("after=").and_then(|after| after.parse().ok());
                let body = self.live.next(after.unwrap_or(0), PATIENCE);
                Answer { status: "200 OK", kind: "application/octet-stream", body }
            }
            ("POST", "register") => self.write(&request.body),
            (_, "" | "next" | "register") => Answer::text("405 Method Not Allowed", "not so"),
            _ => Answer::text("404 Not Found", "there is nothing"),
        }
    }

    /// Writes a register: `{"address": 256, "value": 4}`.
    fn write(&self, body: &[u8]) -> Answer {
        let asked: Value = serde_json::from_slice(body).unwrap_or_default();
        let Some((address, value)) = asked["address"].as_u64().zip(asked["value"].as_u64()) else {
            return Answer::text("400 Bad Request", "a register has an address and a value");
        };
        match self.board.write(address, value) {
            Ok(()) => Answer::text("200 OK", "written"),
            Err(why) => Answer::text("409 Conflict", &why),
        }
    }
}

/// Whether two texts are the same, in a time that does not say where they differ.
fn same(given: &str, own: &str) -> bool {
    let differ = given.bytes().zip(own.bytes()).fold(0, |differ, (a, b)| differ | (a ^ b));
    given.len() == own.len() && differ == 0
}

/// A random text of 128 bits.
fn random() -> Result<String, ViewError> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| ViewError::Random { reason: error.to_string() })?;
    Ok(format!("{:032x}", u128::from_le_bytes(bytes)))
}
