// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search for the coarsest quantizer that is good enough, by bisection: quality falls as the
//! quantizer rises.

use std::ops::RangeInclusive;

/// Returns the largest quantizer for which `is_good` returns `true`; `None` if even the first one
/// is not good enough.
///
/// # Errors
/// Fails if `is_good` fails.
pub fn coarsest_quantizer<E>(
    quantizers: RangeInclusive<u32>,
    mut is_good: impl FnMut(u32) -> Result<bool, E>,
) -> Result<Option<u32>, E> {
    let (mut good, mut bad) = quantizers.into_inner();
    if is_good(bad)? {
        return Ok(Some(bad));
    }
    if !is_good(good)? {
        return Ok(None);
    }
    while bad - good > 1 {
        let middle = good + (bad - good) / 2;
        if is_good(middle)? {
            good = middle;
        } else {
            bad = middle;
        }
    }
    Ok(Some(good))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_limit_is_found_in_few_steps() {
        for limit in 0..=53 {
            let mut asked = 0;
            let found = coarsest_quantizer(1..=52, |quantizer| {
                asked += 1;
                Ok::<_, ()>(quantizer <= limit)
            });
            assert_eq!(found, Ok((limit > 0).then_some(limit.min(52))));
            assert!(asked <= 8, "{asked} for {limit}");
        }
        assert_eq!(coarsest_quantizer(5..=5, |_| Ok::<_, ()>(true)), Ok(Some(5)));
        assert_eq!(coarsest_quantizer(0..=9, |_| Err(7)), Err(7));
    }
}
