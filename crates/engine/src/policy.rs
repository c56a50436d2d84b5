// SPDX-License-Identifier: MIT OR Apache-2.0
//! The policy that decides when to search for regions that are bit-identical to the last frame.
//!
//! A search costs a comparison of every frame, and a copy of the last frame of a batch. A whole
//! batch is therefore searched only while that saves work. Otherwise the engine compares a sample
//! of the bands from time to time; the rests between two samples grow while nothing is found. The
//! results never depend on the policy.

/// The search in one batch of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SearchStep {
    /// Do nothing.
    Rest,
    /// Keep a copy of a sample of the last frame's bands.
    CopySample,
    /// Compare the sample: in frame 0 with its copy, in a later frame with the frame before it.
    CompareSample(usize),
    /// Compare all frames but the first, and keep a copy of the last.
    CompareWithinBatch,
    /// Compare all frames, the first with the copy, and keep a copy of the last.
    CompareAll,
}

impl SearchStep {
    /// Returns true if the step compares or copies this band.
    #[inline(always)]
    pub(crate) fn includes_band(self, band: usize) -> bool {
        match self {
            Self::Rest => false,
            Self::CopySample | Self::CompareSample(_) => band.is_multiple_of(SAMPLE_DISTANCE),
            Self::CompareWithinBatch | Self::CompareAll => true,
        }
    }
}

/// The distance of the bands of the sample: one in this many bands is in it.
pub(crate) const SAMPLE_DISTANCE: usize = 8;
/// The number of frames to rest after the first sample that promised little, and the limit up to
/// which it is doubled.
const REST_FRAMES: (u32, u32) = (4, 32);
/// A comparison pays if it saves more than this share of the blocks. It costs about half as much as
/// computing a frame of small regions.
const PAYING_SHARE: (usize, usize) = (11, 20);
/// A sample is promising if more than this share of its blocks could be saved. A comparison that
/// saves as much makes the next rest short again.
const PROMISING_SHARE: (usize, usize) = (13, 20);

#[derive(Clone, Copy, Debug)]
enum SearchPhase {
    Off,
    Resting(u32),
    Sampled,
    Copied,
}

/// The policy and its state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SearchPolicy {
    phase: SearchPhase,
    rest_frames: u32,
}

impl SearchPolicy {
    pub(crate) fn new(on: bool) -> Self {
        Self {
            phase: if on { SearchPhase::Resting(0) } else { SearchPhase::Off },
            rest_frames: REST_FRAMES.0,
        }
    }

    pub(crate) fn next_step(&mut self, frames: usize) -> SearchStep {
        match self.phase {
            SearchPhase::Off => SearchStep::Rest,
            SearchPhase::Resting(0) if frames > 1 => SearchStep::CompareSample(1),
            SearchPhase::Resting(0) => {
                self.phase = SearchPhase::Sampled;
                SearchStep::CopySample
            }
            SearchPhase::Resting(left) => {
                let frames = u32::try_from(frames).unwrap_or(u32::MAX);
                self.phase = SearchPhase::Resting(left.saturating_sub(frames));
                SearchStep::Rest
            }
            SearchPhase::Sampled => SearchStep::CompareSample(0),
            SearchPhase::Copied => SearchStep::CompareAll,
        }
    }

    /// Records how many blocks of the sample need no computation. Returns true if the sample is
    /// promising, so that these frames are searched and a copy is kept.
    pub(crate) fn record_sample(&mut self, saved: usize, blocks: usize) -> bool {
        let is_promising = exceeds_share(saved, blocks, PROMISING_SHARE);
        if is_promising {
            self.phase = SearchPhase::Copied;
        } else {
            self.start_rest();
        }
        is_promising
    }

    /// Records how many blocks a comparison has saved.
    pub(crate) fn record_comparison(&mut self, saved: usize, blocks: usize) {
        if exceeds_share(saved, blocks, PROMISING_SHARE) {
            self.rest_frames = REST_FRAMES.0;
        } else if !exceeds_share(saved, blocks, PAYING_SHARE) {
            self.start_rest();
        }
    }

    fn start_rest(&mut self) {
        self.phase = SearchPhase::Resting(self.rest_frames);
        self.rest_frames = (2 * self.rest_frames).min(REST_FRAMES.1);
    }
}

/// Returns true if `saved` is more than this share of `blocks`.
fn exceeds_share(saved: usize, blocks: usize, (part, whole): (usize, usize)) -> bool {
    saved * whole > blocks * part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rests_grow_while_nothing_is_found_and_end_when_it_pays() {
        let mut policy = SearchPolicy::new(true);
        let mut run_frames = |sample: usize, saved: usize, frames: usize| -> String {
            let step = |_| match policy.next_step(1) {
                SearchStep::Rest => '.',
                SearchStep::CopySample => 's',
                SearchStep::CompareSample(_) => match policy.record_sample(sample, 100) {
                    true => 'K',
                    false => 'j',
                },
                SearchStep::CompareWithinBatch => '?',
                SearchStep::CompareAll => {
                    policy.record_comparison(saved, 100);
                    'c'
                }
            };
            (0..frames).map(step).collect()
        };
        assert_eq!(run_frames(0, 0, 18), "sj....sj........sj");
        assert_eq!(run_frames(0, 0, 16), "................");
        assert_eq!(run_frames(70, 70, 5), "sKccc");
        assert_eq!(run_frames(70, 10, 9), "c....sKc.");
        assert_eq!(SearchPolicy::new(false).next_step(1), SearchStep::Rest);
    }

    #[test]
    fn a_batch_has_its_own_sample_and_counts_as_rest() {
        let mut policy = SearchPolicy::new(true);
        assert_eq!(policy.next_step(8), SearchStep::CompareSample(1));
        assert!(!policy.record_sample(0, 100));
        assert_eq!(
            [policy.next_step(3), policy.next_step(3), policy.next_step(1)],
            [SearchStep::Rest, SearchStep::Rest, SearchStep::CopySample]
        );
        assert_eq!(policy.next_step(3), SearchStep::CompareSample(0));
        assert!(policy.record_sample(70, 100));
        assert_eq!(policy.next_step(3), SearchStep::CompareAll);
    }
}
