// SPDX-License-Identifier: MIT OR Apache-2.0
//! The policy that decides when to search for regions that are bit-identical to the last frame.
//!
//! A search costs a comparison of every frame, and a copy of the last frame of a batch. So all of a
//! batch is searched only while that saves work. Otherwise the engine looks at a sample of bands
//! from time to time, less often the longer nothing is found. The results never depend on the
//! policy.

/// The search in one batch of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// Do nothing.
    Rest,
    /// Keep a copy of a sample of the last frame's bands.
    Sample,
    /// Compare the sample: in frame 0 with its copy, in a later frame with the frame before it.
    Judge(usize),
    /// Compare all frames but the first, and keep a copy of the last.
    Keep,
    /// Compare all frames, the first with the copy, and keep a copy of the last.
    Compare,
}

impl Step {
    /// Returns true if the step compares or copies this band.
    #[inline(always)]
    pub(crate) fn concerns(self, band: usize) -> bool {
        match self {
            Self::Rest => false,
            Self::Sample | Self::Judge(_) => band.is_multiple_of(SAMPLE),
            Self::Keep | Self::Compare => true,
        }
    }
}

/// The distance of the bands of the sample: one in this many bands is in it.
pub(crate) const SAMPLE: usize = 8;
/// The number of frames to rest after the first sample that promised little, and the limit up to
/// which it is doubled.
const RESTS: (u32, u32) = (4, 32);
/// A comparison pays if it saves more than this share of the blocks. It costs about half as much as
/// computing a frame of small regions.
const PAYS: (usize, usize) = (11, 20);
/// A sample is promising if more than this share of its blocks could be saved. A comparison that
/// saves as much makes the next rest short again.
const PROMISES: (usize, usize) = (13, 20);

#[derive(Clone, Copy, Debug)]
enum Phase {
    Off,
    Resting(u32),
    Sampled,
    Kept,
}

/// The policy and its state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Policy {
    phase: Phase,
    rest: u32,
}

impl Policy {
    pub(crate) fn new(on: bool) -> Self {
        Self { phase: if on { Phase::Resting(0) } else { Phase::Off }, rest: RESTS.0 }
    }

    /// Returns the step for the next frames.
    pub(crate) fn next(&mut self, frames: usize) -> Step {
        match self.phase {
            Phase::Off => Step::Rest,
            Phase::Resting(0) if frames > 1 => Step::Judge(1),
            Phase::Resting(0) => {
                self.phase = Phase::Sampled;
                Step::Sample
            }
            Phase::Resting(left) => {
                let frames = u32::try_from(frames).unwrap_or(u32::MAX);
                self.phase = Phase::Resting(left.saturating_sub(frames));
                Step::Rest
            }
            Phase::Sampled => Step::Judge(0),
            Phase::Kept => Step::Compare,
        }
    }

    /// Records how many blocks of the sample could be saved. Returns true if these frames are to be
    /// kept.
    pub(crate) fn judge(&mut self, saved: usize, blocks: usize) -> bool {
        let promising = exceeds(saved, blocks, PROMISES);
        if promising {
            self.phase = Phase::Kept;
        } else {
            self.give_up();
        }
        promising
    }

    /// Records how many blocks a comparison has saved.
    pub(crate) fn saved(&mut self, saved: usize, blocks: usize) {
        if exceeds(saved, blocks, PROMISES) {
            self.rest = RESTS.0;
        } else if !exceeds(saved, blocks, PAYS) {
            self.give_up();
        }
    }

    fn give_up(&mut self) {
        self.phase = Phase::Resting(self.rest);
        self.rest = (2 * self.rest).min(RESTS.1);
    }
}

/// Returns true if `saved` is more than this share of `blocks`.
fn exceeds(saved: usize, blocks: usize, (part, whole): (usize, usize)) -> bool {
    saved * whole > blocks * part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rests_grow_while_nothing_is_found_and_end_when_it_pays() {
        let mut policy = Policy::new(true);
        let mut film = |sample: usize, saved: usize, frames: usize| -> String {
            let step = |_| match policy.next(1) {
                Step::Rest => '.',
                Step::Sample => 's',
                Step::Judge(_) => match policy.judge(sample, 100) {
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
        assert_eq!(film(70, 70, 5), "sKccc");
        assert_eq!(film(70, 10, 9), "c....sKc.");
        assert_eq!(Policy::new(false).next(1), Step::Rest);
    }

    #[test]
    fn batches_are_judged_by_themselves_and_shorten_rests() {
        let mut policy = Policy::new(true);
        assert_eq!(policy.next(8), Step::Judge(1));
        assert!(!policy.judge(0, 100));
        assert_eq!(
            [policy.next(3), policy.next(3), policy.next(1)],
            [Step::Rest, Step::Rest, Step::Sample]
        );
        assert_eq!(policy.next(3), Step::Judge(0));
        assert!(policy.judge(70, 100));
        assert_eq!(policy.next(3), Step::Compare);
    }
}
