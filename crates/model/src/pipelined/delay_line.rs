// SPDX-License-Identifier: MIT OR Apache-2.0
//! A line of registers: a value that enters at an edge leaves a fixed number of edges later.
//!
//! ```text
//! 2 registers       edge e    e+1    e+2
//! enters                 x      y      -
//! leaves                 -      -      x
//! ```

use std::collections::VecDeque;

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
