// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stages of an RPU in front of its tail: each takes a pixel of every lane at a step, and
//! gives what follows from the pixels around an earlier one, its center ([`WindowStage`]).
//!
//! A window stage of an isolated region ([`IsolatedWindow`]) takes n pixels and gives n
//! centers, N + 1 advances later.
//!
//! ```text
//! N = 2               one frame, silence        the next frame follows at once
//! edge                 0  1  2  3  4  5  6      0  1  2  3  4  5  6  7
//! pixel taken         a0 a1 a2 a3  -  -  -     a0 a1 a2 a3 b0 b1 b2 b3
//! center given         -  -  - a0 a1 a2 a3      -  -  - a0 a1 a2 a3 b0
//! position after       1  2  3  0  0  0  0      1  2  3  0  1  2  3  0
//! owed after           0  0  0  3  2  1  0      0  0  0  3  2  1  0  3
//! ```
//!
//! When the last pixel of a frame has come, N + 1 centers are *owed*. They leave one at every
//! edge (flush) until the next frame begins, and from then on one with every pixel. All have
//! left before pixel N + 1 of the next frame comes.
//!
//! A window stage of a shared region ([`SharedWindow`]) takes a square of side S and gives the
//! centers that have all their neighbors.
//!
//! ```text
//! S = 4                row 2                       row 3
//! pixel taken          (0,2) (1,2) (2,2) (3,2)     (0,3) (1,3) (2,3) (3,3)
//! center given           -     -   (1,1) (2,1)       -     -   (1,2) (2,2)
//! ```
//!
//! A center leaves at the edge that takes the pixel below and to the right of it, so there is
//! no flush.
//!
//! A value that enters a line of registers at an edge leaves a fixed number of edges later
//! ([`DelayLine`]).
//!
//! ```text
//! 2 registers       edge e    e+1    e+2
//! enters                 x      y      -
//! leaves                 -      -      x
//! ```
//!
//! The filter window has two registers, or three in a deep RPU ([`FilterStage`]).
//!
//! ```text
//! edge                          e         e+1        e+2
//! window steps                  x
//! first register (after)        x          -          -
//! last register (after)         -       denoised      -
//! next stage takes                                 denoised
//! ```
//!
//! The values between the registers cannot be observed, so the model computes the filter at
//! once.

use super::pixel::StagePixel;
use super::rpu_parameters::RpuParameters;
use crate::cycle_model::{BOTTOM, LEFT, RIGHT, TOP};
use crate::window::PixelWindow;
use crate::window_filter::filtered_pixel;
use foveate_camera::{DenoiseFilter, Neighborhood};
use std::collections::VecDeque;

/// A stage with a 3x3 window in every lane, which moves over the region of the lane.
#[derive(Clone, Debug)]
pub(super) enum WindowStage {
    Isolated(IsolatedWindow),
    Shared(SharedWindow),
}

impl WindowStage {
    /// Makes a window stage for a square of `side` pixels.
    pub(super) fn new(plan: &RpuParameters, side: usize) -> Self {
        match plan.neighborhood {
            Neighborhood::Isolated => Self::Isolated(IsolatedWindow::new(side)),
            Neighborhood::Shared => Self::Shared(SharedWindow::new(side)),
        }
    }

    /// Applies one edge. `pixels` has a pixel per lane. `borders` has, for each lane, the sides
    /// beyond which a shared window repeats pixels of its region, if there are any.
    pub(super) fn step<'a>(
        &'a mut self,
        pixels: Option<Vec<StagePixel>>,
        borders: Option<&'a [u8]>,
    ) -> Option<WindowCenters<'a>> {
        match self {
            Self::Isolated(window) => window.step(pixels),
            Self::Shared(window) => window.step(pixels, borders),
        }
    }

    pub(super) fn reset(&mut self) {
        match self {
            Self::Isolated(window) => window.reset(),
            Self::Shared(window) => window.reset(),
        }
    }
}

/// The window stage with all pixels of the current frame and of the frame before, in all lanes. The
/// hardware stores two rows, which is enough. Whole frames make the model easier to check.
#[derive(Clone, Debug)]
pub(super) struct IsolatedWindow {
    side: usize,
    /// The frame whose pixels are being taken: at each position, the pixels of all lanes.
    current: Vec<Vec<StagePixel>>,
    /// The frame that was taken before it.
    previous: Vec<Vec<StagePixel>>,
    /// Number of pixels of the current frame that have been taken, 0..n.
    position: usize,
    /// Number of centers of the previous frame that have not been given yet.
    owed: usize,
}

