// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cameras that are compared, and the times at which each gives its bits to the link.
//!
//! | sender | a unit | is given to the link |
//! | --- | --- | --- |
//! | raw | a row | when it has been read |
//! | pixel | the events of a row | when the row has been read |
//! | region by rows | the decisions and the sent values of a row of regions | when its decisions fall |
//! | region array | the decisions of a slot or of a row of regions; the pixels and means that are sent | when they leave the array |
//!
//! *By rows* means that every row of regions is an array of its own. It takes pixels as they are
//! read, and its pixels are available when the decision falls. *Array* is the generated `rcm`,
//! which may take a frame when all of it has been read, and send decisions and pixels slot by slot,
//! at the times of [`DepartureTiming`]. Or it is a [`RasterArray`], which takes pixels as they are
//! read, and sends one row of regions after the other: the decisions of a row when the last of them
//! falls, and the pixels when the last word is out. A decision has two bits, and is followed by the
//! displacement of its region if the design has `flow`.

use foveate_camera::RegionAction;
use foveate_design::{DepartureTiming, Design, Hardware, RasterTiming};
use foveate_pixels::FramePixels;
use foveate_simulator::PIXEL_EVENT_BYTES;

use super::raster_array::FrequencyClock;
use crate::link::{ArrayResults, LinkError, LinkUnit, RasterArray, Timeline};

/// The values that a region camera sends for one frame, and the events of a pixel camera.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SentCounts {
    /// The number of pixels and means that are sent for every row of regions.
    pub rows: Vec<u64>,
    /// The number of pixels and means that are sent for every slot; there is one slot if no regions
    /// share a unit.
    pub slots: Vec<u64>,
    /// The number of pixel events of every row.
    pub events: Vec<u64>,
}

impl SentCounts {
    /// Counts the values that are sent for regions with these actions.
    #[must_use]
    pub fn from_actions(design: &Design, actions: &[RegionAction], events: Vec<u64>) -> Self {
        let mut rows = vec![0; design.rows() as usize];
        let mut slots = vec![0; design.slots() as usize];
        for (region, &action) in (0..).zip(actions) {
            let values = design.values_sent(region, action);
            rows[(region / design.columns()) as usize] += values;
            slots[(region % design.slots()) as usize] += values;
        }
        Self { rows, slots, events }
    }
}

/// A function that takes the next frame of a clip.
pub type FrameTaker<'a> = dyn FnMut(FramePixels<'_>) -> Result<(), LinkError> + 'a;

/// The cameras over a clip.
#[derive(Debug)]
pub struct SenderCameras<'a> {
    design: &'a Design,
    timeline: &'a Timeline,
    departure: DepartureTiming,
    clock_hz: Option<u64>,
    /// True if the region camera by rows is one of the cameras.
    has_rows: bool,
}

impl<'a> SenderCameras<'a> {
    /// Creates cameras with an array at a clock of `clock_hz`. Without a clock the array takes no
    /// time, and [`ArrayResults::added_clocks`] is the number of clocks that are left out.
    ///
    /// # Errors
    /// Fails if the array is not done with a frame when the next one comes.
    pub fn new(
        clip: &str,
        design: &'a Design,
        timeline: &'a Timeline,
        clock_hz: Option<u64>,
    ) -> Result<Self, LinkError> {
        let has_rows = design.timing().departure().has_independent_units;
        Self::with_rows(clip, design, timeline, clock_hz, has_rows)
    }

    /// Creates the same cameras without the region camera by rows, which may need a faster clock
    /// than the generated array.
    ///
    /// # Errors
    /// Fails if the array is not done with a frame when the next one comes.
    pub fn without_rows(
        clip: &str,
        design: &'a Design,
        timeline: &'a Timeline,
        clock_hz: Option<u64>,
    ) -> Result<Self, LinkError> {
        Self::with_rows(clip, design, timeline, clock_hz, false)
    }

    fn with_rows(
        clip: &str,
        design: &'a Design,
        timeline: &'a Timeline,
        clock_hz: Option<u64>,
        has_rows: bool,
    ) -> Result<Self, LinkError> {
        let departure = design.timing().departure();
        let cameras = Self { design, timeline, departure, clock_hz, has_rows };
        let (needed_ns, interval_ns) =
            (cameras.clocks_to_ns(cameras.frame_clocks()), timeline.shortest_interval_ns());
        match clock_hz {
            Some(clock_hz) if needed_ns > interval_ns => {
                let clip = clip.to_owned();
                Err(LinkError::TooSlow { clip, interval_ns, needed_ns, clock_hz })
            }
            _ => Ok(cameras),
        }
    }

