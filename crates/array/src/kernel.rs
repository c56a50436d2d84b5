// SPDX-License-Identifier: MIT OR Apache-2.0
//! The arithmetic on one window of every RPU: nine rows of lanes in, one out.
#![allow(clippy::needless_range_loop, reason = "lanes by number, in one loop: what vectorises")]

use foveate_lanes::{BLOCK, Block, Lane, best_arc};

/// Nine rows of lanes, row by row of the window.
pub(crate) type Window<'a, T> = [&'a [Block<T>]; 9];

/// Block `at` of each of the nine rows. Written out, because a closure over an array keeps the loops
/// below from becoming vector instructions.
#[inline(always)]
fn blocks<'a, T>(rows: &Window<'a, T>, at: usize) -> [&'a Block<T>; 9] {
    let [a, b, c, d, e, f, g, h, i] = rows;
    [&a[at], &b[at], &c[at], &d[at], &e[at], &f[at], &g[at], &h[at], &i[at]]
}

/// The fifth of nine sorted values.
#[inline(always)]
pub(crate) fn median<T: Lane>(window: Window<'_, T>, out: &mut [Block<T>]) {
    for (at, out) in out.iter_mut().enumerate() {
        let [nw, n, ne, w, center, e, sw, s, se] = blocks(&window, at);
        let mut medians = [T::default(); BLOCK];
        for i in 0..BLOCK {
            let (la, ma, ha) = sorted(nw[i], w[i], sw[i]);
            let (lb, mb, hb) = sorted(n[i], center[i], s[i]);
            let (lc, mc, hc) = sorted(ne[i], e[i], se[i]);
            let (low, high) = (la.max(lb).max(lc), ha.min(hb).min(hc));
            medians[i] = middle(low, middle(ma, mb, mc), high);
        }
        *out = medians;
    }
}

/// Three values in order.
#[inline(always)]
fn sorted<T: Lane>(p: T, q: T, r: T) -> (T, T, T) {
    let (p, q) = (p.min(q), p.max(q));
    let (q, r) = (q.min(r), q.max(r));
    (p.min(q), p.max(q), r)
}

/// The second of three sorted values.
#[inline(always)]
fn middle<T: Lane>(a: T, b: T, c: T) -> T {
    a.min(b).max(a.max(b).min(c))
}

/// 1 where `|Gx| + |Gy| > level`.
///
/// It is the larger of `|Gx + Gy|` and `|Gx - Gy|`; both are twice a sum of three differences, which is
/// compared with half of the level.
#[inline(always)]
pub(crate) fn edge_hits<T: Lane>(window: Window<'_, T>, level: u32, out: &mut [Block<T>]) {
    let Ok(half) = T::Signed::try_from(level / 2) else {
        // No difference reaches it.
        return out.fill([T::default(); BLOCK]);
    };
    for (at, out) in out.iter_mut().enumerate() {
        let [nw, n, ne, w, _, e, sw, s, se] = blocks(&window, at);
        let mut hits = [T::default(); BLOCK];
        for i in 0..BLOCK {
            let (across, down) = (difference(e[i], w[i]), difference(s[i], n[i]));
            let falling = difference(se[i], nw[i]) + across + down;
            let rising = difference(ne[i], sw[i]) + across - down;
            let largest = falling.max(-falling).max(rising.max(-rising));
            hits[i] = T::hit(largest > half);
        }
        *out = hits;
    }
}

#[inline(always)]
fn difference<T: Lane>(a: T, b: T) -> T::Signed {
    T::Signed::from(a) - T::Signed::from(b)
}

/// 1 where five neighbors in a row are all brighter, or all darker, by more than `level`.
#[inline(always)]
pub(crate) fn corner_hits<T: Lane>(window: Window<'_, T>, level: T, out: &mut [Block<T>]) {
    for (at, out) in out.iter_mut().enumerate() {
        let [nw, n, ne, w, center, e, sw, s, se] = blocks(&window, at);
        let mut hits = [T::default(); BLOCK];
        for i in 0..BLOCK {
            let ring = [nw[i], n[i], ne[i], e[i], se[i], s[i], sw[i], w[i]];
            let bright = best_arc(ring, T::min, T::max) > center[i].plus(level);
            let dark = best_arc(ring, T::max, T::min) < center[i].minus(level);
            hits[i] = T::hit(bright | dark);
        }
        *out = hits;
    }
}
