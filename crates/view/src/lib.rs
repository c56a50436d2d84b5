// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pages in the browser of this machine, live: what a camera sends ([`View`]: its screen, its decisions, what is lost, and the
//! registers of a core on a serial line), and a camera that runs in the page itself ([`Player`]), with frames of an input.
//!
//! A [`View`] has three threads. One reads the stream and never waits for a browser; one asks the board for its
//! registers; one answers browsers on this machine, each of which asks for the newest frame when it has drawn the
//! last. The library never prints: what there is to say is fetched with [`View::news`].

mod board;
mod camera_page;
mod connections;
mod error;
mod http;
mod input;
mod live;
mod page;
mod picture;
mod player;
mod reader;
mod reel;
mod server;
mod site;
mod timed_stream;

use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;

use foveate_design::Config;

pub use camera_page::camera_page;
pub use error::ViewError;
pub use player::{Player, PlayerOptions};

use board::Board;
use input::Input;
use live::Live;
use reader::Reader;
use server::Server;
use site::StreamSite;

/// When the frames of a stream are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Play {
    /// By their times.
    Timed,
    /// As soon as they are read.
    AtOnce,
    /// By their times, again and again.
    Looped,
}

/// What is to be shown, and where.
#[derive(Clone, Debug)]
pub struct ViewOptions {
    /// A serial port, a file, a FIFO, or `-` for standard input.
    pub input: PathBuf,
    /// The configuration of the camera, of which the frame size may be missing.
    pub config: Config,
    /// Bits per second of a serial port.
    pub baud: u32,
    /// Where browsers find the page. It must be an address of this machine alone.
    pub address: SocketAddr,
    /// When frames are shown; without it a file by its times, and anything else at once.
    pub play: Option<Play>,
}

/// A stream that is shown until this is dropped.
#[derive(Debug)]
pub struct View {
    live: Arc<Live>,
    server: Server,
}

impl View {
    /// Opens the input and begins to show it.
    ///
    /// # Errors
    /// When the input or the address cannot be used.
    pub fn open(options: ViewOptions) -> Result<Self, ViewError> {
        let ViewOptions { input, config, baud, address, play } = options;
        let input = Input::find(input, baud)?;
        let play = input.play(play)?;
        // First, so that a port that cannot be used is an error.
        let mut first = if input.is_port() { Some(input.open()?) } else { None };
        let (live, board) = (Arc::new(Live::new(&input)), Arc::<Board>::default());
        board.attach(first.as_mut().and_then(|source| source.port.take()));
        let site = StreamSite { live: Arc::clone(&live), board: Arc::clone(&board) };
        let server = Server::start(address, Arc::new(site))?;
        let answers = board.start(&config, &live, input.is_port())?;
        let reader = Reader { input, config, play, answers, board, live: Arc::clone(&live) };
        thread("reader", move || reader.run(first))?;
        Ok(Self { live, server })
    }

    /// The link of the page.
    #[must_use]
    pub fn link(&self) -> &str {
        self.server.link()
    }

    /// What should be said since this was asked last.
    #[must_use]
    pub fn news(&self) -> Vec<String> {
        self.live.news()
    }

    /// Frames that were shown.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.live.frames()
    }
}

impl Drop for View {
    fn drop(&mut self) {
        self.live.end();
        self.server.wake();
    }
}

fn thread(name: &'static str, work: impl FnOnce() + Send + 'static) -> Result<(), ViewError> {
    let started = std::thread::Builder::new().name(name.to_owned()).spawn(work);
    started.map(drop).map_err(|source| ViewError::Thread { source })
}
