// SPDX-License-Identifier: MIT OR Apache-2.0
//! A server of a page for browsers of this machine. Without the link a browser gets nothing: every
//! path begins with a random token. The name of the host must be the server's, so that a foreign
//! page cannot reach it under another name. A [`PageSite`] provides the content.

use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::thread::sleep;
use std::time::Duration;

use crate::view::ViewError;
use crate::view::connections::{ConnectionPlace, ConnectionTable};
use crate::view::http::{HttpAnswer, HttpRequest, RequestStream};

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
    fn answer_requests(
        &self,
        stream: Arc<TcpStream>,
        place: &ConnectionPlace,
    ) -> std::io::Result<()> {
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
