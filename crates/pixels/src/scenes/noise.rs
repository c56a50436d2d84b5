// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random numbers without a state. They are hashes of (seed, a, b, c), so any frame can be made on
//! its own.

/// Returns 64 random bits for a place and a time, by three rounds of the finalizer of `SplitMix64`.
pub(crate) fn hash(seed: u64, a: u32, b: u32, c: u32) -> u64 {
    mix(mix(mix(seed ^ u64::from(a)).wrapping_add(u64::from(b))).wrapping_add(u64::from(c)))
}

/// Returns a random number in `0..bound`. `bound` is at least 1.
pub(crate) fn pick(seed: u64, a: u32, b: u32, c: u32, bound: u32) -> u32 {
    let high = hash(seed, a, b, c) >> 32;
    u32::try_from((high * u64::from(bound)) >> 32).expect("below the bound")
}

/// Returns approximately normal noise: the number of ones among 16 random bits minus its mean. It
/// is in -8..=8, with a standard deviation of 2.
pub(crate) fn normal_noise(seed: u64, t: u32, x: u32, y: u32) -> i32 {
    let ones = (hash(seed, t, x, y) & 0xFFFF).count_ones();
    i32::try_from(ones).expect("at most 16") - 8
}

fn mix(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_outputs_are_those_of_splitmix64() {
        // The expected value is the first output of the reference implementation with seed 0.
        assert_eq!(mix(0), 0xE220_A839_7B1D_CDAF);
    }

    #[test]
    fn noise_is_centred_and_has_the_stated_spread() {
        let values: Vec<i32> = (0..10_000).map(|x| normal_noise(7, 0, x, 0)).collect();
        let sum: i32 = values.iter().sum();
        let squares: i32 = values.iter().map(|v| v * v).sum();
        assert!(sum.abs() < 1_000, "mean {sum} / 10000");
        assert!((38_000..42_000).contains(&squares), "variance {squares} / 10000");
    }

    #[test]
    fn a_pick_stays_below_its_bound() {
        for bound in [1, 2, 7, 255, u32::MAX] {
            assert!((0..1_000).all(|x| pick(3, x, 1, 2, bound) < bound));
        }
    }
}
