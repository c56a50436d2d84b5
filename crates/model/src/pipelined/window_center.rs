// SPDX-License-Identifier: MIT OR Apache-2.0
//! The output of a window stage at a step: the window around a center, in all lanes at once.

use super::pixel::StagePixel;
use crate::stream::{BOTTOM, LEFT, RIGHT, TOP};
use crate::window::PixelWindow;

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
