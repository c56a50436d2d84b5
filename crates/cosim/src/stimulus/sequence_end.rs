// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ends of sequences: the state in which the next reset finds the core.

use super::frame_feed::GapPattern;
use super::model_driver::{ClockReceiver, ModelDriver};
use crate::error::CosimError;
use foveate_design::PortRole;
use foveate_model::CycleModel;
use foveate_pixels::Frame;

/// The state at which the reset of the next sequence comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SequenceEnd {
    /// Some clocks after all pixels have left.
    Drained,
    /// Between the beats of a frame, up to the given number of clocks after one.
    Loading(u64),
    /// Up to the given number of clocks after the last beat of a frame.
    Flushing(u64),
    /// The clock at which the lanes begin with a frame, or soon after it.
    LanesStarted,
    /// Any clock of the work on a frame, or, about every second time, the clock before the first
    /// score is at the ports. `first_score` is the number of clocks from that score until the core
    /// is ready.
    Working { first_score: u64 },
    /// Up to the given number of clocks after the first score.
    Rotating(u64),
    /// At least one clock and up to the given number of clocks before the core is ready.
    Finishing(u64),
    /// Up to the given number of clocks after the first pixel or mean that leaves.
    Leaving(u64),
    /// The first mean that leaves; if the ports do not distinguish means from pixels, some clocks
    /// after all pixels have left.
    MeanLeaving,
    /// The edge at which a region would be lost in the middle, if there is one.
    BeforeLoss,
}

impl<Receiver: ClockReceiver> ModelDriver<'_, Receiver> {
    /// Brings the core to the state in which the next reset is to find it; `last` is the last
    /// frame.
    pub(crate) fn end_sequence(
        &mut self,
        end: SequenceEnd,
        last: &Frame,
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        let left = self.model().clocks_until_ready();
        match end {
            SequenceEnd::Drained => self.drain(last, gaps),
            SequenceEnd::Loading(0) => {
                self.cut_by_next_reset();
                Ok(())
            }
            SequenceEnd::Loading(most) => {
                let pause = self.random().up_to(most);
                self.idle(pause)
            }
            SequenceEnd::Flushing(most) => {
                let clocks = self.random().up_to(most);
                self.clocks_without_intake(clocks)
            }
            SequenceEnd::LanesStarted => {
                let clocks = self.random().up_to(4);
                self.work_until(left.saturating_sub(clocks))
            }
            // A score that is on its way to the ports must not come out.
            SequenceEnd::Working { first_score } if self.random().one_in(2) => {
                self.work_until(first_score + 1)
            }
            SequenceEnd::Working { .. } => {
                let clocks = self.random().up_to(left);
                self.work_until(clocks)
            }
            SequenceEnd::Rotating(most) => {
                let clocks = self.random().up_to(most);
                while !self.model().is_ready() && !self.model().is_high(PortRole::ScoreValid) {
                    self.clock_without_intake(None)?;
                }
                let left = self.model().clocks_until_ready();
                self.work_until(left.saturating_sub(clocks))
            }
            SequenceEnd::Finishing(most) => {
                let clocks = 1 + self.random().up_to(most.saturating_sub(1));
                self.work_until(clocks)
            }
            SequenceEnd::BeforeLoss => Ok(()),
            SequenceEnd::Leaving(most) => {
                self.wait_until_leaving(last, |core| core.is_high(PortRole::ForwardValid))?;
                let clocks = self.random().up_to(most);
                self.clocks_without_intake(clocks)
            }
            SequenceEnd::MeanLeaving if self.receiver().has_port(PortRole::ForwardSummary) => self
                .wait_until_leaving(last, |core| {
                    core.is_high(PortRole::ForwardValid) && core.is_high(PortRole::ForwardSummary)
                }),
            SequenceEnd::MeanLeaving => self.drain(last, gaps),
        }
    }

    /// Lets clocks pass until `is_leaving` returns true for the core, or everything has left. If
    /// pixels wait for further frames, the last frame is played again.
    fn wait_until_leaving(
        &mut self,
        last: &Frame,
        is_leaving: impl Fn(&dyn CycleModel) -> bool,
    ) -> Result<(), CosimError> {
        for _ in 0..self.drain_timing().frames_behind {
            if is_leaving(self.model()) {
                break;
            }
            self.idle(self.drain_timing().clocks_to_wait().unwrap_or(0))?;
            self.push_out(last, GapPattern::None, |core| !is_leaving(core))?;
        }
        // A pixel leaves some clocks after the one that pushes it out.
        for _ in 0..self.drain_timing().clocks_to_wait().unwrap_or(0) {
            if !is_leaving(self.model()) {
                self.clock_without_intake(None)?;
            }
        }
        // Pixels in the windows are not pending, but the core is not ready while there are some.
        let is_under_way = |core: &dyn CycleModel| core.is_pending() || !core.is_ready();
        while !is_leaving(self.model()) && is_under_way(self.model()) {
            self.clock_without_intake(None)?;
        }
        Ok(())
    }

    /// Lets all pixels leave. If the pixels of a frame wait for further frames, the last frame is
    /// played again.
    pub(crate) fn drain(&mut self, last: &Frame, gaps: GapPattern) -> Result<(), CosimError> {
        let timing = self.drain_timing();
        let settling = timing.clocks_to_wait().unwrap_or(0);
        for _ in 0..timing.frames_behind {
            let pause = self.random().up_to(settling);
            self.idle(pause)?;
            self.push_out(last, gaps, |_| true)?;
        }
        self.wait_until_left()?;
        self.idle(settling)?;
        let pause = self.random().up_to(timing.trailing_clocks);
        self.idle(pause)
    }
}
