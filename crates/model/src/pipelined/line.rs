// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registers in a row: what enters at an edge leaves a number of edges later.
//!
//! ```text
//! 2 registers       edge e    e+1    e+2
//! enters                 x      y      -
//! leaves                 -      -      x
//! ```

use std::collections::VecDeque;

/// The row; with no register what enters leaves at the same edge.
#[derive(Clone, Debug)]
pub(super) struct Line<T> {
    waiting: VecDeque<Option<T>>,
}

impl<T> Line<T> {
    pub(super) fn new(registers: usize) -> Self {
        Self { waiting: (0..registers).map(|_| None).collect() }
    }

    pub(super) fn reset(&mut self) {
        self.waiting.iter_mut().for_each(|register| *register = None);
    }

    /// One edge.
    pub(super) fn step(&mut self, entering: Option<T>) -> Option<T> {
        self.waiting.push_back(entering);
        self.waiting.pop_front().flatten()
    }
}
