// SPDX-License-Identifier: MIT OR Apache-2.0
//! A page for browsers of this machine. Whoever does not know the link gets nothing: every path begins with a
//! random token, and the name of the host must be ours, so that a page from elsewhere cannot reach it under another
//! name. What there is to see is said by a [`Site`].

use std::io::BufReader;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use crate::ViewError;
use crate::http::{self, Answer, Request};

/// Connections at a time.
const CONNECTIONS: usize = 32;
/// How long a browser is waited for.
const IDLE: Duration = Duration::from_secs(30);

/// What a server shows below its link.
pub(crate) trait Site: Send + Sync + 'static {
    /// The command that prints the link.
    fn command(&self) -> &'static str;

    /// The page, with scripts that `nonce` allows.
    fn page(&self, nonce: &str) -> String;

    /// What the page may load, as a Content-Security-Policy: of its own only scripts and styles with `nonce`, and what
    /// this server answers.
    fn policy(&self, nonce: &str) -> String {
        format!(
            "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; connect-src 'self'; \
             img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        )
    }

    /// The answer to a request for something beside the page; none where there is no such thing.
    fn answer(&self, method: &str, within: &str, query: &str, body: &[u8]) -> Option<Answer>;

    /// Whether nobody is served any more.
    fn is_over(&self) -> bool;
}

/// A server, and how it is reached.
#[derive(Debug)]
pub(crate) struct Server {
    address: SocketAddr,
    link: String,
}

/// What each connection needs.
struct Shared<S> {
    token: String,
    nonce: String,
    policy: String,
    hosts: [String; 2],
    site: Arc<S>,
    connections: AtomicUsize,
}

impl Server {
    /// Listens until the site is over.
    pub(crate) fn start(address: SocketAddr, site: Arc<impl Site>) -> Result<Self, ViewError> {
        if !address.ip().is_loopback() {
            return Err(ViewError::Address { address });
        }
        let listen = |source| ViewError::Listen { address, source };
        let listener = TcpListener::bind(address).map_err(listen)?;
        let address = listener.local_addr().map_err(listen)?;
        let token = random()?;
        let link = format!("http://{address}/{token}/");
        let nonce = random()?;
        let shared = Arc::new(Shared {
            token,
            policy: site.policy(&nonce),
            nonce,
            hosts: [address.to_string(), format!("localhost:{}", address.port())],
            site,
            connections: AtomicUsize::new(0),
        });
        crate::thread("server", move || serve(&listener, &shared))?;
        Ok(Self { address, link })
    }

    pub(crate) fn link(&self) -> &str {
        &self.link
    }

    /// Lets it see that the site is over.
    pub(crate) fn wake(&self) {
        let _ = TcpStream::connect(self.address);
    }
}

fn serve(listener: &TcpListener, shared: &Arc<Shared<impl Site>>) {
    for stream in listener.incoming() {
        if shared.site.is_over() {
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

impl<S: Site> Shared<S> {
    fn talk(&self, mut stream: TcpStream) -> std::io::Result<()> {
        stream.set_read_timeout(Some(IDLE))?;
        stream.set_write_timeout(Some(IDLE))?;
        stream.set_nodelay(true)?;
        let mut requests = BufReader::new(stream.try_clone()?);
        while let Some(request) = http::read(&mut requests)? {
            http::write(&mut stream, &self.answer(&request), &self.policy)?;
            if self.site.is_over() {
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
            let text = format!("open the link that `{}` prints", self.site.command());
            return Answer::text("403 Forbidden", &text);
        };
        match (request.method.as_str(), within) {
            ("GET", "") => {
                let body = self.site.page(&self.nonce).into_bytes();
                Answer { status: "200 OK", kind: "text/html; charset=utf-8", body }
            }
            (_, "") => Answer::not_so(),
            (method, within) => {
                let answer = self.site.answer(method, within, query, &request.body);
                answer.unwrap_or_else(|| Answer::text("404 Not Found", "there is nothing"))
            }
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
