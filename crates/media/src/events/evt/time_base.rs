// SPDX-License-Identifier: MIT OR Apache-2.0
//! The high part of times, which counts in a loop.

/// The writer's side: the high part of the last word that stated it.
#[derive(Clone, Debug)]
pub(crate) struct TimeBaseEncoder {
    /// The high part, with all loops; `None` before the first word.
    high: Option<u64>,
    /// The number of values of a loop.
    values: u64,
}

impl TimeBaseEncoder {
    pub(crate) fn new(bits: u32) -> Self {
        Self { high: None, values: 1 << bits }
    }

    /// Moves to a high part that is not smaller. Calls `word` with every value that a word has to
    /// state.
    ///
    /// A stream begins with 0, from which readers count. Some readers take only a step from the
    /// largest value to 0 for a new loop, and some take a step of more than half a loop for one
    /// back. So the largest value and 0 follow each other, and other steps are short: a quarter of
    /// a loop at most, or 1 within the last loop if `is_stepwise`, as sensors do in EVT 3.0.
    pub(crate) fn advance(&mut self, high: u64, is_stepwise: bool, mut word: impl FnMut(u64)) {
        let mut at = self.high.unwrap_or_else(|| {
            word(0);
            0
        });
        let quarter = self.values / 4;
        let mut go_to = |at: &mut u64, target: u64, step: u64| {
            while *at < target {
                *at = target.min(*at + step);
                word(*at % self.values);
            }
        };
        while at / self.values < high / self.values {
            let next_loop = (at / self.values + 1) * self.values;
            go_to(&mut at, next_loop - 1, quarter);
            go_to(&mut at, next_loop, 1);
        }
        go_to(&mut at, high, if is_stepwise { 1 } else { quarter });
        self.high = Some(high);
    }

    /// Returns the high part; `None` before the first word.
    pub(crate) fn high(&self) -> Option<u64> {
        self.high
    }
}

/// The reader's side: the high part of the last word that stated it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TimeBaseDecoder {
    high: Option<u64>,
    values: u64,
}

impl TimeBaseDecoder {
    pub(crate) fn new(bits: u32) -> Self {
        Self { high: None, values: 1 << bits }
    }

    /// Takes the value of a word. A value that is lower by more than half a loop begins a new loop.
    pub(crate) fn take(&mut self, value: u64) {
        let last = self.high.unwrap_or(value);
        let loops = last / self.values * self.values;
        let is_new_loop = last % self.values > value + self.values / 2;
        self.high = Some(loops + value + if is_new_loop { self.values } else { 0 });
    }

    /// Returns the high part with all loops; `None` before the first word.
    pub(crate) fn high(&self) -> Option<u64> {
        self.high
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(bits: u32, steps: bool, highs: &[u64]) -> Vec<u64> {
        let (mut base, mut words) = (TimeBaseEncoder::new(bits), Vec::new());
        highs.iter().for_each(|&high| base.advance(high, steps, |word| words.push(word)));
        words
    }

    #[test]
    fn a_base_begins_with_0_and_states_every_loop() {
        assert_eq!(words(3, false, &[0, 0, 2, 3]), [0, 2, 3]);
        assert_eq!(words(3, true, &[3]), [0, 1, 2, 3]);
        assert_eq!(words(3, false, &[5, 10]), [0, 2, 4, 5, 7, 0, 2]);
        assert_eq!(words(3, true, &[7, 9]), [0, 1, 2, 3, 4, 5, 6, 7, 0, 1]);
        assert_eq!(words(3, true, &[8 * 2]), [0, 2, 4, 6, 7, 0, 2, 4, 6, 7, 0]);
    }

    #[test]
    fn a_reader_finds_the_high_parts() {
        for steps in [false, true] {
            let highs = [0, 3, 3, 7, 8, 30, 31, 100];
            let mut read = TimeBaseDecoder::new(3);
            let mut found = Vec::new();
            let mut base = TimeBaseEncoder::new(3);
            for high in highs {
                base.advance(high, steps, |word| read.take(word));
                found.push(read.high().unwrap());
            }
            assert_eq!(found, highs);
        }
    }
}
