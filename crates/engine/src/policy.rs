// SPDX-License-Identifier: MIT OR Apache-2.0
//! When it pays to ask which regions are bit-identical to the last frame.
//!
//! Asking costs a comparison of every frame, and a copy of the last of a batch. So the engine asks all
//! of a batch only while the answer saves work; otherwise it looks at a sample of bands now and then,
//! less often the longer nothing is found. What is computed never depends on it.

/// What to do with a batch of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// Nothing.
    Rest,
    /// Keep a copy of a sample of the last frame's bands.
    Sample,
    /// Compare the sample in frame 0 with its copy, or in a later one with the frame before.
    Judge(usize),
    /// Compare all frames but the first, and keep a copy of the last.
    Keep,
    /// Compare all frames, the first with the copy, and keep a copy of the last.
    Compare,
}

impl Step {
    /// Whether a band is looked at.
    #[inline(always)]
    pub(crate) fn concerns(self, band: usize) -> bool {
        match self {
            Self::Rest => false,
            Self::Sample | Self::Judge(_) => band.is_multiple_of(SAMPLE),
            Self::Keep | Self::Compare => true,
        }
    }
}

/// One in this many bands is in the sample.
pub(crate) const SAMPLE: usize = 8;
/// Frames to rest after the first judgement that found little; doubled up to the second.
const RESTS: (u32, u32) = (4, 32);
/// A comparison pays when it saves more than this share of the blocks: it costs about half of what
/// computing a frame of small regions costs.
const PAYS: (usize, usize) = (11, 20);
/// A sample is promising when more than this share of its blocks could be saved; a comparison that
/// saves as much makes the next rest short again.
const PROMISES: (usize, usize) = (13, 20);

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

    /// What to do with the next frames.
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

    /// Learns how many blocks of the sample could be saved; says whether to keep these frames.
    pub(crate) fn judge(&mut self, saved: usize, blocks: usize) -> bool {
        let promising = exceeds(saved, blocks, PROMISES);
        if promising {
            self.phase = Phase::Kept;
        } else {
            self.give_up();
        }
        promising
    }

    /// Learns how many blocks a comparison has saved.
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

/// Whether so many of the blocks are more than a share of them.
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
