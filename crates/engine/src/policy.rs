// SPDX-License-Identifier: MIT OR Apache-2.0
//! When it pays to ask which regions are bit-identical to the last frame.
//!
//! Asking costs a copy and a comparison of every frame. So the engine asks all of a frame only while
//! the answer saves work; otherwise it looks at a sample of bands now and then, less often the
//! longer nothing is found. What is computed never depends on it.

/// What to do with a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// Nothing.
    Rest,
    /// Keep a copy of a sample of bands.
    Sample,
    /// Compare the sample with its copy.
    Judge,
    /// Keep a copy of all of it.
    Keep,
    /// Compare all of it with its copy, and keep what has changed.
    Compare,
}

impl Step {
    /// Whether a band is looked at.
    #[inline(always)]
    pub(crate) fn concerns(self, band: usize) -> bool {
        match self {
            Self::Rest => false,
            Self::Sample | Self::Judge => band.is_multiple_of(SAMPLE),
            Self::Keep | Self::Compare => true,
        }
    }
}

/// One in this many bands is in the sample.
pub(crate) const SAMPLE: usize = 8;
/// Frames to rest after the first judgement that found little; doubled up to the second.
const RESTS: (u32, u32) = (4, 32);
/// A comparison pays when it saves more than one in this many blocks.
const PAYS: usize = 3;
/// A sample is promising when more than one in this many of its blocks could be saved; a comparison
/// that saves as much makes the next rest short again.
const PROMISES: usize = 2;

#[derive(Clone, Copy, Debug)]
enum Phase {
    Off,
    Resting(u32),
    Sampled,
    Kept,
}

/// When to compare.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Policy {
    phase: Phase,
    rest: u32,
}

impl Policy {
    pub(crate) fn new(on: bool) -> Self {
        Self { phase: if on { Phase::Resting(0) } else { Phase::Off }, rest: RESTS.0 }
    }

    /// What to do with the next frame.
    pub(crate) fn next(&mut self) -> Step {
        match self.phase {
            Phase::Off => Step::Rest,
            Phase::Resting(0) => {
                self.phase = Phase::Sampled;
                Step::Sample
            }
            Phase::Resting(left) => {
                self.phase = Phase::Resting(left - 1);
                Step::Rest
            }
            Phase::Sampled => Step::Judge,
            Phase::Kept => Step::Compare,
        }
    }

    /// Learns how many blocks of the sample could be saved; says whether to keep this frame.
    pub(crate) fn judge(&mut self, saved: usize, blocks: usize) -> bool {
        let promising = saved * PROMISES > blocks;
        if promising {
            self.phase = Phase::Kept;
        } else {
            self.give_up();
        }
        promising
    }

    /// Learns how many blocks a comparison has saved.
    pub(crate) fn saved(&mut self, saved: usize, blocks: usize) {
        if saved * PROMISES > blocks {
            self.rest = RESTS.0;
        } else if saved * PAYS <= blocks {
            self.give_up();
        }
    }

    fn give_up(&mut self) {
        self.phase = Phase::Resting(self.rest);
        self.rest = (2 * self.rest).min(RESTS.1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rests_grow_while_nothing_is_found_and_end_when_it_pays() {
        let mut policy = Policy::new(true);
        let mut film = |sample: usize, saved: usize, frames: usize| -> String {
            let step = |_| match policy.next() {
                Step::Rest => '.',
                Step::Sample => 's',
                Step::Judge => match policy.judge(sample, 100) {
                    true => 'K',
                    false => 'j',
                },
                Step::Keep => '?',
                Step::Compare => {
                    policy.saved(saved, 100);
                    'c'
                }
            };
            (0..frames).map(step).collect()
        };
        assert_eq!(film(0, 0, 18), "sj....sj........sj");
        assert_eq!(film(0, 0, 16), "................");
        assert_eq!(film(60, 60, 5), "sKccc");
        assert_eq!(film(60, 10, 9), "c....sKc.");
        assert_eq!(Policy::new(false).next(), Step::Rest);
    }
}
