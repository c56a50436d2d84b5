// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames of the inputs, for the commands that hold all of them in memory.

use foveate_design::Design;
use foveate_footage::{InputOptions, open};
use foveate_frame::Frame;
use foveate_simulator::{Simulation, SimulatorError};

use super::{DesignArgs, warn_of};
use crate::error::CliError;

impl DesignArgs {
    /// The frames of the inputs, at most so many, and the design with their size; without inputs the
    /// design alone.
    pub(crate) fn with_frames(
        &self,
        inputs: &[String],
        at_most: u32,
    ) -> Result<(Design, Vec<Frame>), CliError> {
        if inputs.is_empty() {
            return Ok((self.design()?, Vec::new()));
        }
        let config = self.read()?;
        let options = InputOptions { frames: Some(at_most), ..InputOptions::default() };
        warn_of(inputs, &options);
        let simulation = Simulation::new(&config, open(inputs, &config.camera, &options)?)?;
        let design = simulation.design().clone();
        let mut source = open(inputs, &config.camera, &options)?;
        let mut frames = Vec::new();
        while let Some(next) = source.next_frame()? {
            frames.push(next.frame.to_frame().map_err(SimulatorError::from)?);
        }
        Ok((design, frames))
    }
}
