// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clips in which regions become active and inactive again.

use foveate_frame::Frame;
use proptest::prelude::*;

use crate::recipe::Recipe;

#[derive(Clone, Copy, Debug)]
pub(crate) enum Content {
    Noise,
    Binary,
    AlmostFlat,
    Ramp,
    Repeat,
    Nudge,
    Touch,
}

/// The content and the seed of each frame.
pub(crate) type Script = Vec<(Content, u64)>;

pub(crate) fn scripts(most: usize) -> impl Strategy<Value = Script> {
    use Content::{AlmostFlat, Binary, Noise, Nudge, Ramp, Repeat, Touch};
    let content = proptest::sample::select(vec![
        Noise, Binary, AlmostFlat, AlmostFlat, Ramp, Repeat, Nudge, Touch, Touch,
    ]);
    proptest::collection::vec((content, any::<u64>()), 1..=most)
}

/// Returns the frames of a script.
pub(crate) fn film(recipe: &Recipe, script: &Script) -> Vec<Frame> {
    let (width, height) = (recipe.width as u32, recipe.height as u32);
    let max = recipe.pixel_max();
    let mut film: Vec<Frame> = Vec::new();
    for &(content, seed) in script {
        let mut random = Random(seed);
        let base = random.below(max + 1);
        let last = film.last().cloned();
        let frame = Frame::from_fn(width, height, recipe.bits, |x, y| {
            let before = last.as_ref().map_or(base, |frame| i64::from(frame.get(x, y)));
            let value = match content {
                Content::Noise => random.below(max + 1),
                Content::Binary => max * random.below(2),
                Content::AlmostFlat => base + random.below(3),
                Content::Ramp => base / 2 + i64::from(x) * (seed % 9) as i64 + i64::from(y),
                Content::Repeat => before,
                Content::Nudge => before + random.below(5) - 2,
                Content::Touch if random.below(6) == 0 => random.below(max + 1),
                Content::Touch => before,
            };
            value.clamp(0, max) as u16
        });
        film.push(frame.unwrap());
    }
    film
}

/// A small random generator (splitmix64), whose values depend on the seed alone.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, end: i64) -> i64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end as u64) as i64
    }
}