    /// Returns the most clocks that an array that takes whole frames, or that works by rows, adds
    /// to a time after the pixels that it waits for have been read.
    fn added_clocks(&self) -> u64 {
        let DepartureTiming { take_clocks, decision_clocks, forward_clocks, slot_clocks, .. } =
            self.departure;
        let last_slot = u64::from(self.design.slots() - 1) * slot_clocks;
        let array = take_clocks + decision_clocks.max(forward_clocks) + last_slot;
        let row = if self.has_rows { self.row_clocks(self.design.rows() - 1).1 } else { 0 };
        array.max(row)
    }

    /// Returns the slowest clock in Hz at which the array keeps up with the frames.
    #[must_use]
    pub fn needed_clock_hz(&self) -> u64 {
        let clocks = u128::from(self.frame_clocks()) * 1_000_000_000;
        let hertz = clocks.div_ceil(u128::from(self.timeline.shortest_interval_ns().max(1)));
        u64::try_from(hertz).unwrap_or(u64::MAX)
    }

    /// Returns the timing of a raster core, which takes pixels as they are read; `None` for other
    /// organizations.
    fn raster_timing(&self) -> Option<RasterTiming> {
        match self.design.hardware() {
            Hardware::Raster(own) => {
                Some(RasterTiming::from_design(self.design.with_hardware(own)))
            }
            Hardware::Pipelined(_) | Hardware::Serial(_) => None,
        }
    }

    /// Returns the most clocks of a frame, as a whole frame or row by row.
    fn frame_clocks(&self) -> u64 {
        if let Some(timing) = self.raster_timing() {
            return timing.max_clocks_per_frame();
        }
        let by_rows = match self.has_rows {
            true => u64::from(self.design.height()) * u64::from(self.design.stream_side()),
            false => 0,
        };
        self.design.timing().clocks_per_frame().max(by_rows)
    }

    /// Returns the units of a camera that sends every pixel of every frame.
    #[must_use]
    pub fn raw_units(&self) -> Vec<LinkUnit> {
        let bits = u64::from(self.design.width()) * u64::from(self.design.pixel_bits());
        self.rows_of_pixels(|_, _| bits)
    }

    /// Returns the units of a camera with pixel events.
    #[must_use]
    pub fn pixel_event_units(&self, sent: &[SentCounts]) -> Vec<LinkUnit> {
        let events = |frame: usize, row: usize| sent[frame].events[row] * 8 * PIXEL_EVENT_BYTES;
        self.rows_of_pixels(events)
    }

    /// Returns the units of the region camera by rows; `None` if it is not one of the cameras, as
    /// for an array whose units work in step.
    #[must_use]
    pub fn region_units_by_rows(&self, sent: &[SentCounts]) -> Option<Vec<LinkUnit>> {
        if !self.has_rows {
            return None;
        }
        let (size, rows) = (self.design.region_size(), self.design.rows());
        let map = self.design.bits_per_region() * u64::from(self.design.columns());
        let mut units = Vec::new();
        for (frame, sent) in (0..).zip(sent) {
            for (row, &pixels) in (0..rows).zip(&sent.rows) {
                let at = self.row_decision_ns(frame, row);
                units.push(LinkUnit {
                    frame,
                    read_ns: self.timeline.row_read_ns(frame, row * size),
                    decided_ns: at,
                    sent_ns: at,
                    bits: map + pixels * u64::from(self.design.pixel_bits()),
                });
            }
        }
        Some(units)
    }

