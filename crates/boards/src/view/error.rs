// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a stream, or of frames, that cannot be shown.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

use foveate_camera::ConfigError;
use foveate_media::PlaybackError;
use thiserror::Error;

/// An error of a stream, or of frames, that cannot be shown.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum ViewError {
    /// The input cannot be opened.
    #[error("cannot read the packets `{}`: {source}", path.display())]
    Open { path: PathBuf, source: io::Error },
    /// The input is a folder, which has no packets.
    #[error("`{}` is a folder; give the file with the packets, such as packets.bin in it", path.display())]
    Folder { path: PathBuf },
    /// The input is a device, but no serial port.
    #[error("`{}` is a device, but not a serial port; give a port such as /dev/ttyUSB0, a file, a FIFO, or -", path.display())]
    NotASerialPort { path: PathBuf },
    /// The port cannot have the requested rate.
    #[error("cannot set `{}` to {baud} bits per second: {source}; choose a rate that the port has with --baud", path.display())]
    BaudRate { path: PathBuf, baud: u32, source: io::Error },
    /// The input can be read only once, and so cannot be repeated.
    #[error("`{}` is not a file, so it cannot be played again; leave --play looped out", path.display())]
    NotRepeatable { path: PathBuf },
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
    Address { address: SocketAddr },
    /// The server cannot listen on the address.
    #[error("cannot listen on {address}: {source}; choose another port, or 0 for any that is free")]
    Listen { address: SocketAddr, source: io::Error },
    /// The system started no thread.
    #[error("the system cannot start a thread: {source}; try again with fewer programs running")]
    Thread { source: io::Error },
    /// The system gave no random numbers.
    #[error("the system gives no random numbers, so the page cannot be kept from others: {reason}")]
    Random { reason: String },
}
