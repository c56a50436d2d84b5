// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which regions are bit-identical to the last frame, and when it pays to ask.
//!
//! Asking costs a copy of every frame, so the engine asks only while the answer is worth it: after a
//! comparison that found little it rests for some frames, longer each time. Results never depend on
//! it.

use std::ops::Range;

use crate::lane::{BLOCK, Lane};
use crate::pixels::Pixels;
use crate::plan::Plan;

/// What to do with a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// Nothing.
    Rest,
    /// Keep a copy for the next frame.
    Keep,
    /// Compare with the copy, and keep what has changed.
    Compare,
}

/// Frames to rest after the first comparison that found little; doubled up to the second.
const RESTS: (u32, u32) = (4, 32);
/// A comparison pays when it saves more than one in this many blocks.
const PAYS: usize = 4;
/// The share of a band's blocks from which on it is computed as a whole.
const NEARLY: (usize, usize) = (4, 5);

/// When to compare.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Policy {
    on: bool,
    kept: bool,
    left: u32,
    rest: u32,
}

impl Policy {
    pub(crate) fn new(on: bool) -> Self {
        Self { on, kept: false, left: 0, rest: RESTS.0 }
    }

    /// What to do with the next frame.
    pub(crate) fn next(&mut self) -> Step {
        if !self.on {
            return Step::Rest;
        }
        if self.kept {
            return Step::Compare;
        }
        if self.left > 0 {
            self.left -= 1;
            return Step::Rest;
        }
        self.kept = true;
        Step::Keep
    }

    /// Learns what a comparison has found.
    pub(crate) fn found(&mut self, saved: usize, blocks: usize) {
        if saved * PAYS > blocks {
            self.rest = RESTS.0;
        } else {
            (self.kept, self.left) = (false, self.rest);
            self.rest = (2 * self.rest).min(RESTS.1);
        }
    }
}

/// Compares band `number` with its copy of the last frame, brings the copy up to date, and says of
/// every region whether a pixel has changed.
#[inline(always)]
pub(crate) fn compare<T: Lane>(
    plan: &Plan<T>,
    raw: Pixels<'_, T>,
    number: usize,
    copy: &mut [T],
    changed: &mut [bool],
) {
    changed.fill(false);
    let mut every = false;
    for (y, last) in copy.chunks_exact_mut(plan.width).enumerate() {
        let now = raw.row(number * plan.side + y);
        if !every {
            if now == last {
                continue;
            }
            compare_row(now, last, plan.side, changed);
            every = changed.iter().all(|&changed| changed);
        }
        last.copy_from_slice(now);
    }
}

/// Copies band `number`.
#[inline(always)]
pub(crate) fn keep<T: Lane>(plan: &Plan<T>, raw: Pixels<'_, T>, number: usize, copy: &mut [T]) {
    for (y, copy) in copy.chunks_exact_mut(plan.width).enumerate() {
        copy.copy_from_slice(raw.row(number * plan.side + y));
    }
}

#[inline(always)]
fn compare_row<T: Lane>(now: &[T], last: &[T], side: usize, changed: &mut [bool]) {
    match side {
        8 => compare_constant::<8, T>(now, last, changed),
        16 => compare_constant::<16, T>(now, last, changed),
        32 => compare_constant::<32, T>(now, last, changed),
        64 => compare_constant::<64, T>(now, last, changed),
        _ => compare_any(now, last, side, changed),
    }
}

#[inline(always)]
fn compare_constant<const SIDE: usize, T: Lane>(now: &[T], last: &[T], changed: &mut [bool]) {
    let ((now, now_rest), (last, last_rest)) = (now.as_chunks::<SIDE>(), last.as_chunks::<SIDE>());
    let (whole, ragged) = changed.split_at_mut(now.len());
    for ((now, last), changed) in now.iter().zip(last).zip(whole) {
        *changed |= now != last;
    }
    compare_any(now_rest, last_rest, SIDE, ragged);
}

