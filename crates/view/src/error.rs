// SPDX-License-Identifier: MIT OR Apache-2.0
//! Why a stream cannot be shown.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

use foveate_design::ConfigError;
use foveate_footage::FootageError;
use thiserror::Error;

/// A stream, or frames, that cannot be shown.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The input cannot be opened.
    #[error("cannot read the packets `{}`: {source}", path.display())]
    Open {
        /// What was given.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A folder has no packets.
    #[error("`{}` is a folder; give the file with the packets, such as packets.bin in it", path.display())]
    Folder {
        /// What was given.
        path: PathBuf,
    },
    /// A device that is none.
    #[error("`{}` is a device, but no serial port; give a port such as /dev/ttyUSB0, a file, a FIFO, or -", path.display())]
    NoPort {
        /// What was given.
        path: PathBuf,
    },
    /// A port that does not do what is asked of it.
    #[error("cannot set `{}` to {baud} bits per second: {source}; choose a rate that the port has with --baud", path.display())]
    Rate {
        /// The port.
        path: PathBuf,
        /// The rate that was asked for.
        baud: u32,
        /// Why.
        source: io::Error,
    },
    /// What comes once only cannot be repeated.
    #[error("`{}` is no file, so it cannot be played again; leave --play looped out", path.display())]
    NotAgain {
        /// What was given.
        path: PathBuf,
    },
    /// Frames that cannot be read.
    #[error(transparent)]
    Footage(#[from] FootageError),
    /// Settings that there are not.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// An address that others could reach.
    #[error(
        "{address} is not an address of this machine alone; take one that begins with 127.0.0.1 or \
         [::1], and from another machine a tunnel: ssh -L 8000:127.0.0.1:8000"
    )]
    Address {
        /// The address as given.
        address: SocketAddr,
    },
    /// The address is taken.
    #[error("cannot listen on {address}: {source}; choose another port, or 0 for any that is free")]
    Listen {
        /// The address as given.
        address: SocketAddr,
        /// Why.
        source: io::Error,
    },
    /// The system gave no thread.
    #[error("the system cannot start a thread: {source}; try again with fewer programs running")]
    Thread {
        /// What it says.
        source: io::Error,
    },
    /// The system gave no random numbers.
    #[error("the system gives no random numbers, so the page cannot be kept from others: {reason}")]
    Random {
        /// What it says.
        reason: String,
    },
}
