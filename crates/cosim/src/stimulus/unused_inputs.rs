// SPDX-License-Identifier: MIT OR Apache-2.0
//! The values at input ports while they mean nothing ([`UnusedInputs`]), and the source of all
//! random values of a stimulus ([`Random`]), which is equal for equal seeds on every machine
//! and in every version.

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

/// SplitMix64 (Steele, Lea and Flood, 2014): one multiply-xor hash of a counter per number.
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Returns another generator, for a part that must not depend on the number of values that
    /// others draw.
    pub(crate) fn fork(&mut self) -> Self {
        Self(self.next())
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number in `0..=max`.
    pub(crate) fn up_to(&mut self, max: u64) -> u64 {
        match max.checked_add(1) {
            // The bias of the remainder does not matter here.
            Some(count) => self.next() % count,
            None => self.next(),
        }
    }

    /// Returns a number in `0..=max`.
    pub(crate) fn up_to_u32(&mut self, max: u32) -> u32 {
        u32::try_from(self.up_to(max.into())).expect("it is at most `max`")
    }

    /// Returns a number in `0..=max`, as an index.
    pub(crate) fn index(&mut self, max: usize) -> usize {
        usize::try_from(self.up_to(max as u64)).expect("it is at most `max`")
    }

    /// Returns a pixel in `0..=max`.
    pub(crate) fn pixel(&mut self, max: u16) -> u16 {
        u16::try_from(self.up_to(max.into())).expect("it is at most `max`")
    }

    /// Returns true in one of `count` cases.
    pub(crate) fn one_in(&mut self, count: u64) -> bool {
        self.up_to(count.saturating_sub(1)) == 0
    }

    /// Returns one of the given items, or `None` if there are none.
    pub(crate) fn choose<T: Copy>(&mut self, things: &[T]) -> Option<T> {
        let last = things.len().checked_sub(1)?;
        Some(things[self.index(last)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_reference() {
        let mut random = Random::new(1_234_567);
        let first = [random.next(), random.next(), random.next()];
        assert_eq!(
            first,
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]
        );
    }

    #[test]
    fn ranges_are_kept_and_reached() {
        let mut random = Random::new(1);
        let drawn: Vec<u64> = (0..200).map(|_| random.up_to(3)).collect();
        assert!((0..=3).all(|value| drawn.contains(&value)) && drawn.iter().all(|&v| v <= 3));
        assert_eq!(random.choose::<u8>(&[]), None);
        random.up_to(u64::MAX);
    }
}
