// SPDX-License-Identifier: MIT OR Apache-2.0
//! The values at input ports while they mean nothing ([`UnusedInputs`]).

use super::random::Random;

/// The choice of values that the hardware must ignore.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum UnusedInputs {
    /// Random values, so that hardware which uses one soon differs from the model.
    Random,
    /// The largest pixels and a start mark, so that many clocks are equal and vectors stay short.
    Constant {
        /// The number of clocks of a frame at which pixels are offered while none is taken.
        refused_clocks: u64,
    },
}

impl UnusedInputs {
    /// Returns a pixel; `max` is the largest one.
    pub(super) fn pixel(self, max: u16, random: &mut Random) -> u16 {
        match self {
            Self::Random => random.pixel(max),
            Self::Constant { .. } => max,
        }
    }

    /// Returns `count` pixels; `max` is the largest one.
    pub(super) fn pixels(self, count: usize, max: u16, random: &mut Random) -> Vec<u16> {
        (0..count).map(|_| self.pixel(max, random)).collect()
    }

    /// Returns one of two bits that are equally likely, or a 1.
    pub(super) fn bit(self, random: &mut Random) -> bool {
        match self {
            Self::Random => random.one_in(2),
            Self::Constant { .. } => true,
        }
    }

    /// Returns true if all clocks without a meaningful input have the same inputs.
    pub(super) fn are_constant(self) -> bool {
        match self {
            Self::Random => false,
            Self::Constant { .. } => true,
        }
    }

    /// Returns the policy for the pixel port during a frame and after it.
    pub(super) fn idle_policy(self, random: &mut Random) -> IdlePixelPolicy {
        match self {
            Self::Random => IdlePixelPolicy::random(random),
            Self::Constant { refused_clocks } => IdlePixelPolicy::Briefly(refused_clocks),
        }
    }
}

/// The policy for the pixel port while nothing is taken.
#[derive(Clone, Copy, Debug)]
pub(super) enum IdlePixelPolicy {
    /// Nothing is offered.
    Nothing,
    /// The next pixel is offered until it is taken.
    NextPixel,
    /// Unused pixels, which must not be taken, are offered at about every second clock.
    UnusedPixels,
    /// Unused pixels are offered for the given number of clocks, and nothing behind them.
    Briefly(u64),
}

impl IdlePixelPolicy {
    /// Returns a random policy; half of the time it is the one with unused pixels.
    fn random(random: &mut Random) -> Self {
        match random.up_to(3) {
            0 => Self::Nothing,
            1 => Self::NextPixel,
            _ => Self::UnusedPixels,
        }
    }

    /// Returns the valid bit for a clock at which nothing is taken, and the pixels; `None` stands
    /// for unused pixels.
    pub(super) fn offered_input<'a>(
        &mut self,
        next: Option<&'a [u16]>,
        random: &mut Random,
    ) -> (bool, Option<&'a [u16]>) {
        match self {
            Self::Nothing | Self::Briefly(0) => (false, None),
            Self::NextPixel => (next.is_some(), next),
            Self::UnusedPixels => (random.one_in(2), None),
            Self::Briefly(clocks) => {
                *clocks -= 1;
                (true, None)
            }
        }
    }
}
