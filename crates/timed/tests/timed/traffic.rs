// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random traffic: pauses of the source, stalls of the sink, resets and damaged frames.

use proptest::prelude::*;

/// A small generator of random numbers that is the same on every machine.
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed | 1)
    }

    /// Returns a number in `0..count`.
    pub(crate) fn below(&mut self, count: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) % count.max(1)
    }

    pub(crate) fn percent(&mut self, percent: u64) -> bool {
        self.below(100) < percent
    }
}

/// The habits of the surroundings of a core.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Traffic {
    /// The percentage of beats before which the source pauses.
    pub(crate) gaps: u64,
    /// The longest pause before a beat.
    pub(crate) longest_gap: u64,
    /// The longest pause before a frame.
    pub(crate) longest_pause: u64,
    /// The longest time for which the sink is ready, or 0 if it never stalls.
    pub(crate) longest_ready: u64,
    pub(crate) longest_stall: u64,
    /// The percentage of frames with a reset.
    pub(crate) resets: u64,
    /// The percentage of frames that are damaged, if the design finds frames.
    pub(crate) damage: u64,
    pub(crate) seed: u64,
}

impl Traffic {
    /// A source and a sink that never wait.
    pub(crate) const DENSE: Self = Self {
        gaps: 0,
        longest_gap: 0,
        longest_pause: 0,
        longest_ready: 0,
        longest_stall: 0,
        resets: 0,
        damage: 0,
        seed: 1,
    };
}

pub(crate) fn traffic() -> impl Strategy<Value = Traffic> {
    let gaps = prop_oneof![2 => Just((0u64, 0u64)), 1 => (1u64..=40, 1u64..=3), 1 => (1u64..=3, 1u64..=300)];
    let pause = prop_oneof![2 => Just(0u64), 1 => 0u64..=60, 1 => 0u64..=1500];
    let stalls = prop_oneof![
        2 => Just((0u64, 0u64)),
        2 => (1u64..=4, 1u64..=4),
        2 => (1u64..=200, 1u64..=200),
        2 => (1u64..=100, 100u64..=3000),
        1 => (1u64..=3, 1u64..=60),
    ];
    let events = (
        prop_oneof![2 => Just(0u64), 1 => 0u64..=40],
        prop_oneof![1 => Just(0u64), 1 => 0u64..=50],
    );
    (gaps, pause, stalls, events, any::<u64>()).prop_map(
        |(
            (gaps, longest_gap),
            longest_pause,
            (longest_ready, longest_stall),
            (resets, damage),
            seed,
        )| {
            Traffic {
                gaps,
                longest_gap,
                longest_pause,
                longest_ready,
                longest_stall,
                resets,
                damage,
                seed,
            }
        },
    )
}