impl IsolatedWindow {
    pub(super) fn new(side: usize) -> Self {
        let frame = vec![Vec::new(); side * side];
        Self { side, current: frame.clone(), previous: frame, position: 0, owed: 0 }
    }

    pub(super) fn reset(&mut self) {
        self.position = 0;
        self.owed = 0;
    }

    /// Applies one edge. `pixels` has a pixel per lane.
    pub(super) fn step(&mut self, pixels: Option<Vec<StagePixel>>) -> Option<WindowCenters<'_>> {
        match pixels {
            Some(pixels) => self.take_pixels(pixels),
            // Between frames the stage flushes. Inside a frame it waits for pixels.
            None if self.position == 0 => {}
            None => return None,
        }
        let behind = self.side + 1;
        let (frame, place) = if self.owed > 0 {
            self.owed -= 1;
            (&self.previous, self.previous.len() - 1 - self.owed)
        } else {
            let last_taken = self.position.checked_sub(1)?;
            (&self.current, last_taken.checked_sub(behind)?)
        };
        let at = (place % self.side, place / self.side);
        Some(WindowCenters::at(frame, self.side, at, None))
    }

    fn take_pixels(&mut self, pixels: Vec<StagePixel>) {
        self.current[self.position] = pixels;
        self.position += 1;
        if self.position == self.current.len() {
            std::mem::swap(&mut self.current, &mut self.previous);
            self.position = 0;
            // The first of the owed centers is given at this edge.
            self.owed = self.side + 2;
        }
    }
}

/// The window stage with all pixels of the current square, in all lanes.
#[derive(Clone, Debug)]
pub(super) struct SharedWindow {
    side: usize,
    /// The pixels of all lanes at each position.
    square: Vec<Vec<StagePixel>>,
    /// Number of pixels of the square that have been taken.
    position: usize,
}

impl SharedWindow {
    pub(super) fn new(side: usize) -> Self {
        Self { side, square: vec![Vec::new(); side * side], position: 0 }
    }

    pub(super) fn reset(&mut self) {
        self.position = 0;
    }

    /// Applies one edge. `pixels` has a pixel per lane, and `borders` the sides of the frame that
    /// each lane touches, if windows must not use the halo there.
    pub(super) fn step<'a>(
        &'a mut self,
        pixels: Option<Vec<StagePixel>>,
        borders: Option<&'a [u8]>,
    ) -> Option<WindowCenters<'a>> {
        let taken = self.position;
        self.square[taken] = pixels?;
        self.position = (taken + 1) % self.square.len();
        let (right, below) = (taken % self.side, taken / self.side);
        let (x, y) = (right.checked_sub(1)?, below.checked_sub(1)?);
        if x == 0 || y == 0 {
            return None;
        }
        let sides = self.sides_with_halo(x, y);
        let hidden_halo =
            borders.filter(|_| sides != 0).map(|borders| HiddenHalo { sides, borders });
        Some(WindowCenters::at(&self.square, self.side, (x, y), hidden_halo))
    }

    /// Returns the sides at which a window sees the outermost pixels of the square, which are halo.
    fn sides_with_halo(&self, x: usize, y: usize) -> u8 {
        let last_inside = self.side - 2;
        [(x == 1, LEFT), (x == last_inside, RIGHT), (y == 1, TOP), (y == last_inside, BOTTOM)]
            .into_iter()
            .filter_map(|(sees_halo, side)| sees_halo.then_some(side))
            .sum()
    }
}

/// The windows of all lanes at a step. Their centers have the same position in every lane.
#[derive(Clone, Debug)]
pub(super) struct WindowCenters<'a> {
    /// The pixels of all lanes at each of the nine positions, row by row.
    rows: [[&'a [StagePixel]; 3]; 3],
    hidden_halo: Option<HiddenHalo<'a>>,
}

/// The halo that the windows of some lanes must not see.
#[derive(Clone, Copy, Debug)]
pub(super) struct HiddenHalo<'a> {
    /// The sides at which the windows reach into the halo.
    pub(super) sides: u8,
    /// The sides of the frame that each lane touches, beyond which its window sees no halo.
    pub(super) borders: &'a [u8],
}

