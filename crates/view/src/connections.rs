// SPDX-License-Identifier: MIT OR Apache-2.0
//! The connections of a server. There are never more than [`CONNECTIONS`], and a new one always finds room: the connection that
//! was silent for the longest time is closed, first of all one that has not shown the token of the link. So connections that are
//! slow, idle or stuck cost a browser that behaves well nothing.

use std::collections::BTreeMap;
use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Connections at a time.
const CONNECTIONS: usize = 32;
/// How long a new connection waits until the thread of a closed one has ended.
const ROOM: Duration = Duration::from_secs(1);
/// After this time another connection is closed, too.
const CLOSING: Duration = Duration::from_millis(100);

/// The connections that are open.
#[derive(Debug, Default)]
pub(crate) struct ConnectionTable {
    state: Mutex<State>,
    ended: Condvar,
}

#[derive(Debug, Default)]
struct State {
    next: u64,
    open: BTreeMap<u64, Connection>,
}

#[derive(Debug)]
struct Connection {
    stream: Arc<TcpStream>,
    /// Whether it has shown the token.
    is_admitted: bool,
    /// When its last request came, or when it was opened.
    since: Instant,
    is_closed: bool,
}

/// A connection's place in the table, until this is dropped.
#[derive(Debug)]
pub(crate) struct ConnectionPlace {
    table: Arc<ConnectionTable>,
    number: u64,
}

impl ConnectionTable {
    /// Takes a new connection. There is no place only while [`CONNECTIONS`] threads have not ended although theirs were closed.
    pub(crate) fn take(self: &Arc<Self>, stream: &Arc<TcpStream>) -> Option<ConnectionPlace> {
        let until = Instant::now() + ROOM;
        let mut state = self.lock();
        while state.open.len() >= CONNECTIONS {
            if Instant::now() > until {
                return None;
            }
            state.close_one();
            let waited = self.ended.wait_timeout(state, CLOSING);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        let number = state.next;
        state.next += 1;
        let (stream, since) = (Arc::clone(stream), Instant::now());
        let connection = Connection { stream, is_admitted: false, since, is_closed: false };
        state.open.insert(number, connection);
        Some(ConnectionPlace { table: Arc::clone(self), number })
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Closes the connection that was silent for the longest time, first one that has not shown the token.
    fn close_one(&mut self) {
        let open = self.open.values_mut().filter(|own| !own.is_closed);
        if let Some(longest) = open.min_by_key(|own| (own.is_admitted, own.since)) {
            longest.is_closed = true;
            // Its thread sees the end of the stream. One that is gone already needs no closing.
            let _ = longest.stream.shutdown(Shutdown::Both);
        }
    }
}

impl ConnectionPlace {
    /// The connection has sent a request that shows the token.
    pub(crate) fn admit(&self) {
        if let Some(own) = self.table.lock().open.get_mut(&self.number) {
            (own.is_admitted, own.since) = (true, Instant::now());
        }
    }
}

impl Drop for ConnectionPlace {
    fn drop(&mut self) {
        self.table.lock().open.remove(&self.number);
        self.table.ended.notify_all();
    }
}
