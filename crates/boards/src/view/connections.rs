// SPDX-License-Identifier: MIT OR Apache-2.0
//! The connections of a server. There are never more than [`CONNECTIONS`], and a new connection
//! always finds room: the connection that has been silent for the longest time is closed, and
//! connections that have not shown the token of the link are closed first. So slow, idle or stuck
//! connections do not affect a browser that behaves well.

use std::collections::BTreeMap;
use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

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
