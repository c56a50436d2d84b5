// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clips in which regions become active and inactive again.

use foveate_pixels::Frame;
use proptest::prelude::*;

use crate::parameters::DesignParameters;

#[derive(Clone, Copy, Debug)]
pub(crate) enum FrameContent {
    Noise,
    Binary,
    AlmostFlat,
    Ramp,
    Repeat,
    SmallSteps,
    FewChanges,
    /// The frame before, moved by up to three pixels.
    Moved,
}

/// The content and the seed of each frame.
pub(crate) type ClipScript = Vec<(FrameContent, u64)>;

pub(crate) fn arbitrary_scripts(most: usize) -> impl Strategy<Value = ClipScript> {
    use FrameContent::{AlmostFlat, Binary, FewChanges, Moved, Noise, Ramp, Repeat, SmallSteps};
    let content = proptest::sample::select(vec![
        Noise, Binary, AlmostFlat, AlmostFlat, Ramp, Repeat, SmallSteps, FewChanges, FewChanges,
        Moved, Moved,
    ]);
    proptest::collection::vec((content, any::<u64>()), 1..=most)
}

pub(crate) fn make_clip(recipe: &DesignParameters, script: &ClipScript) -> Vec<Frame> {
    let (width, height) = (recipe.width as u32, recipe.height as u32);
    let max = recipe.pixel_max();
    let mut clip: Vec<Frame> = Vec::new();
    for &(content, seed) in script {
        let mut random = SeededRandom(seed);
        let base = random.below(max + 1);
        let last = clip.last().cloned();
        let frame = Frame::from_fn(width, height, recipe.bits, |x, y| {
            let before = last.as_ref().map_or(base, |frame| i64::from(frame.get(x, y)));
            let value = match content {
                FrameContent::Noise => random.below(max + 1),
                FrameContent::Binary => max * random.below(2),
                FrameContent::AlmostFlat => base + random.below(3),
                FrameContent::Ramp => base / 2 + i64::from(x) * (seed % 9) as i64 + i64::from(y),
                FrameContent::Repeat => before,
                FrameContent::SmallSteps => before + random.below(5) - 2,
                FrameContent::FewChanges if random.below(6) == 0 => random.below(max + 1),
                FrameContent::FewChanges => before,
                FrameContent::Moved => last.as_ref().map_or_else(
                    || random.below(max + 1),
                    |frame| {
                        let (dx, dy) = ((seed % 7) as i64 - 3, (seed / 7 % 7) as i64 - 3);
                        frame.get_clamped(i64::from(x) - dx, i64::from(y) - dy).into()
                    },
                ),
            };
            value.clamp(0, max) as u16
        });
        clip.push(frame.unwrap());
    }
    clip
}

/// A small random generator (splitmix64), whose values depend on the seed alone.
#[derive(Clone, Debug)]
pub(crate) struct SeededRandom(pub(crate) u64);

impl SeededRandom {
    pub(crate) fn below(&mut self, end: i64) -> i64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end as u64) as i64
    }
}
