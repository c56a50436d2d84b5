// SPDX-License-Identifier: MIT OR Apache-2.0
//! A connection with one deadline for a sequence of reads and writes. The timeouts of a socket
//! apply to each read or write alone, so that a peer that sends a byte every few seconds would
//! never exceed them.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The largest number of bytes that are written before the deadline is checked again.
const PIECE_BYTES: usize = 64 << 10;

/// A connection that fails once its deadline has passed.
#[derive(Debug)]
pub(crate) struct TimedStream {
    stream: Arc<TcpStream>,
    deadline: Instant,
}

impl TimedStream {
    /// Makes a connection whose deadline is now.
    pub(crate) fn new(stream: Arc<TcpStream>) -> Self {
        Self { stream, deadline: Instant::now() }
    }

    /// Sets the deadline to `time` from now.
    pub(crate) fn set_deadline(&mut self, time: Duration) {
        self.deadline = Instant::now() + time;
    }

    fn time_left(&self) -> io::Result<Duration> {
        let left = self.deadline.saturating_duration_since(Instant::now());
        if left.is_zero() { Err(ErrorKind::TimedOut.into()) } else { Ok(left) }
    }
}

impl Read for TimedStream {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(Some(self.time_left()?))?;
        (&*self.stream).read(bytes)
    }
}

impl Write for TimedStream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(Some(self.time_left()?))?;
        (&*self.stream).write(&bytes[..bytes.len().min(PIECE_BYTES)])
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    /// Returns both ends of a connection.
    fn connected_pair() -> (TimedStream, TcpStream) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let peer = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        (TimedStream::new(Arc::new(listener.accept().unwrap().0)), peer)
    }

    /// Calls `act` on the other end of the connection every 20 ms until `work` has ended. Returns
    /// the time that `work` took.
    fn run_disturbed(
        mut peer: TcpStream,
        act: fn(&mut TcpStream),
        work: impl FnOnce(),
    ) -> Duration {
        let start = Instant::now();
        let (ended, end) = std::sync::mpsc::channel::<()>();
        std::thread::scope(|scope| {
            scope.spawn(move || {
                while end.recv_timeout(Duration::from_millis(20)).is_err()
                    && start.elapsed() < Duration::from_secs(10)
                {
                    act(&mut peer);
                }
            });
            work();
            ended.send(()).unwrap();
        });
        start.elapsed()
    }

    fn is_timeout(error: &io::Error) -> bool {
        matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock)
    }

    #[test]
    fn a_peer_that_sends_a_byte_now_and_then_does_not_extend_the_deadline() {
        let (mut timed, peer) = connected_pair();
        timed.set_deadline(Duration::from_millis(300));
        let send_byte = |peer: &mut TcpStream| drop(peer.write_all(&[7]));
        let took = run_disturbed(peer, send_byte, || {
            let error = timed.read_exact(&mut [0; 1000]).unwrap_err();
            assert!(is_timeout(&error), "{error}");
        });
        assert!(took > Duration::from_millis(290) && took < Duration::from_secs(5), "{took:?}");
    }

    #[test]
    fn a_peer_that_takes_a_byte_now_and_then_does_not_extend_the_deadline() {
        let (mut timed, peer) = connected_pair();
        timed.set_deadline(Duration::from_millis(300));
        let take_byte = |peer: &mut TcpStream| drop(peer.read(&mut [0; 1]));
        let took = run_disturbed(peer, take_byte, || {
            // This is more than the buffers of both ends hold.
            let error = timed.write_all(&vec![7; 64 << 20]).unwrap_err();
            assert!(is_timeout(&error), "{error}");
        });
        assert!(took > Duration::from_millis(290) && took < Duration::from_secs(5), "{took:?}");
    }

    #[test]
    fn another_deadline_gives_more_time() {
        let (mut timed, mut peer) = connected_pair();
        peer.write_all(b"ab").unwrap();
        assert!(is_timeout(&timed.read(&mut [0; 1]).unwrap_err()));
        timed.set_deadline(Duration::from_secs(10));
        timed.read_exact(&mut [0; 2]).unwrap();
        timed.write_all(b"cd").unwrap();
        peer.read_exact(&mut [0; 2]).unwrap();
    }
}
