// SPDX-License-Identifier: MIT OR Apache-2.0
//! The queue of an external frame store. It keeps the words that the core stores, and returns them
//! in the next frame.

use foveate_design::PortRole;
use foveate_model::CycleModel;
use std::collections::VecDeque;

/// The words that were stored and not yet returned, the oldest first.
#[derive(Clone, Debug, Default)]
pub(crate) struct StoreQueue(VecDeque<Vec<u16>>);

impl StoreQueue {
    /// Returns the word that the core should take next.
    pub(crate) fn oldest(&self) -> Option<&[u16]> {
        self.0.front().map(Vec::as_slice)
    }

    /// Removes the oldest word.
    pub(crate) fn pop(&mut self) {
        self.0.pop_front();
    }

    /// Removes all words, for a reset.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Stores the word that the core outputs after an edge, if there is one.
    pub(crate) fn store_output(&mut self, after: &dyn CycleModel) {
        if after.is_high(PortRole::StoreValid) {
            let mut word = Vec::new();
            after.append_output(PortRole::StorePixel, &mut word);
            let pixel = |value| u16::try_from(value).expect("a pixel has at most 16 bits");
            self.0.push_back(word.into_iter().map(pixel).collect());
        }
    }
}
