// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clock of a raster core: the edges that belong to times of a clip.

use foveate_design::RasterTiming;

/// The number of nanoseconds of a second.
const NS_PER_SECOND: u128 = 1_000_000_000;

/// A clock with a frequency. Edge 0 is at the start of the clip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrequencyClock {
    pub(crate) hertz: u64,
}

impl FrequencyClock {
    /// Returns the first edge from a time in ns on.
    pub(crate) fn edge(self, ns: u64) -> u64 {
        narrow((u128::from(ns) * u128::from(self.hertz)).div_ceil(NS_PER_SECOND))
    }

    /// Returns the time of an edge in ns, rounded up.
    pub(crate) fn time_ns(self, edge: u64) -> u64 {
        narrow((u128::from(edge) * NS_PER_SECOND).div_ceil(u128::from(self.hertz.max(1))))
    }
}

/// A clock with so many edges between two rows of pixels that a core has done all that it can do
/// with a row before the next one comes. So an edge says only which row the core has waited for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowClock {
    edges_per_row: u64,
    /// The number of rows of a frame.
    rows: u64,
}

impl RowClock {
    pub(crate) fn new(timing: RasterTiming) -> Self {
        // A row is read in the middle of its edges. Its words come before, and all that the core
        // does afterwards takes fewer clocks than two frames.
        Self { edges_per_row: 4 * timing.max_clocks_per_frame(), rows: timing.taken_rows.into() }
    }

    /// Returns the edge at which a row of a frame has been read.
    pub(crate) fn read_edge(self, frame: u64, row: u32) -> u64 {
        (frame * self.rows + u64::from(row)) * self.edges_per_row + self.edges_per_row / 2
    }

    /// Returns the row, with its frame, that the core has waited for before it does something at
    /// this edge.
    pub(crate) fn row(self, edge: u64) -> (u64, u32) {
        let row = edge / self.edges_per_row;
        let narrow = |row| u32::try_from(row).expect("a row has 32 bits");
        (row / self.rows, narrow(row % self.rows))
    }
}

fn narrow(value: u128) -> u64 {
    u64::try_from(value).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use foveate_design::DesignConfig;

    use super::*;

    fn raster_timing() -> RasterTiming {
        let toml = "hardware.organization = \"raster\"\nframe = { width = 40, height = 24 }";
        let design = DesignConfig::from_toml(toml).unwrap().validate().unwrap();
        RasterTiming::from_design(design.as_raster().unwrap())
    }

    #[test]
    fn a_core_is_done_with_a_row_before_the_next_one_comes() {
        let timing = raster_timing();
        let clock = RowClock::new(timing);
        let (words, clocks) = (u64::from(timing.taken_words), timing.max_clocks_per_frame());
        for (frame, row) in [(0, 0), (0, 23), (1, 0), (5, 7)] {
            let read = clock.read_edge(frame, row);
            for edge in [read - words, read, read + 2 * clocks - 1] {
                assert_eq!(clock.row(edge), (frame, row));
            }
        }
        let (last, next) = (clock.read_edge(0, 23), clock.read_edge(1, 0));
        assert!(last + 2 * clocks < next - words, "{last}, {next}");
    }

    #[test]
    fn an_edge_is_the_first_one_that_is_not_too_early() {
        let clock = FrequencyClock { hertz: 3 };
        // The edges are at 0, 333,333,333.3, 666,666,666.7 and 1,000,000,000 ns.
        let edges = [0, 1, 333_333_333, 333_333_334, 1_000_000_000].map(|ns| clock.edge(ns));
        assert_eq!(edges, [0, 1, 1, 2, 3]);
        assert_eq!(
            [0, 1, 2, 3].map(|e| clock.time_ns(e)),
            [0, 333_333_334, 666_666_667, 1_000_000_000]
        );
    }
}
