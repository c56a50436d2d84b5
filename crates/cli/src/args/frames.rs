// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames of the inputs, for commands that hold all of them in memory.

use super::DesignArgs;
use super::input::warn_about_inputs;
use crate::error::CliError;
use crate::interrupt;
use foveate_design::Design;
use foveate_media::{ClipPlayer, InputOptions, PlaybackError};
use foveate_pixels::Frame;

impl DesignArgs {
    /// Returns the design with the size of the inputs, and at most `at_most` frames of them.
    /// Without inputs, it returns the design alone.
    pub(crate) fn with_frames(
        &self,
        inputs: &[String],
        at_most: u32,
    ) -> Result<(Design, Vec<Frame>), CliError> {
        if inputs.is_empty() {
            return Ok((self.design()?, Vec::new()));
        }
        let config = self.config()?;
        let (frames, interrupt) = (Some(at_most), interrupt::stop_request());
        let options = InputOptions { frames, interrupt, ..InputOptions::default() };
        warn_about_inputs(inputs, &options);
        // The inputs are opened only once, because standard input and cameras cannot be read again.
        let player = ClipPlayer::open(inputs, &config.camera, &options)?;
        let (width, height) = player.size();
        let design = config.validate_for_frames(width, height)?;
        let frames = player.map(|played| Ok(played?.frame.to_frame()?));
        Ok((design, frames.collect::<Result<_, PlaybackError>>()?))
    }
}
