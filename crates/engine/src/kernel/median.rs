// SPDX-License-Identifier: MIT OR Apache-2.0
//! The median of nine: sort the three pixels of each column once, then combine three columns.
//!
//! Of the nine, the median is the median of the largest low, the middle mid and the smallest high.

use crate::kernel::Line;
use crate::lane::{BLOCK, Block, Lane};

/// The three pixels of every column, sorted.
#[inline(always)]
pub(crate) fn sort_columns<T: Lane>(rows: [&[Block<T>]; 3], sorted: [&mut [Block<T>]; 3]) {
    let ([a, b, c], [low, mid, high]) = (rows, sorted);
    let blocks = low.len();
    let (a, b, c) = (&a[..blocks], &b[..blocks], &c[..blocks]);
    let (mid, high) = (&mut mid[..blocks], &mut high[..blocks]);
    for at in 0..blocks {
        let (a, b, c) = (&a[at], &b[at], &c[at]);
        let (low, mid, high) = (&mut low[at], &mut mid[at], &mut high[at]);
        for i in 0..BLOCK {
            let (p, q, r) = (a[i], b[i], c[i]);
            let (p, q) = (p.min(q), p.max(q));
            let (q, r) = (q.min(r), q.max(r));
            (low[i], mid[i], high[i]) = (p.min(q), p.max(q), r);
        }
    }
}

/// The median of every window, from its three sorted columns.
#[inline(always)]
pub(crate) fn combine<T: Lane>(
    [low, mid, high]: [Line<'_, T>; 3],
    seams: Option<Seams<'_, T>>,
    out: &mut [Block<T>],
) {
    let blocks = out.len();
    let (low, mid, high) = (low.of(blocks), mid.of(blocks), high.of(blocks));
    match seams {
        None => {
            for (at, out) in out.iter_mut().enumerate() {
                let pick =
                    |line: Line<'_, T>, i| (line.west[at][i], line.center[at][i], line.east[at][i]);
                for i in 0..BLOCK {
                    out[i] = of_columns(pick(low, i), pick(mid, i), pick(high, i));
                }
            }
        }
        Some(seams) => {
            let (first, last) = (&seams.first[..blocks], &seams.last[..blocks]);
            for (at, out) in out.iter_mut().enumerate() {
                let pick = |line: Line<'_, T>, i| {
                    let center = line.center[at][i];
                    (
                        select(first[at][i], center, line.west[at][i]),
                        center,
                        select(last[at][i], center, line.east[at][i]),
                    )
                };
                for i in 0..BLOCK {
                    out[i] = of_columns(pick(low, i), pick(mid, i), pick(high, i));
                }
            }
        }
    }
}

/// Where regions begin and end that do not see each other: every bit set in their first and last
/// columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seams<'a, T> {
    pub(crate) first: &'a [Block<T>],
    pub(crate) last: &'a [Block<T>],
}

/// Neighbors of every lane that do not reach over a seam.
#[inline(always)]
pub(crate) fn clamp<T: Lane>(
    line: Line<'_, T>,
    seams: Seams<'_, T>,
    west: &mut [Block<T>],
    east: &mut [Block<T>],
) {
    let blocks = west.len();
    let (line, east) = (line.of(blocks), &mut east[..blocks]);
    let (first, last) = (&seams.first[..blocks], &seams.last[..blocks]);
    for at in 0..blocks {
        for i in 0..BLOCK {
            let center = line.center[at][i];
            west[at][i] = select(first[at][i], center, line.west[at][i]);
            east[at][i] = select(last[at][i], center, line.east[at][i]);
        }
    }
}

/// `yes` where the mask is set, otherwise `no`.
#[inline(always)]
fn select<T: Lane>(mask: T, yes: T, no: T) -> T {
    no ^ ((yes ^ no) & mask)
}

#[inline(always)]
fn of_columns<T: Lane>(low: (T, T, T), mid: (T, T, T), high: (T, T, T)) -> T {
    middle((low.0.max(low.1).max(low.2), middle(mid), high.0.min(high.1).min(high.2)))
}

/// The second of three sorted values.
#[inline(always)]
fn middle<T: Lane>((a, b, c): (T, T, T)) -> T {
    a.min(b).max(a.max(b).min(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A network of minima and maxima sorts everything iff it sorts zeros and ones.
    #[test]
    fn every_window_of_zeros_and_ones_has_its_median() {
        for bits in 0..512u32 {
            let pixel = |place: u32| [u8::from(bits >> place & 1 == 1); BLOCK];
            let columns: Vec<[[u8; BLOCK]; 3]> = (0..3)
                .map(|x| {
                    let rows = [pixel(x), pixel(3 + x), pixel(6 + x)];
                    let mut sorted = [[0; BLOCK]; 3];
                    let [low, mid, high] = &mut sorted;
                    let lines = rows.each_ref().map(std::slice::from_ref);
                    sort_columns(lines, [low, mid, high].map(std::slice::from_mut));
                    sorted
                })
                .collect();
            let line = |rank: usize| Line {
                west: std::slice::from_ref(&columns[0][rank]),
                center: std::slice::from_ref(&columns[1][rank]),
                east: std::slice::from_ref(&columns[2][rank]),
            };
            let mut out = [[9; BLOCK]];
            combine([line(0), line(1), line(2)], None, &mut out);
            assert_eq!(out, [[u8::from(bits.count_ones() >= 5); BLOCK]], "window {bits:09b}");
        }
    }
}
