// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a stream, or of frames, that cannot be shown.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

use foveate_design::ConfigError;
use foveate_playback::PlaybackError;
use thiserror::Error;

/// An error of a stream, or of frames, that cannot be shown.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The input cannot be opened.
    #[error("cannot read the packets `{}`: {source}", path.display())]
    Open {
        /// The path as given.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// The input is a folder, which has no packets.
    #[error("`{}` is a folder; give the file with the packets, such as packets.bin in it", path.display())]
    Folder {
        /// The path as given.
        path: PathBuf,
    },
    /// The input is a device, but no serial port.
    #[error("`{}` is a device, but not a serial port; give a port such as /dev/ttyUSB0, a file, a FIFO, or -", path.display())]
    NotASerialPort {
        /// The path as given.
        path: PathBuf,
    },
    /// The port cannot have the requested rate.
    #[error("cannot set `{}` to {baud} bits per second: {source}; choose a rate that the port has with --baud", path.display())]
    BaudRate {
        /// The path of the port.
        path: PathBuf,
        /// The requested rate in bits per second.
        baud: u32,
        /// The cause.
        source: io::Error,
    },
    /// The input can be read only once, and so cannot be repeated.
    #[error("`{}` is not a file, so it cannot be played again; leave --play looped out", path.display())]
    NotRepeatable {
        /// The path as given.
        path: PathBuf,
    },
    /// The frames cannot be read.
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    /// The configuration is not valid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Other machines could reach the address.
    #[error(
        "{address} is not an address of this machine alone; give one that begins with 127.0.0.1 or \
         [::1], and use a tunnel from another machine: ssh -L 8000:127.0.0.1:8000"
    )]
    Address {
        /// The address as given.
        address: SocketAddr,
    },
    /// The server cannot listen on the address.
    #[error("cannot listen on {address}: {source}; choose another port, or 0 for any that is free")]
    Listen {
        /// The address as given.
        address: SocketAddr,
        /// The cause.
        source: io::Error,
    },
    /// The system started no thread.
    #[error("the system cannot start a thread: {source}; try again with fewer programs running")]
    Thread {
        /// The cause.
        source: io::Error,
    },
    /// The system gave no random numbers.
    #[error("the system gives no random numbers, so the page cannot be kept from others: {reason}")]
    Random {
        /// The cause.
        reason: String,
    },
}
