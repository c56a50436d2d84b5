// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window stage: which place is written at an edge, and which nine places a center sees. The same
//! in every RPU, so that it is worked out once per clock; `docs/timing.md` has the rules.
//!
//! Pixels lie in a ring, in the order in which they come, frame after frame. It is as long as a window
//! reaches back: two rows and three pixels, as in the hardware.

use foveate_design::Neighborhood;
use foveate_lanes::{Block, Lane};

use crate::borders::Borders;
use crate::plan::Plan;
use crate::rows::Memory;

/// A center that is given at an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Center {
    /// Column and row in the square of the stage.
    at: (usize, usize),
    /// Where in the ring its frame begins.
    base: usize,
}

/// One window stage of every RPU.
#[derive(Clone, Debug)]
pub(crate) struct WindowStage<T: Lane> {
    side: usize,
    neighborhood: Neighborhood,
    scored: Memory<T>,
    /// What came in, where that leaves instead of what is scored.
    raw: Option<Memory<T>>,
    /// Places of the ring.
    places: usize,
    /// Where in the ring the frame begins whose pixels come in, and the one before it.
    base: usize,
    old_base: usize,
    /// Pixels of the frame that have been taken.
    position: usize,
    /// `isolated`: centers of the frame before that have not been given yet.
    owed: usize,
    /// The second of two `shared` windows: what it sees at the frame's border.
    borders: Option<Borders<T>>,
}

/// A pixel of every RPU on its way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pixels<'a, T: Lane> {
    pub(crate) scored: &'a [Block<T>],
    /// Where raw pixels are kept: what came in.
    pub(crate) raw: Option<&'a [Block<T>]>,
}

impl<T: Lane> WindowStage<T> {
    /// A window on a square of `side`; `carries_raw` where pixels have two values already.
    pub(crate) fn new(
        plan: &Plan,
        side: usize,
        carries_raw: bool,
        borders: Option<Borders<T>>,
    ) -> Self {
        let places = 2 * side + 3;
        Self {
            side,
            neighborhood: plan.neighborhood,
            scored: Memory::new(places, plan.lanes),
            raw: carries_raw.then(|| Memory::new(places, plan.lanes)),
            places,
            base: 0,
            old_base: 0,
            position: 0,
            owed: 0,
            borders,
        }
    }

    pub(crate) fn reset(&mut self) {
        self.position = 0;
        self.owed = 0;
    }

    /// One edge: takes a pixel, or none, and says which center is given.
    #[inline(always)]
    pub(crate) fn step(&mut self, pixels: Option<Pixels<'_, T>>) -> Option<Center> {
        match (self.neighborhood, pixels) {
            (Neighborhood::Isolated, Some(pixels)) => self.take_isolated(pixels),
            (Neighborhood::Isolated, None) if self.position == 0 => self.give_owed(),
            (Neighborhood::Shared, Some(pixels)) => self.take_shared(pixels),
            (_, None) => None,
        }
    }

    #[inline(always)]
    fn take_isolated(&mut self, pixels: Pixels<'_, T>) -> Option<Center> {
        let behind = self.side + 1;
        let taken = self.write(pixels);
        let own = || taken.checked_sub(behind).map(|place| self.center(place, self.base));
        let center = if self.owed > 0 { self.give_owed() } else { own() };
        if self.end_frame() {
            self.owed = behind;
        }
        center
    }

    fn give_owed(&mut self) -> Option<Center> {
        let place = (self.side * self.side).checked_sub(self.owed).filter(|_| self.owed > 0)?;
        self.owed -= 1;
        Some(self.center(place, self.old_base))
    }

    #[inline(always)]
    fn take_shared(&mut self, pixels: Pixels<'_, T>) -> Option<Center> {
        let taken = self.write(pixels);
        let (x, y) = (taken % self.side, taken / self.side);
        let center = (x >= 2 && y >= 2).then(|| Center { at: (x - 1, y - 1), base: self.base });
        self.end_frame();
        center
    }

    fn center(&self, place: usize, base: usize) -> Center {
        Center { at: (place % self.side, place / self.side), base }
    }

    /// Takes a pixel; returns its place in the frame.
    #[inline(always)]
    fn write(&mut self, pixels: Pixels<'_, T>) -> usize {
        let taken = self.position;
        let slot = (self.base + taken) % self.places;
        self.scored.row_mut(slot).copy_from_slice(pixels.scored);
        if let (Some(memory), Some(raw)) = (&mut self.raw, pixels.raw) {
            memory.row_mut(slot).copy_from_slice(raw);
        }
        self.position = taken + 1;
        taken
    }

    /// Whether that was the last pixel of the frame; then the next one begins.
    #[inline(always)]
    fn end_frame(&mut self) -> bool {
        let pixels = self.side * self.side;
        let ends = self.position == pixels;
        if ends {
            self.old_base = self.base;
            self.base = (self.base + pixels) % self.places;
            self.position = 0;
        }
        ends
    }

    fn slot(&self, center: Center, x: usize, y: usize) -> usize {
        (center.base + y * self.side + x) % self.places
    }

    /// The pixel at the center.
    pub(crate) fn pixels(&self, center: Center) -> Pixels<'_, T> {
        let slot = self.slot(center, center.at.0, center.at.1);
        Pixels { scored: self.scored.row(slot), raw: self.raw.as_ref().map(|raw| raw.row(slot)) }
    }

    /// The nine rows of lanes that a center's window shows, row by row. In an RPU at the frame's border
    /// some of them show other places than in its neighbors; those are put together first.
    #[inline(always)]
    pub(crate) fn window(&mut self, center: Center) -> [&[Block<T>]; 9] {
        let (x, y) = center.at;
        let last = self.side - 1;
        let columns = [x.saturating_sub(1), x, (x + 1).min(last)];
        let rows = [y.saturating_sub(1), y, (y + 1).min(last)];
        // One division; the neighbors lie less than a turn of the ring away.
        let (side, places) = (self.side, self.places);
        let here = self.slot(center, x, y) + places;
        let slot = |column: usize, row: usize| {
            let slot = here + row * side + column - y * side - x;
            let slot = if slot >= places { slot - places } else { slot };
            if slot >= places { slot - places } else { slot }
        };
        let scored = &self.scored;
        if let Some(borders) = &mut self.borders
            && (columns[0] == 0 || rows[0] == 0 || columns[2] == last || rows[2] == last)
        {
            return borders.window(|x, y| scored.row(slot(x, y)), last, columns, rows);
        }
        let line = |row: usize| {
            let [left, center, right] = columns;
            [
                scored.row(slot(left, row)),
                scored.row(slot(center, row)),
                scored.row(slot(right, row)),
            ]
        };
        let ([nw, n, ne], [w, c, e], [sw, s, se]) = (line(rows[0]), line(rows[1]), line(rows[2]));
        [nw, n, ne, w, c, e, sw, s, se]
    }
}
