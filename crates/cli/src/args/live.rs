// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `live`.

use super::{DesignArgs, InputArgs};
use crate::error::CliError;
use clap::Args;
use foveate_boards::view::PlayerOptions;
use foveate_media::ImageRelation;
use std::net::SocketAddr;
use std::path::PathBuf;

/// See a camera at work, live on a page in the browser: its input, its decisions, the receiver's
/// screen, and all settings
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate live
          foveate live street.mp4 --preset fovea
          foveate live rtsp://user:password@camera/stream --resize 640x360
          foveate live --page foveate.html",
    mut_group("InputArgs", |group| group.requires("inputs")))]
pub(crate) struct LiveArgs {
    /// Inputs that this machine decodes, as for `foveate simulate`. Without inputs, the page offers
    /// the browser's camera, files that the browser decodes, and built-in scenes
    #[arg(value_name = "INPUT")]
    pub(crate) inputs: Vec<String>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    #[command(flatten)]
    pub(crate) input: InputArgs,
    /// Address at which browsers of this machine find the page; port 0 takes any free port
    #[arg(long, value_name = "IP:PORT", default_value = "127.0.0.1:0")]
    pub(crate) address: SocketAddr,
    /// Write the page as one file that works without a server, and exit
    #[arg(long, value_name = "FILE", conflicts_with_all = ["inputs", "InputArgs", "address", "config", "preset", "overrides"])]
    pub(crate) page: Option<PathBuf>,
}

impl LiveArgs {
    pub(crate) fn options(&self) -> Result<PlayerOptions, CliError> {
        let config = self.design.config()?;
        // An invalid configuration is refused here, with the name of its key, and not on the page.
        config.camera.validate()?;
        let DesignArgs { config: file, preset, overrides } = &self.design;
        let is_own = file.is_some() || preset.is_some() || !overrides.is_empty();
        Ok(PlayerOptions {
            inputs: self.inputs.clone(),
            input: self.input.options(ImageRelation::Clip),
            preset: preset.clone(),
            camera: is_own.then_some(config.camera),
            address: self.address,
        })
    }
}