#[inline(always)]
fn compare_any<T: Lane>(now: &[T], last: &[T], side: usize, changed: &mut [bool]) {
    for ((now, last), changed) in now.chunks(side).zip(last.chunks(side)).zip(changed) {
        *changed |= now != last;
    }
}

/// Which regions of band `number` may have other results than in the last frame: those that have
/// changed, and where neighbors are seen those around them. Two pixels of halo are at most a region.
pub(crate) fn affected<T: Lane>(
    plan: &Plan<T>,
    changed: &[bool],
    number: usize,
    affected: &mut [bool],
) {
    let columns = plan.columns;
    let band = |number: usize| &changed[number * columns..][..columns];
    affected.copy_from_slice(band(number));
    if plan.seams.is_some() {
        return;
    }
    for row in number.saturating_sub(1)..(number + 2).min(plan.rows) {
        for (column, _) in band(row).iter().enumerate().filter(|(_, changed)| **changed) {
            affected[column.saturating_sub(1)..(column + 2).min(columns)].fill(true);
        }
    }
}

/// The blocks under the affected regions, as runs. Each run costs `margin` blocks on each side: what
/// lies closer together is one run, and where nearly all of the blocks are wanted it is all of them.
pub(crate) fn runs<T: Lane>(plan: &Plan<T>, affected: &[bool], runs: &mut Vec<Range<usize>>) {
    runs.clear();
    let (side, margin) = (plan.side, plan.margin());
    for (column, _) in affected.iter().enumerate().filter(|(_, affected)| **affected) {
        let (start, end) = (column * side / BLOCK, ((column + 1) * side).div_ceil(BLOCK));
        match runs.last_mut() {
            Some(last) if start <= last.end + 2 * margin => last.end = end,
            _ => runs.push(start..end),
        }
    }
    let cost: usize = runs.iter().map(|run| run.len() + 2 * margin).sum();
    if cost * NEARLY.1 > plan.blocks * NEARLY.0 {
        runs.clear();
        runs.push(0..plan.blocks);
    }
}

#[cfg(test)]
mod tests {
    use foveate_spec::{Config, Neighborhood};

    use super::*;

    #[test]
    fn rests_grow_while_nothing_is_found_and_end_when_it_pays() {
        let mut policy = Policy::new(true);
        let mut film = |skipped: usize, frames: usize| -> String {
            let step = |_| match policy.next() {
                Step::Rest => '.',
                Step::Keep => 'k',
                Step::Compare => {
                    policy.found(skipped, 100);
                    'c'
                }
            };
            (0..frames).map(step).collect()
        };
        assert_eq!(film(0, 18), "kc....kc........kc");
        assert_eq!(film(0, 16), "................");
        assert_eq!(film(50, 5), "kcccc");
        assert_eq!(film(0, 6), "c....k");
        assert_eq!(Policy::new(false).next(), Step::Rest);
    }

    #[test]
    fn runs_cover_affected_regions_and_merge() {
        let found = |width: u32, side: u32, neighborhood, columns: &[usize]| {
            let mut config = Config::default();
            (config.frame.width, config.frame.height) = (Some(width), Some(side));
            (config.region.size, config.region.neighborhood) = (side, neighborhood);
            let plan = Plan::<u8>::new(&config.validate().unwrap());
            let affected: Vec<bool> = (0..plan.columns).map(|x| columns.contains(&x)).collect();
            let mut found = Vec::new();
            runs(&plan, &affected, &mut found);
            found
        };
        use Neighborhood::{Isolated, Shared};
        assert_eq!(found(640, 8, Isolated, &[0, 7, 8, 24]), [0..2, 3..4]);
        assert_eq!(found(1280, 8, Shared, &[0, 7, 8, 24, 56]), [0..4, 7..8]);
        // Region 10 of 6 columns lies in two blocks.
        assert_eq!(found(600, 6, Isolated, &[10]), [0..2]);
        // Nearly everything is everything; nothing is nothing.
        assert_eq!(found(256, 8, Shared, &[0, 24]), [0..4]);
        assert_eq!(found(640, 8, Shared, &[]), []);
    }
}
