// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of the clocks that a diagram shows: those around a change of a line.

use super::trace::{ClockStretch, PortTrace};
use std::collections::BTreeSet;

/// The number of shown changes of a line at the start and at the end; a line may change thousands
/// of times.
const SHOWN_CHANGES: usize = 2;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DiagramColumn {
    /// The clock that begins with this edge, in the stretch with this index.
    Clock { edge: u64, stretch: usize },
    /// A gap for clocks that are left out.
    Gap,
}

/// Returns the columns of a diagram: the last clock, the clocks before and after a frame begins or
/// a line changes, and gaps.
pub(super) fn columns(trace: &PortTrace) -> Vec<DiagramColumn> {
    let end = trace.stretches.last().map_or(0, |last| last.first_edge + last.clocks);
    let bits = (0..trace.signals.len()).filter(|&at| trace.signals[at].is_bit);
    let mut starts = trace.frame_edges.clone();
    starts.push(end);
    starts.extend(bits.flat_map(|at| change_edges(&trace.stretches, at)));
    // The clocks before, at and after a change are shown.
    let near = |start: u64| [start.checked_sub(1), Some(start), Some(start + 1)];
    let edges = starts.into_iter().flat_map(near).flatten().filter(|&edge| edge < end);
    let mut columns = Vec::new();
    let mut next = 0;
    for edge in edges.collect::<BTreeSet<_>>() {
        // A gap of one clock is as wide as the clock itself.
        if edge == next + 1 {
            columns.push(clock_column(trace, next));
        } else if edge > next {
            columns.push(DiagramColumn::Gap);
        }
        columns.push(clock_column(trace, edge));
        next = edge + 1;
    }
    columns
}

/// Returns the first and the last edges after which a signal changes.
fn change_edges(stretches: &[ClockStretch], signal: usize) -> Vec<u64> {
    let pairs = stretches.windows(2);
    let changed = pairs.filter(|pair| pair[0].values[signal] != pair[1].values[signal]);
    let mut edges: Vec<u64> = changed.map(|pair| pair[1].first_edge).collect();
    if edges.len() > 2 * SHOWN_CHANGES {
        edges.drain(SHOWN_CHANGES..edges.len() - SHOWN_CHANGES);
    }
    edges
}

fn clock_column(trace: &PortTrace, edge: u64) -> DiagramColumn {
    let behind = trace.stretches.partition_point(|stretch| stretch.first_edge <= edge);
    DiagramColumn::Clock { edge, stretch: behind - 1 }
}
