// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames that a lone unit takes without a pause, as it does in a camera.

use super::check_frames;
use super::session::{SequenceLimits, StimulusPace, StimulusPlan, StimulusSession};
use crate::error::CosimError;
use crate::level::CosimLevel;
use crate::recording::{Recorder, Recording};
use foveate_design::Design;
use foveate_pixels::Frame;
use std::sync::atomic::AtomicBool;

/// Frames for an RPU of `pipelined` or a lane of `serial`. Each part of a frame that a unit takes
/// is a sequence, which begins with a reset and has all frames without a pause.
#[derive(Clone, Debug)]
pub struct UnitFrames<'a> {
    /// The frames, of the size and depth of the design.
    pub frames: &'a [Frame],
    /// The largest number of parts, which are spread evenly over the frame. There are fewer if
    /// their clocks are many.
    pub max_parts: u64,
}

impl UnitFrames<'_> {
    /// Runs the model of the unit and records its inputs and outputs.
    ///
    /// # Errors
    /// Fails if a frame does not fit, if there is no room for the files, or if `cancel` was set.
    pub fn record(&self, design: &Design, cancel: &AtomicBool) -> Result<Recording, CosimError> {
        check_frames(self.frames, design)?;
        let level = CosimLevel::Rpu;
        let simulated = level.design(design)?;
        let mut recorder = Recorder::new(&level.top().ports(&simulated))?;
        let plan = StimulusPlan {
            seed: 1,
            limits: SequenceLimits { rounds: 0, max_sequences: usize::MAX },
            is_left_out: |_| false,
            pace: StimulusPace::Steady { max_parts: self.max_parts },
        };
        StimulusSession::new((design, &simulated), level, plan, &mut recorder, cancel)
            .run(self.frames, &mut |_, _| {})?;
        recorder.finish()
    }
}
