// SPDX-License-Identifier: MIT OR Apache-2.0
//! The queue in front of a frame store outside of a core: it keeps the words that the core stores, and gives them
//! back in the frame after.

use foveate_design::PortRole;
use foveate_model::CycleModel;
use std::collections::VecDeque;

/// Words that were stored and not taken back, the oldest first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Queue(VecDeque<Vec<u16>>);

impl Queue {
    /// The word that the core should take next.
    pub(crate) fn oldest(&self) -> Option<&[u16]> {
        self.0.front().map(Vec::as_slice)
    }

    /// Its oldest word is gone.
    pub(crate) fn pop(&mut self) {
        self.0.pop_front();
    }

    /// After a reset it is empty.
    pub(crate) fn forget(&mut self) {
        self.0.clear();
    }

    /// Keeps the word that the core shows after an edge, if it shows one.
    pub(crate) fn keep(&mut self, after: &dyn CycleModel) {
        if after.is_high(PortRole::StoreValid) {
            let mut word = Vec::new();
            after.show(PortRole::StorePixel, &mut word);
            let pixel = |value| u16::try_from(value).expect("a pixel has at most 16 bits");
            self.0.push_back(word.into_iter().map(pixel).collect());
        }
    }
}
