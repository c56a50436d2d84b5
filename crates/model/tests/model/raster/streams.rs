// SPDX-License-Identifier: MIT OR Apache-2.0
//! The streams to and from an external frame store by the rules of `docs/raster.md`, for all edges
//! of a frame at once.

use std::collections::BTreeMap;

use foveate_model::RasterOutput;

use super::driver::RasterTrace;
use super::raster_parameters::RasterParameters;
use crate::oracle::{OracleFrame, OracleOutcome};

#[derive(Default)]
pub(crate) struct ExternalStoreStreams {
    /// The edges that take a reference.
    reference_edges: Vec<i64>,
    /// The words to store after each edge, each with true if it is the last of its row.
    store_words: BTreeMap<i64, (Vec<i64>, bool)>,
    /// For every frame, a history in which the frame before has the pixels that the memory
    /// returned.
    reference_histories: Vec<Vec<OracleOutcome>>,
    /// The first edge that takes a reference that is not valid.
    underrun: Option<i64>,
}

impl ExternalStoreStreams {
    /// Adds a frame whose word i comes to the tail at edge `tail(i)`, if it comes.
    pub(crate) fn add_frame(
        &mut self,
        recipe: &RasterParameters,
        trace: &RasterTrace,
        denoised: &OracleFrame,
        tail: impl Fn(i64) -> Option<i64>,
    ) {
        let is_first = self.reference_histories.is_empty();
        let mut given = denoised.clone();
        for word in 0..recipe.words() {
            let Some(edge) = tail(word) else { break };
            let (y, x) =
                (word / recipe.row_words(), word % recipe.row_words() * recipe.word_pixels);
            let place = |x: i64| (x as usize, y as usize);
            let pixels = (x..x + recipe.word_pixels).map(place);
            let due = pixels.clone().map(|(x, y)| denoised[y][x]).collect();
            let is_last = word % recipe.row_words() == recipe.row_words() - 1;
            self.store_words.insert(edge + recipe.store_latency(), (due, is_last));
            let taken = edge + recipe.reference_latency();
            if is_first || taken > trace.end() {
                continue;
            }
            self.reference_edges.push(taken);
            let (valid, reference) = &trace.references[taken as usize];
            if !valid {
                self.underrun.get_or_insert(taken);
            }
            for ((x, y), &pixel) in pixels.zip(reference) {
                given[y][x] = pixel.into();
            }
        }
        let outcome = OracleOutcome { denoised: given, ..OracleOutcome::default() };
        self.reference_histories.push(if is_first { Vec::new() } else { vec![outcome] });
    }

    /// Returns the history that a frame is compared with.
    pub(crate) fn history(&self, frame: usize) -> &[OracleOutcome] {
        &self.reference_histories[frame]
    }

    /// Compares the ports after an edge.
    pub(crate) fn compare(&self, edge: i64, end: i64, got: &RasterOutput) -> Result<(), String> {
        // The trace does not say if a reference is taken after its end.
        let takes = self.reference_edges.binary_search(&(edge + 1)).is_ok();
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
        if shown.as_ref() != self.store_words.get(&edge) {
            let due = self.store_words.get(&edge);
            return Err(format!("after edge {edge} {shown:?} is stored, due is {due:?}"));
        }
        Ok(())
    }
}
