// SPDX-License-Identifier: MIT OR Apache-2.0
//! A raster core between the sensor and the link, over a clip ([`RasterArray`]).
//!
//! Three timed models of the core take the frames beside each other. Two of them have a sink
//! that takes a word at every clock, as the buffer in front of the link does: one at the clock
//! of the core ([`FrequencyClock`]), and one at a clock so fast that the core takes no time
//! ([`RowClock`]). So the clocks of the core can be counted, or left out. The third model has
//! the link itself as its sink.

use super::queue::link_sink;
use super::report::RowRecord;
use crate::link::{ArrayResults, LinkError, LinkUnit, Timeline, UnbufferedFigures};
use foveate_design::{Design, RasterTiming};
use foveate_pixels::FramePixels;
use foveate_timed::{BeatOffer, FrameDelivery, RowSensor, SinkPattern, TimedError, TimedModel};

/// A raster core that takes the frames of a clip.
#[derive(Debug)]
pub struct RasterArray<'a> {
    design: &'a Design,
    sensor: RowSensor,
    times: EventTimes<'a>,
    clocked: RecordedModel<'a>,
    instant: RecordedModel<'a>,
    unbuffered: RecordedModel<'a>,
    /// The sink of `unbuffered`.
    link: SinkPattern,
    frame: u64,
}

impl<'a> RasterArray<'a> {
    /// Makes a core with a clock of `clock_hz`, or without one with the slowest clock that keeps
    /// up, which is `needed_clock_hz`.
    pub(crate) fn new(
        (design, timing): (&'a Design, RasterTiming),
        timeline: &'a Timeline,
        (clock_hz, needed_clock_hz): (Option<u64>, u64),
        link_bits_per_second: u64,
    ) -> Self {
        let hertz = clock_hz.unwrap_or(needed_clock_hz);
        let word_bits = timing.word_pixels * design.pixel_bits();
        let link = link_sink(link_bits_per_second, word_bits, hertz);
        Self {
            design,
            sensor: RowSensor::new(design),
            times: EventTimes {
                timeline,
                clock: FrequencyClock { hertz },
                row_clock: RowClock::new(timing),
                has_clock: clock_hz.is_some(),
            },
            clocked: RecordedModel::new(design, &SinkPattern::Always),
            instant: RecordedModel::new(design, &SinkPattern::Always),
            unbuffered: RecordedModel::new(design, &link),
            link,
            frame: 0,
        }
    }

    /// Takes the next frame of the clip.
    ///
    /// # Errors
    /// Fails if the pixels are not a frame of the design.
    pub fn step(&mut self, pixels: FramePixels<'_>) -> Result<(), LinkError> {
        let (times, frame) = (&self.times, self.frame);
        let offers = self.sensor.frame_offers(|row| times.read_edge(frame, row));
        let instant_offers = self.sensor.frame_offers(|row| times.row_clock.read_edge(frame, row));
        self.clocked.step(pixels, &offers)?;
        self.unbuffered.step(pixels, &offers)?;
        self.instant.step(pixels, &instant_offers)?;
        self.frame += 1;
        Ok(())
    }

    /// Returns the results of all frames.
    #[must_use]
    pub fn finish(self) -> ArrayResults {
        let Self { design, times, .. } = self;
        let (clocked, instant) = (self.clocked.finish(), self.instant.finish());
        let (mut units, mut added_clocks) = (Vec::new(), 0);
        let map = design.bits_per_region() * u64::from(design.columns());
        for ((place, clocked), (_, instant)) in clocked.outputs().zip(instant.outputs()) {
            let read_ns = times.timeline.row_read_ns(place.0, place.1 * design.region_size());
            let unit = |decided_ns, sent_ns, bits| LinkUnit {
                frame: place.0,
                read_ns,
                decided_ns,
                sent_ns,
                bits,
            };
            let decision = (clocked.last_decision, instant.last_decision);
            let decided = times.event_ns(decision);
            added_clocks = times.added_clocks(decision).max(added_clocks);
            units.push(unit(decided, decided, map));
            if let Some(word) = clocked.last_word.zip(instant.last_word) {
                let sent = times.event_ns(word);
                added_clocks = times.added_clocks(word).max(added_clocks);
                let bits = clocked.values * u64::from(design.pixel_bits());
                // The pixels may be out before the last decision of the row, if the last decisions
                // send no pixels.
                units.push(unit(decided.min(sent), sent, bits));
            }
        }
        let unbuffered = unbuffered_figures(self.unbuffered.finish(), &times, &self.link);
        ArrayResults { units, added_clocks, unbuffered: Some(unbuffered) }
    }
}

/// Returns the figures of the model whose sink is the link.
fn unbuffered_figures(
    record: RowRecord<'_>,
    times: &EventTimes<'_>,
    link: &SinkPattern,
) -> UnbufferedFigures {
    let mut link = link.sink();
    let waits = record.outputs().filter_map(|((frame, row), output)| {
        let taken = link.next_ready(output.last_word? + 1);
        let read = times.timeline.row_read_ns(frame, row * record.design.region_size());
        Some(times.clock.time_ns(taken) - read)
    });
    UnbufferedFigures {
        clock_hz: times.clock.hertz,
        last_word_ns: waits.max().unwrap_or(0),
        lost_regions: record.lost_regions,
        frames_with_losses: record.frames_with_losses,
    }
}

/// The times of events in the core. An event is given by its edges in the model with a clock and in
/// the model that takes no time.
#[derive(Debug)]
struct EventTimes<'a> {
    timeline: &'a Timeline,
    clock: FrequencyClock,
    row_clock: RowClock,
    /// True if the user has given the clock. Otherwise times leave out the clocks of the core.
    has_clock: bool,
}

impl EventTimes<'_> {
    /// Returns the edge at which a row of a frame has been read.
    fn read_edge(&self, frame: u64, row: u32) -> u64 {
        self.clock.edge(self.timeline.row_read_ns(frame, row))
    }

    fn event_ns(&self, (edge, instant_edge): (u64, u64)) -> u64 {
        if self.has_clock {
            return self.clock.time_ns(edge);
        }
        let (frame, row) = self.row_clock.row(instant_edge);
        self.timeline.row_read_ns(frame, row)
    }

    /// Returns the clocks from reading the row that an event waits for to the event.
    fn added_clocks(&self, (edge, instant_edge): (u64, u64)) -> u64 {
        let (frame, row) = self.row_clock.row(instant_edge);
        // The event comes earlier if it waits only for the first words of the row.
        edge.saturating_sub(self.read_edge(frame, row))
    }
}

/// A timed model with a record of its output.
#[derive(Debug)]
struct RecordedModel<'a> {
    model: TimedModel,
    record: RowRecord<'a>,
}

impl<'a> RecordedModel<'a> {
    fn new(design: &'a Design, sink: &SinkPattern) -> Self {
        Self { model: TimedModel::new(design, sink.sink()), record: RowRecord::new(design) }
    }

    fn step(&mut self, pixels: FramePixels<'_>, offers: &[BeatOffer]) -> Result<(), TimedError> {
        let Self { model, record } = self;
        let delivery = FrameDelivery { offers, ..FrameDelivery::whole(pixels) };
        model.step(&delivery, &mut |transaction| record.add(transaction))
    }

    fn finish(self) -> RowRecord<'a> {
        let Self { model, mut record } = self;
        model.finish(&mut |transaction| record.add(transaction));
        record
    }
}

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
    use super::*;
    use foveate_design::DesignConfig;

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
