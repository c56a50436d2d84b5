// SPDX-License-Identifier: MIT OR Apache-2.0
//! The streams to and from an external frame store by the rules of `docs/raster.md`, for all edges
//! of a frame at once.

use std::collections::BTreeMap;

use foveate_model::RasterOutput;

use super::driver::Trace;
use super::recipe::RasterRecipe;
use crate::oracle::{Image, Seen};

#[derive(Default)]
pub(crate) struct Streams {
    /// The edges that take a reference.
    taking: Vec<i64>,
    /// The words to store after each edge, each with true if it is the last of its row.
    stored: BTreeMap<i64, (Vec<i64>, bool)>,
    /// For every frame, a history in which the frame before has the pixels that the memory
    /// returned.
    given: Vec<Vec<Seen>>,
    /// The first edge that takes a reference that is not valid.
    underrun: Option<i64>,
}

impl Streams {
    /// Adds a frame whose word i comes to the tail at edge `tail(i)`, if it comes.
    pub(crate) fn frame(
        &mut self,
        recipe: &RasterRecipe,
        trace: &Trace,
        denoised: &Image,
        tail: impl Fn(i64) -> Option<i64>,
    ) {
        let is_first = self.given.is_empty() && !recipe.misread.always_takes;
        let mut given = denoised.clone();
        for word in 0..recipe.words() {
            let Some(edge) = tail(word) else { break };
            let (y, x) = (word / recipe.row(), word % recipe.row() * recipe.pixels);
            let place = |x: i64| (x as usize, y as usize);
            let pixels = (x..x + recipe.pixels).map(place);
            let due = pixels.clone().map(|(x, y)| denoised[y][x]).collect();
            let is_last = word % recipe.row() == recipe.row() - 1;
            self.stored.insert(edge + recipe.stored(), (due, is_last));
            let taken = edge + recipe.taking();
            if is_first || taken > trace.end() {
                continue;
            }
            self.taking.push(taken);
            let (valid, reference) = &trace.references[taken as usize];
            if !valid {
                self.underrun.get_or_insert(taken);
            }
            for ((x, y), &pixel) in pixels.zip(reference) {
                given[y][x] = pixel.into();
            }
        }
        let seen = |denoised| Seen {
            padded: Vec::new(),
            denoised,
            regions: Vec::new(),
            rendered: Vec::new(),
        };
        self.given.push(if is_first { Vec::new() } else { vec![seen(given)] });
    }

    /// Returns the history that a frame is compared with.
    pub(crate) fn history(&self, frame: usize) -> &[Seen] {
        &self.given[frame]
    }

    /// Compares the ports after an edge.
    pub(crate) fn compare(&self, edge: i64, end: i64, got: &RasterOutput) -> Result<(), String> {
        // Whether a reference is taken after the end of the trace is not known.
        let takes = self.taking.binary_search(&(edge + 1)).is_ok();
        if edge < end && got.reference_ready != takes {
            return Err(format!("reference_ready_o is {} after edge {edge}", got.reference_ready));
        }
        let underrun = self.underrun.is_some_and(|first| edge >= first);
        if got.underrun != underrun {
            return Err(format!("underrun_o is {} after edge {edge}", got.underrun));
        }
        let shown = got.store_valid.then(|| {
            let pixels: Vec<i64> = got.store_pixels.iter().map(|&pixel| pixel.into()).collect();
            (pixels, got.store_last)
        });
        if shown.as_ref() != self.stored.get(&edge) {
            let due = self.stored.get(&edge);
            return Err(format!("after edge {edge} {shown:?} is stored, due is {due:?}"));
        }
        Ok(())
    }
}
