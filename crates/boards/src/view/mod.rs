// SPDX-License-Identifier: MIT OR Apache-2.0
//! Live pages in the browser of this machine. A [`View`] shows what a camera sends: its screen, its
//! decisions, its losses, and the registers of a core on a serial line. A [`Player`] serves a page
//! in which a camera runs, with the frames of an input.
//!
//! A [`View`] has three threads. One reads the stream and never waits for a browser. One asks the
//! board for its registers. One accepts browsers on this machine, each of which asks for the newest
//! frame when it has drawn the one before. The library never prints: its messages are fetched with
//! [`View::take_messages`].

mod base85;
mod board;
mod camera_page;
mod error;
mod frame_player;
mod input;
mod player;
mod reader;
mod server;
mod shared_stream;
mod site;
mod timed_stream;

use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;

use foveate_design::DesignConfig;

pub use camera_page::camera_page;
pub use error::ViewError;
pub use player::{Player, PlayerOptions};

use board::BoardRegisters;
use input::Input;
use reader::StreamReader;
use server::PageServer;
use shared_stream::SharedStream;
use site::StreamSite;

/// The times at which the frames of a stream are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlayMode {
    /// At the times of the frames.
    Timed,
    /// At once, as they are read.
    AtOnce,
    /// At the times of the frames, again and again.
    Looped,
}

/// The options of a view: its input, its camera and its address.
#[derive(Clone, Debug)]
pub struct ViewOptions {
    /// A serial port, a file, a FIFO, or `-` for standard input.
    pub input: PathBuf,
    /// The configuration of the camera, whose frame size may be missing.
    pub config: DesignConfig,
    /// The rate of a serial port in bits per second.
    pub baud: u32,
    /// The address at which browsers find the page. It must be an address of this machine alone.
    pub address: SocketAddr,
    /// The times at which frames are shown. Without it, the frames of a file are shown at their
    /// times, and those of any other input at once.
    pub play: Option<PlayMode>,
}

/// A stream that is shown until this value is dropped.
#[derive(Debug)]
pub struct View {
    live: Arc<SharedStream>,
    server: PageServer,
}

impl View {
    /// Opens the input and begins to show it.
    ///
    /// # Errors
    /// Fails if the input or the address cannot be used.
    pub fn open(options: ViewOptions) -> Result<Self, ViewError> {
        let ViewOptions { input, config, baud, address, play } = options;
        let input = Input::find(input, baud)?;
        let play = input.play_mode(play)?;
        // The port is opened first, so that a port that cannot be used is an error here.
        let mut first = if input.is_port() { Some(input.open()?) } else { None };
        let (live, board) = (Arc::new(SharedStream::new(&input)), Arc::<BoardRegisters>::default());
        board.set_port(first.as_mut().and_then(|source| source.port.take()));
        let site = StreamSite { live: Arc::clone(&live), board: Arc::clone(&board) };
        let server = PageServer::start(address, Arc::new(site))?;
        let answers = board.start(&config, &live, input.is_port())?;
        let reader = StreamReader { input, config, play, answers, board, live: Arc::clone(&live) };
        start_thread("reader", move || reader.run(first))?;
        Ok(Self { live, server })
    }

    /// Returns the link of the page.
    #[must_use]
    pub fn link(&self) -> &str {
        self.server.link()
    }

    /// Returns the messages since the last call.
    #[must_use]
    pub fn take_messages(&self) -> Vec<String> {
        self.live.take_messages()
    }

    /// Returns the number of frames that were shown.
    #[must_use]
    pub fn frames_shown(&self) -> u64 {
        self.live.frames_shown()
    }
}

impl Drop for View {
    fn drop(&mut self) {
        self.live.stop();
        self.server.wake();
    }
}

fn start_thread(name: &'static str, work: impl FnOnce() + Send + 'static) -> Result<(), ViewError> {
    let started = std::thread::Builder::new().name(name.to_owned()).spawn(work);
    started.map(drop).map_err(|source| ViewError::Thread { source })
}
