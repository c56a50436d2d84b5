// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `view`, which shows what a camera sends on a page in the browser ([`ViewArgs`]).

use super::{DesignArgs, at_least_one};
use crate::error::CliError;
use clap::{Args, ValueEnum};
use foveate_boards::view::{PlayMode, ViewOptions};
use std::net::SocketAddr;
use std::path::PathBuf;

/// Show live, on a page in the browser, what a camera sends: its screen, its decisions, its losses,
/// and the registers of a core on a serial line
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate view /dev/ttyUSB0 --config core/design.toml
          foveate view packets.bin --preset steady --play looped
          cat packets.bin | foveate view - --preset steady")]
pub(crate) struct ViewArgs {
    /// A serial port; a file or FIFO with packets, such as packets.bin of `foveate simulate
    /// --packets`; - for standard input
    #[arg(value_name = "INPUT")]
    pub(crate) input: PathBuf,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Bits per second of a serial port
    #[arg(long, value_name = "RATE", default_value_t = 3_000_000, value_parser = at_least_one())]
    pub(crate) baud: u32,
    /// Address at which browsers of this machine find the page; port 0 takes any free port
    #[arg(long, value_name = "IP:PORT", default_value = "127.0.0.1:0")]
    pub(crate) address: SocketAddr,
    /// Times at which frames are shown. The default is timed for a file, and at-once for all other
    /// inputs
    #[arg(long, value_enum)]
    pub(crate) play: Option<PlayChoice>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PlayChoice {
    /// At the times of the frames
    Timed,
    /// At once, as they are read
    AtOnce,
    /// A file at the times of its frames, again and again
    Looped,
}

impl ViewArgs {
    pub(crate) fn options(&self) -> Result<ViewOptions, CliError> {
        let play = self.play.map(|play| match play {
            PlayChoice::Timed => PlayMode::Timed,
            PlayChoice::AtOnce => PlayMode::AtOnce,
            PlayChoice::Looped => PlayMode::Looped,
        });
        let (input, config) = (self.input.clone(), self.design.config()?);
        Ok(ViewOptions { input, config, baud: self.baud, address: self.address, play })
    }
}