    /// Returns a raster core in front of a link of so many bits per second, which takes pixels as
    /// they are read; `None` for other organizations.
    #[must_use]
    pub fn raster_array(&self, link_bits_per_second: u64) -> Option<RasterArray<'a>> {
        let timing = self.raster_timing()?;
        let clocks = (self.clock_hz, self.needed_clock_hz());
        let core = (self.design, timing);
        Some(RasterArray::new(core, self.timeline, clocks, link_bits_per_second))
    }

    /// Returns the results of the generated array in front of a link of so many bits per second.
    /// A raster core takes the frames once more, now that the times of all frames are known:
    /// `play` gives all of them to the function that it gets. Any other array needs only the values
    /// that it has `sent`.
    ///
    /// # Errors
    /// Fails as `play` does, or if its pixels are not frames of the design.
    pub fn array_results(
        &self,
        sent: &[SentCounts],
        link_bits_per_second: u64,
        play: impl FnOnce(&mut FrameTaker<'_>) -> Result<(), LinkError>,
    ) -> Result<ArrayResults, LinkError> {
        let Some(mut core) = self.raster_array(link_bits_per_second) else {
            return Ok(self.slot_array(sent));
        };
        play(&mut |pixels| core.step(pixels))?;
        Ok(core.finish())
    }

    /// Returns the results of an array that takes a frame when all of it has been read.
    #[must_use]
    pub fn slot_array(&self, sent: &[SentCounts]) -> ArrayResults {
        ArrayResults {
            units: self.units_by_slot(sent),
            added_clocks: self.added_clocks(),
            unbuffered: None,
        }
    }

    /// Returns the units of an array that takes a frame when all of it has been read.
    fn units_by_slot(&self, sent: &[SentCounts]) -> Vec<LinkUnit> {
        let (fold, regions) = (self.design.slots(), self.design.regions());
        let DepartureTiming { decision_frames, decision_clocks, .. } = self.departure;
        let DepartureTiming { forward_frames, forward_clocks, slot_clocks, .. } = self.departure;
        let mut units = Vec::new();
        for (frame, sent) in (0..).zip(sent) {
            let read = self.timeline.row_read_ns(frame, 0);
            for (slot, &pixels) in (0..fold).zip(&sent.slots) {
                let wait = u64::from(slot) * slot_clocks;
                let decided = self.departure_ns(frame, decision_frames, decision_clocks + wait);
                // The slot has the regions `slot`, `slot + fold`, `slot + 2 fold` and so on.
                let map =
                    self.design.bits_per_region() * u64::from((regions - slot).div_ceil(fold));
                units.push(LinkUnit {
                    frame,
                    read_ns: read,
                    decided_ns: decided,
                    sent_ns: decided,
                    bits: map,
                });
                let sent = self.departure_ns(frame, forward_frames, forward_clocks + wait);
                let bits = pixels * u64::from(self.design.pixel_bits());
                if bits > 0 {
                    units.push(LinkUnit {
                        frame,
                        read_ns: read,
                        decided_ns: decided,
                        sent_ns: sent,
                        bits,
                    });
                }
            }
        }
        units
    }

    /// Returns the units of an encoder that takes a frame when all of it has been read, and needs
    /// no time for it. Encoders that send a frame in slices would begin earlier.
    #[must_use]
    pub fn codec_units(&self, packets: &[u64]) -> Vec<LinkUnit> {
        let unit = |(frame, &bytes): (u64, &u64)| {
            let sent = self.timeline.start_ns(frame + 1);
            let read = self.timeline.row_read_ns(frame, 0);
            LinkUnit { frame, read_ns: read, decided_ns: sent, sent_ns: sent, bits: 8 * bytes }
        };
        (0..).zip(packets).map(unit).collect()
    }

    fn rows_of_pixels(&self, bits: impl Fn(usize, usize) -> u64) -> Vec<LinkUnit> {
        let mut units = Vec::new();
        for (frame, number) in (0..self.timeline.frames()).zip(0..) {
            for (row, place) in (0..self.design.height()).zip(0..) {
                let at = self.timeline.row_read_ns(frame, row);
                match bits(number, place) {
                    0 => {}
                    bits => units.push(LinkUnit {
                        frame,
                        read_ns: at,
                        decided_ns: at,
                        sent_ns: at,
                        bits,
                    }),
                }
            }
        }
        units
    }

    /// Returns the time in ns at which the decisions of a row of regions fall: its last row of
    /// pixels, or of their halo, has been read, the repeated rows below the frame have been taken,
    /// and the latency is over.
    fn row_decision_ns(&self, frame: u64, row: u32) -> u64 {
        let (last, clocks) = self.row_clocks(row);
        let frame = frame + u64::from(self.departure.decision_frames);
        self.timeline.row_read_ns(frame, last) + self.clocks_to_ns(clocks)
    }

    /// Returns the last row of pixels that a row of regions waits for, and the clocks from there to
    /// its decisions.
    fn row_clocks(&self, row: u32) -> (u32, u64) {
        let past = (row + 1) * self.design.region_size() + self.design.halo();
        let last = past.min(self.design.height()) - 1;
        let rows = u64::from(past - last);
        let clocks = rows * u64::from(self.design.stream_side()) + self.departure.decision_clocks;
        (last, clocks)
    }

    /// Returns the time in ns at which bits of a frame leave the array.
    fn departure_ns(&self, frame: u64, later: u32, clocks: u64) -> u64 {
        let read = self.timeline.start_ns(frame + u64::from(later) + 1);
        read + self.clocks_to_ns(self.departure.take_clocks + clocks)
    }

    /// Converts clocks to ns, rounded up; returns 0 without a clock.
    fn clocks_to_ns(&self, clocks: u64) -> u64 {
        self.clock_hz.map_or(0, |hertz| FrequencyClock { hertz }.time_ns(clocks))
    }
}
