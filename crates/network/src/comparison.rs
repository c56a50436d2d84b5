// SPDX-License-Identifier: MIT OR Apache-2.0
//! Compares new values of a tensor with its kept values. The loops run over values that are
//! neighbors in memory, as vectors, because this comparison is the only extra cost of the
//! modes that compare.

use super::tensor::TensorForm;
use crate::mask::Mask;
use crate::tensor::for_each_run;
use crate::values::TensorNumber;

/// The positions that are compared in all channels before the next ones, so that their marks stay
/// in the first-level cache.
const POSITIONS_PER_BATCH: usize = 2048;

/// Returns the positions of `at` at which a value differs by more than `limit`. With a limit of 0,
/// values differ if any bit differs.
pub(crate) fn changed_positions<T: TensorNumber>(
    form: &TensorForm,
    kept: &[T],
    fresh: &[T],
    at: &Mask,
    limit: f32,
) -> Mask {
    if limit > 0.0 {
        let scale = form.encoding().scale;
        // A distance that is NaN is not within the limit. Both conditions are evaluated, because a
        // branch would prevent vector instructions.
        let is_near =
            |kept: T, fresh: T| kept.has_same_bits(fresh) | (kept.distance(fresh) * scale <= limit);
        differing_positions(form, kept, fresh, at, is_near)
    } else {
        differing_positions(form, kept, fresh, at, T::has_same_bits)
    }
}

/// Returns the positions of `at` at which `is_alike` is false for at least one value.
fn differing_positions<T: TensorNumber>(
    form: &TensorForm,
    kept: &[T],
    fresh: &[T],
    at: &Mask,
    is_alike: impl Fn(T, T) -> bool,
) -> Mask {
    let (inner, places) = (form.inner_size(), form.position_count());
    let mut found = Mask::empty(form.height(), form.width());
    let mut marks = [0; POSITIONS_PER_BATCH];
    for range in at.memory_ranges() {
        for start in range.clone().step_by(POSITIONS_PER_BATCH) {
            let marks = &mut marks[..POSITIONS_PER_BATCH.min(range.end - start)];
            marks.fill(0);
            for outer in 0..form.outer_size() {
                let from = (outer * places + start) * inner;
                let values = from..from + marks.len() * inner;
                mark_differing(marks, &kept[values.clone()], &fresh[values], inner, &is_alike);
            }
            found.insert_marked(start, marks);
        }
    }
    found
}

/// Marks the positions at which `is_alike` is false for one of their `inner` values.
fn mark_differing<T: TensorNumber>(
    marks: &mut [u32],
    kept: &[T],
    fresh: &[T],
    inner: usize,
    is_alike: &impl Fn(T, T) -> bool,
) {
    let differs = |(&kept, &fresh): (&T, &T)| u32::from(!is_alike(kept, fresh));
    let pairs = kept.iter().zip(fresh);
    if inner == 1 {
        marks.iter_mut().zip(pairs).for_each(|(mark, pair)| *mark |= differs(pair));
        return;
    }
    let values_of_positions = kept.chunks_exact(inner).zip(fresh.chunks_exact(inner));
    for (mark, (kept, fresh)) in marks.iter_mut().zip(values_of_positions) {
        *mark |= kept.iter().zip(fresh).fold(0, |mark, pair| mark | differs(pair));
    }
}

/// Copies the values at the positions of `at`.
pub(crate) fn copy_positions<T: TensorNumber>(
    form: &TensorForm,
    from: &[T],
    to: &mut [T],
    at: &Mask,
) {
    for_each_run(form, at, |run| to[run.clone()].copy_from_slice(&from[run]));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{ElementType, Encoding};
    use proptest::prelude::*;

    /// Compares value by value, by the definition of the modes.
    fn naive<T: TensorNumber>(
        form: &TensorForm,
        kept: &[T],
        fresh: &[T],
        at: &Mask,
        limit: f32,
    ) -> Mask {
        let (inner, places) = (form.inner_size(), form.position_count());
        let differs = |kept: T, fresh: T| {
            !kept.has_same_bits(fresh)
                && (limit == 0.0
                    || kept.distance(fresh).is_nan()
                    || kept.distance(fresh) * form.encoding().scale > limit)
        };
        let mut found = Mask::empty(form.height(), form.width());
        for (number, (&kept, &fresh)) in kept.iter().zip(fresh).enumerate() {
            let place = number / inner % places;
            let (x, y) = (place % form.width(), place / form.width());
            if at.contains(x, y) && differs(kept, fresh) {
                found.insert(x, y);
            }
        }
        found
    }

    /// Forms with fewer and more positions than a mask word and a comparison block, and forms with
    /// the channels last.
    fn forms() -> impl Strategy<Value = TensorForm> {
        let features = (1usize..4, 1usize..70, prop_oneof![1usize..10, 60usize..70]).prop_map(
            |(channels, height, width)| TensorForm::features(vec![1, channels, height, width]),
        );
        let last = (1usize..9, 1usize..70, 1usize..5).prop_map(|(height, width, inner)| {
            TensorForm::with_positions(vec![1, height, width, inner], 1..3)
        });
        prop_oneof![features, last]
    }

    fn check<T: TensorNumber>(form: &TensorForm, seed: u64, limit: f32, value: impl Fn(u64) -> T) {
        let mut state = seed | 1;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            state >> 40
        };
        let dense = seed % 3;
        let bits: Vec<bool> = (0..form.position_count()).map(|_| next() % 3 <= dense).collect();
        let at = Mask::from_fn(form.height(), form.width(), |x, y| bits[y * form.width() + x]);
        let kept: Vec<T> = (0..form.element_count()).map(|_| value(next())).collect();
        // One value in eight is drawn anew.
        let fresh: Vec<T> =
            kept.iter().map(|&kept| if next() % 8 == 0 { value(next()) } else { kept }).collect();
        let found = changed_positions(form, &kept, &fresh, &at, limit);
        assert_eq!(found, naive(form, &kept, &fresh, &at, limit));
        let mut copied = kept.clone();
        copy_positions(form, &fresh, &mut copied, &found);
        for (place, ((copied, kept), fresh)) in copied.iter().zip(&kept).zip(&fresh).enumerate() {
            let place = place / form.inner_size() % form.position_count();
            let is_moved = found.contains(place % form.width(), place / form.width());
            assert!(copied.has_same_bits(if is_moved { *fresh } else { *kept }));
        }
    }

    proptest! {
        #[test]
        fn changed_positions_are_those_of_a_comparison_value_by_value(form in forms(), seed: u64, limit in prop_oneof![Just(0.0f32), 0.01f32..2.0, Just(f32::INFINITY)]) {
            #[allow(clippy::cast_precision_loss, reason = "small numbers")]
            let special_value = |bits: u64| match bits % 16 {
                0 => f32::NAN,
                1 => f32::INFINITY,
                2 => 0.0,
                3 => -0.0,
                other => other as f32 / 8.0,
            };
            check::<f32>(&form, seed, limit, special_value);
            let encoded_form = |element| form.clone().with_encoding(Encoding { scale: 0.25, ..Encoding::plain(element) });
            check::<u8>(&encoded_form(ElementType::U8), seed, limit, |bits| (bits % 9).to_le_bytes()[0]);
            check::<i32>(&encoded_form(ElementType::I32), seed, limit, |bits| i32::try_from(bits % 9).unwrap() - 4);
        }
    }
}
