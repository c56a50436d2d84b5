// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random numbers that are equal for equal seeds on every machine and in every version.

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