impl<'a> WindowCenters<'a> {
    /// Makes the windows at column `x` and row `y` of a square of pixels of all lanes. Beyond the
    /// square they see its nearest pixel.
    pub(super) fn at(
        square: &'a [Vec<StagePixel>],
        side: usize,
        (x, y): (usize, usize),
        hidden_halo: Option<HiddenHalo<'a>>,
    ) -> Self {
        let around = |at: usize| [at.saturating_sub(1), at, (at + 1).min(side - 1)];
        let row = |y: usize| around(x).map(|x| square[y * side + x].as_slice());
        Self { rows: around(y).map(row), hidden_halo }
    }

    /// Computes a value of each lane from the center and the scored values of its window.
    pub(super) fn map<T>(&self, value: impl Fn(StagePixel, &PixelWindow) -> T) -> Vec<T> {
        let [above, here, below] = self.rows;
        let rows = triples(above).zip(triples(here)).zip(triples(below));
        let windows = rows.map(|((above, here), below)| {
            let scored = |place: usize| [above, here, below][place / 3][place % 3].scored;
            (here[1], std::array::from_fn(scored))
        });
        match self.hidden_halo {
            None => windows.map(|(center, window)| value(center, &window)).collect(),
            Some(HiddenHalo { sides, borders }) => windows
                .zip(borders)
                .map(|((center, window), border)| {
                    value(center, &without_sides(&window, sides & border))
                })
                .collect(),
        }
    }
}

/// Returns the three pixels of every lane.
fn triples([left, middle, right]: [&[StagePixel]; 3]) -> impl Iterator<Item = [StagePixel; 3]> {
    left.iter().zip(middle).zip(right).map(|((&left, &middle), &right)| [left, middle, right])
}

/// Replaces the pixels at some sides of a window by their neighbors in the middle.
fn without_sides(window: &PixelWindow, sides: u8) -> PixelWindow {
    let has = |side: u8| sides & side != 0;
    std::array::from_fn(|place| {
        let row = match place / 3 {
            0 if has(TOP) => 1,
            2 if has(BOTTOM) => 1,
            row => row,
        };
        let column = match place % 3 {
            0 if has(LEFT) => 1,
            2 if has(RIGHT) => 1,
            column => column,
        };
        window[row * 3 + column]
    })
}

/// A line of registers. Without registers a value leaves at the edge at which it enters.
#[derive(Clone, Debug)]
pub(super) struct DelayLine<T> {
    registers: VecDeque<Option<T>>,
}

impl<T> DelayLine<T> {
    pub(super) fn new(registers: usize) -> Self {
        Self { registers: (0..registers).map(|_| None).collect() }
    }

    pub(super) fn reset(&mut self) {
        self.registers.iter_mut().for_each(|register| *register = None);
    }

    /// Applies one edge: takes the entering value and returns the leaving one.
    pub(super) fn step(&mut self, entering: Option<T>) -> Option<T> {
        self.registers.push_back(entering);
        self.registers.pop_front().flatten()
    }
}

/// The stage that takes raw pixels and gives denoised pixels, one per lane.
#[derive(Clone, Debug)]
pub(super) struct FilterStage {
    filter: DenoiseFilter,
    window: WindowStage,
    results: DelayLine<Vec<StagePixel>>,
}

impl FilterStage {
    pub(super) fn new(plan: &RpuParameters) -> Self {
        Self {
            filter: plan.filter,
            window: WindowStage::new(plan, plan.stream_side),
            results: DelayLine::new(plan.filter_registers),
        }
    }

    pub(super) fn reset(&mut self) {
        self.window.reset();
        self.results.reset();
    }

    /// Applies one edge, and returns the pixels that the next stage takes at this edge.
    pub(super) fn step(&mut self, pixels: Option<Vec<StagePixel>>) -> Option<Vec<StagePixel>> {
        // The raw halo of a shared region already repeats the border of the frame.
        let centers = self.window.step(pixels, None);
        let filter = self.filter;
        let denoised = |center: StagePixel, window: &PixelWindow| StagePixel {
            scored: filtered_pixel(filter, window),
            raw: center.raw,
        };
        self.results.step(centers.map(|centers| centers.map(denoised)))
    }
}
