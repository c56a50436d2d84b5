// SPDX-License-Identifier: MIT OR Apache-2.0
//! The explanation of a region in a frame of a clip. The earlier frames run through the same
//! camera, so that reference and screen are those of the run.

use foveate_design::DesignConfig;
use foveate_media::ClipPlayer;
use foveate_model::{
    FunctionalCamera,
    explanation::{FrameIdentification, RegionExplanation},
};

use crate::SimulatorError;

/// Runs a clip up to frame `frame` and explains the region at column and row `region`.
///
/// # Errors
/// Fails if the frame or the region does not exist, or if a frame cannot be read.
pub fn explain_region(
    config: &DesignConfig,
    player: impl Into<ClipPlayer>,
    frame: u64,
    region: (u32, u32),
) -> Result<RegionExplanation, SimulatorError> {
    let mut player = player.into();
    let (width, height) = player.size();
    let design = config.validate_for_frames(width, height)?;
    let (columns, rows) = (design.columns(), design.rows());
    let (x, y) = region;
    if x >= columns || y >= rows {
        return Err(SimulatorError::NoSuchRegion { x, y, columns, rows });
    }
    let number = y * columns + x;
    let mut camera = FunctionalCamera::new(&design);
    let mut frames = 0;
    for current in &mut player {
        let current = current?;
        if current.is_first() {
            camera.reset();
        }
        let before = camera.region_memory(number);
        let outcome = camera.step(&current.frame.to_frame()?)?;
        if current.number == frame {
            let moment =
                FrameIdentification { number: frame, name: &current.name, t_us: current.time_us };
            return Ok(RegionExplanation::from_outcome(&design, moment, number, before, outcome));
        }
        frames += 1;
    }
    let inputs = player.inputs().join(", ");
    Err(SimulatorError::NoSuchFrame { frame, inputs, frames })
}
