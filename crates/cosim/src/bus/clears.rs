// SPDX-License-Identifier: MIT OR Apache-2.0
//! Events that happen while they are cleared at every possible clock. `docs/axi.md` says that such
//! an event stays 1.
//!
//! A write is taken at every other clock. So each event is tried twice, at clocks of both parities,
//! and meets a write in one of the two attempts.

use super::film::largest;
use super::scenes::{Stage, taken};
use super::traffic::{Fate, Raised, Sent, Traffic};
use crate::situations::{can_drop_regions, can_drop_rows};
use foveate_frame::Frame;

/// The number of attempts for each event, one for each parity of the clock.
const ATTEMPTS: u32 = 2;

impl<'a> Stage<'a> {
    /// Returns the traffic of the scene: every event, each in a session of its own.
    pub(super) fn clears(&mut self) -> Traffic<'a> {
        let mut traffic = Traffic::new(self.design());
        self.lines(&mut traffic, "eol_early", Self::short_line);
        self.lines(&mut traffic, "eol_late", Self::long_line);
        self.early_frames(&mut traffic);
        self.late_words(&mut traffic);
        self.skipped_frames(&mut traffic);
        if can_drop_regions(self.design()) {
            self.stopped_sinks(&mut traffic, "region_dropped", Raised::DroppedRegions);
        }
        if can_drop_rows(self.design()) {
            self.stopped_sinks(&mut traffic, "row_dropped", Raised::DroppedRows);
        }
        self.ends(&mut traffic);
        traffic
    }

    /// Resets the core, enables one event and clears it again and again from then on. With `waits`
    /// the source waits for a free core; otherwise frames are skipped.
    fn begin_clearing(&mut self, traffic: &mut Traffic<'a>, event: &str, waits: bool) {
        let bit = self.event(event);
        traffic.reset();
        traffic.may_drop();
        traffic.stalls(0);
        traffic.gaps(0);
        let control: &[&str] = if waits { &["enable", "wait"] } else { &["enable"] };
        traffic.write(self.address("control"), self.control_bits(control));
        traffic.write(self.address("interrupt_enable"), bit);
        traffic.clear(self.address("events"), bit);
    }

    /// Waits until all packets have left, and expects that the event was seen as often as `raised`
    /// says.
    fn end_clearing(&mut self, traffic: &mut Traffic<'a>, event: &'static str, raised: Raised) {
        traffic.drain();
        traffic.count_raised(event, raised);
        traffic.interrupt(false);
    }

    /// Sends a frame with damage in every line.
    fn lines(
        &mut self,
        traffic: &mut Traffic<'a>,
        event: &'static str,
        line: fn(&mut Traffic<'a>, &mut Frame, u32),
    ) {
        self.begin_clearing(traffic, event, true);
        let height = self.design().height();
        let mut frame = self.film().quiet();
        for y in 0..height {
            self.align(traffic, y);
            line(traffic, &mut frame, y);
        }
        traffic.expect(taken(frame));
        self.end_clearing(traffic, event, Raised::Times(height));
    }

    /// Sends a line without its last transfer; the core repeats the last pixel that came.
    fn short_line(traffic: &mut Traffic<'a>, frame: &mut Frame, y: u32) {
        let row = frame.row(y).to_vec();
        let words: Vec<&[u16]> = traffic.split(&row).collect();
        let kept = &words[..words.len() - 1];
        for (at, pixels) in kept.iter().enumerate() {
            traffic.beat(at == 0 && y == 0, at == kept.len() - 1, pixels);
        }
        let mut line = kept.concat();
        let last = line.last().copied().unwrap_or_default();
        line.resize(row.len(), last);
        frame.write(0, y, &line);
    }

    /// Sends a line with one transfer too many.
    fn long_line(traffic: &mut Traffic<'a>, frame: &mut Frame, y: u32) {
        let row = frame.row(y).to_vec();
        let words: Vec<Vec<u16>> = traffic.split(&row).map(<[u16]>::to_vec).collect();
        for (at, pixels) in words.iter().enumerate() {
            traffic.beat(at == 0 && y == 0, false, pixels);
        }
        traffic.beat(false, true, &words[0]);
    }

    /// Sends frames that end after their first line, because the next frame begins.
    fn early_frames(&mut self, traffic: &mut Traffic<'a>) {
        self.begin_clearing(traffic, "sof_early", true);
        let height = self.design().height();
        for parity in 0..ATTEMPTS {
            let mut frame = self.film().quiet();
            let words = traffic.words();
            let first = frame.row(0).to_vec();
            for (at, pixels) in traffic.split(&first).enumerate() {
                traffic.beat(at == 0, at == words - 1, pixels);
            }
            (1..height).for_each(|y| frame.write(0, y, &first));
            traffic.expect(taken(frame));
            self.align(traffic, parity);
        }
        traffic.frame(taken(self.film().quiet()));
        self.end_clearing(traffic, "sof_early", Raised::Times(ATTEMPTS));
    }

    /// Sends transfers behind a whole frame.
    fn late_words(&mut self, traffic: &mut Traffic<'a>) {
        self.begin_clearing(traffic, "sof_late", true);
        for parity in 0..ATTEMPTS {
            traffic.frame(taken(self.film().quiet()));
            traffic.drain();
            self.align(traffic, parity);
            self.nothing(traffic, false);
        }
        self.end_clearing(traffic, "sof_late", Raised::Times(ATTEMPTS));
    }

    /// Sends frames while packets wait for the sink. The first transfer of each frame is enough.
    fn skipped_frames(&mut self, traffic: &mut Traffic<'a>) {
        self.begin_clearing(traffic, "frame_skipped", false);
        traffic.hold(2 * self.design().timing().clocks_per_frame() + 2000);
        traffic.frame(taken(self.film().quiet()));
        traffic.clocks(self.design().timing().clocks_per_frame() / 2 + 500);
        for parity in 0..ATTEMPTS {
            self.align(traffic, parity);
            self.nothing(traffic, true);
            let frame = self.film().quiet();
            traffic.expect(Sent { fate: Fate::Skipped, ..taken(frame) });
        }
        self.end_clearing(traffic, "frame_skipped", Raised::Skipped);
    }

    /// Stops the sink from the last line of the first row of regions until the next frame is decided. The FRAME packet has
    /// left by then, so the next frame begins while all rows of this one wait.
    fn stopped_sinks(&mut self, traffic: &mut Traffic<'a>, event: &'static str, raised: Raised) {
        self.begin_clearing(traffic, event, true);
        let hold = 4 * self.design().timing().clocks_per_frame() + 2000;
        let line = self.design().region_size() - 1;
        // All attempts send the same frames, so they differ in the parity of the clock alone.
        let [first, second] = [self.film().noise(), self.film().noise()];
        for parity in 0..ATTEMPTS {
            self.align(traffic, parity);
            traffic.frame_around(taken(first.clone()), line, |traffic| traffic.hold(hold));
            traffic.frame(taken(second.clone()));
            traffic.drain();
        }
        self.end_clearing(traffic, event, raised);
    }

    /// Stops the sink from the last transfer of a frame until all packets wait. The END packet then
    /// leaves a fixed number of clocks after the sink goes on.
    fn ends(&mut self, traffic: &mut Traffic<'a>) {
        self.begin_clearing(traffic, "frame_done", true);
        // All attempts send the same frame, so the same packets wait.
        let frame = self.film().quiet();
        traffic.frame(taken(frame.clone()));
        for parity in 0..ATTEMPTS {
            traffic.drain();
            traffic.frame(taken(frame.clone()));
            traffic.hold(u64::from(u32::MAX));
            traffic.clocks(traffic.drain_clocks());
            self.align(traffic, parity);
            traffic.hold(0);
            traffic.drain();
        }
        self.end_clearing(traffic, "frame_done", Raised::Times(ATTEMPTS + 1));
    }

    /// Waits until the effects of the earlier traffic have ended, and then for a clock of this
    /// parity.
    fn align(&self, traffic: &mut Traffic<'a>, parity: u32) {
        traffic.clocks(u64::from(2 * self.design().region_size()) + 8);
        traffic.align(parity);
    }

    /// Sends a transfer that belongs to no whole frame; `sof` marks it as the first of a frame.
    fn nothing(&mut self, traffic: &mut Traffic<'a>, sof: bool) {
        let (design, most) = (self.design(), largest(self.design().pixel_bits()));
        let pixels = vec![most; design.pixels_per_clock() as usize];
        traffic.beat(sof, false, &pixels);
    }
}
