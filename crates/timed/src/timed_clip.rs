// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocks of a clip: whole frames at their times in, rows of clocks out.

use foveate_design::Design;
use foveate_pixels::FramePixels;

use crate::{
    BeatOffer, ClockRow, FrameDelivery, FrameTraffic, SinkPattern, TimedError, TimedModel,
    TrafficMeter,
};

/// A design that takes the frames of a clip. Memory does not grow with their number.
#[derive(Debug)]
pub struct TimedClip {
    model: TimedModel,
    meter: TrafficMeter,
    clock_hz: Option<u64>,
}

impl TimedClip {
    /// Makes the core of the design in front of a sink. With a clock in Hz each frame comes at its
    /// time, or as soon as the core is ready after that. Without a clock each frame follows the one
    /// before without a pause.
    #[must_use]
    pub fn new(design: &Design, clock_hz: Option<u64>, sink: &SinkPattern) -> Self {
        Self {
            model: TimedModel::new(design, sink.sink()),
            meter: TrafficMeter::new(design),
            clock_hz,
        }
    }

    /// Takes the next frame, and yields the rows that are certain then, whatever follows. The rows
    /// of one event come in the order of their clocks. Returns an earlier frame whose latencies are
    /// certain then. With a clock, they count from the time of the frame; without one, from the
    /// first edge at which the core can take it.
    ///
    /// # Errors
    /// Fails if the pixels are not a frame of the design. The state is unchanged then.
    pub fn step(
        &mut self,
        pixels: FramePixels<'_>,
        time_us: u64,
        visit: &mut impl FnMut(&ClockRow),
    ) -> Result<Option<FrameTraffic>, TimedError> {
        let Self { model, meter, clock_hz } = self;
        let offer = clock_hz.map(|hz| BeatOffer { beat: 0, clock: clock_at(time_us, hz) });
        let delivery = FrameDelivery { offers: offer.as_slice(), ..FrameDelivery::whole(pixels) };
        model.check_delivery(&delivery)?;
        meter.begin_frame(offer.map_or(model.next_edge(), |offer| offer.clock));
        model.step(&delivery, &mut |transaction| {
            meter.add(transaction);
            ClockRow::visit_rows(transaction, &mut *visit);
        })?;
        Ok(meter.end_frame())
    }

    /// Yields the rows that still come if no other frame follows. Returns the frames that are left.
    pub fn finish(self, visit: &mut impl FnMut(&ClockRow)) -> impl Iterator<Item = FrameTraffic> {
        let Self { model, mut meter, .. } = self;
        model.finish(&mut |transaction| {
            meter.add(transaction);
            ClockRow::visit_rows(transaction, &mut *visit);
        });
        meter.finish()
    }
}

/// Returns the first edge of a clock at or after a time in microseconds.
fn clock_at(time_us: u64, hz: u64) -> u64 {
    let edge = (u128::from(time_us) * u128::from(hz)).div_ceil(1_000_000);
    // A clip of 2^62 edges does not exist.
    u64::try_from(edge).unwrap_or(u64::MAX).min(1 << 61)
}

#[cfg(test)]
mod tests {
    use super::clock_at;

    #[test]
    fn a_frame_comes_at_the_first_edge_that_is_not_before_its_time() {
        assert_eq!(clock_at(0, 100_000_000), 0);
        assert_eq!(clock_at(33_333, 100_000_000), 3_333_300);
        assert_eq!(clock_at(1, 1), 1);
        assert_eq!(clock_at(1_000_000, 3), 3);
    }
}
