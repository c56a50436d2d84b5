// SPDX-License-Identifier: MIT OR Apache-2.0
//! Events that happen while they are cleared at every possible clock. `docs/axi.md` says that such
//! an event stays 1.
//!
//! A write is taken at every other clock. So each event is tried twice, at clocks of both parities,
//! and meets a write in one of the two attempts.

use super::frame_source::send_first_words;
use super::scenes::{SceneBuilder, taken_frame};
use super::traffic::{ExpectedEventCount, ExpectedFrame, FrameFate, Traffic};
use crate::situations::{can_drop_regions, can_drop_rows};
use foveate_pixels::Frame;

/// The number of attempts for each event, one for each parity of the clock.
const ATTEMPTS_PER_EVENT: u32 = 2;
/// The number of clocks by which a core on a bus may decide later than its array alone.
const DECISION_MARGIN: u64 = 500;

impl<'a> SceneBuilder<'a> {
    /// Returns the traffic of the scene: every event, each in a session of its own.
    pub(super) fn event_clears(&mut self) -> Traffic<'a> {
        let mut traffic = Traffic::new(self.design());
        self.damage_every_line(&mut traffic, "eol_early", Self::short_line);
        self.damage_every_line(&mut traffic, "eol_late", Self::long_line);
        self.early_frames(&mut traffic);
        self.late_words(&mut traffic);
        self.skipped_frames(&mut traffic);
        if can_drop_regions(self.design()) {
            self.stopped_sinks(&mut traffic, "region_dropped", ExpectedEventCount::DroppedRegions);
        }
        if can_drop_rows(self.design()) {
            self.stopped_sinks(&mut traffic, "row_dropped", ExpectedEventCount::DroppedRows);
        }
        self.delay_ends(&mut traffic);
        traffic
    }

    /// Resets the core, enables one event and clears it again and again from then on. With `waits`
    /// the source waits for a free core; otherwise frames are skipped.
    fn begin_clearing(&mut self, traffic: &mut Traffic<'a>, event: &str, waits: bool) {
        let bit = self.event_mask(event);
        traffic.reset();
        traffic.allow_drops();
        traffic.set_stalls(0);
        traffic.set_gaps(0);
        let control: &[&str] = if waits { &["enable", "wait"] } else { &["enable"] };
        traffic.write(self.address("control"), self.control_bits(control));
        traffic.write(self.address("interrupt_enable"), bit);
        traffic.clear_repeatedly(self.address("events"), bit);
    }

    /// Waits until all packets have left, and expects that the event was seen as often as `raised`
    /// says.
    fn end_clearing(
        &mut self,
        traffic: &mut Traffic<'a>,
        event: &'static str,
        raised: ExpectedEventCount,
    ) {
        traffic.drain();
        traffic.expect_event_count(event, raised);
        traffic.expect_interrupt(false);
    }

    /// Sends frames with damage in every line. The first line of a frame takes a clock more than
    /// the others, so two lines of the same place in their frames show both parities.
    fn damage_every_line(
        &mut self,
        traffic: &mut Traffic<'a>,
        event: &'static str,
        line: fn(&mut Traffic<'a>, &mut Frame, u32),
    ) {
        self.begin_clearing(traffic, event, true);
        let height = self.design().height();
        for parity in 0..ATTEMPTS_PER_EVENT {
            // A frame that follows at once waits until this one is decided.
            traffic.drain();
            let mut frame = self.frame_source().quiet_frame();
            for y in 0..height {
                self.align_traffic(traffic, parity);
                line(traffic, &mut frame, y);
            }
            traffic.expect_frame(taken_frame(frame));
        }
        self.end_clearing(traffic, event, ExpectedEventCount::Exactly(ATTEMPTS_PER_EVENT * height));
    }

    /// Sends a line without its last transfer; the core repeats the last pixel that came.
    fn short_line(traffic: &mut Traffic<'a>, frame: &mut Frame, y: u32) {
        let row = frame.row(y).to_vec();
        let words: Vec<&[u16]> = traffic.split_line(&row).collect();
        let kept = &words[..words.len() - 1];
        for (at, pixels) in kept.iter().enumerate() {
            traffic.send_beat(at == 0 && y == 0, at == kept.len() - 1, pixels);
        }
        let mut line = kept.concat();
        let last = line.last().copied().unwrap_or_default();
        line.resize(row.len(), last);
        frame.write_row(0, y, &line);
    }

    /// Sends a line with one transfer too many.
    fn long_line(traffic: &mut Traffic<'a>, frame: &mut Frame, y: u32) {
        let row = frame.row(y).to_vec();
        let words: Vec<Vec<u16>> = traffic.split_line(&row).map(<[u16]>::to_vec).collect();
        for (at, pixels) in words.iter().enumerate() {
            traffic.send_beat(at == 0 && y == 0, false, pixels);
        }
        traffic.send_beat(false, true, &words[0]);
    }

    /// Sends frames that end after their first line, or within a single line, because the next
    /// frame begins.
    fn early_frames(&mut self, traffic: &mut Traffic<'a>) {
        self.begin_clearing(traffic, "sof_early", true);
        let height = self.design().height();
        for parity in 0..ATTEMPTS_PER_EVENT {
            let mut frame = self.frame_source().quiet_frame();
            let words = traffic.words_per_line() - usize::from(height == 1);
            let row = frame.row(0).to_vec();
            let first = send_first_words(traffic, words, &row, (true, height > 1));
            (0..height).for_each(|y| frame.write_row(0, y, &first));
            traffic.expect_frame(taken_frame(frame));
            self.align_traffic(traffic, parity);
        }
        traffic.send_frame(taken_frame(self.frame_source().quiet_frame()));
        self.end_clearing(traffic, "sof_early", ExpectedEventCount::Exactly(ATTEMPTS_PER_EVENT));
    }

    /// Sends transfers behind a whole frame.
    fn late_words(&mut self, traffic: &mut Traffic<'a>) {
        self.begin_clearing(traffic, "sof_late", true);
        for parity in 0..ATTEMPTS_PER_EVENT {
            traffic.send_frame(taken_frame(self.frame_source().quiet_frame()));
            traffic.drain();
            self.align_traffic(traffic, parity);
            self.stray_transfer(traffic, false);
        }
        self.end_clearing(traffic, "sof_late", ExpectedEventCount::Exactly(ATTEMPTS_PER_EVENT));
    }

    /// Sends frames while packets wait for the sink. The first transfer of each frame is enough.
    fn skipped_frames(&mut self, traffic: &mut Traffic<'a>) {
        self.begin_clearing(traffic, "frame_skipped", false);
        traffic.hold_sink(u64::from(u32::MAX));
        traffic.send_frame(taken_frame(self.frame_source().quiet_frame()));
        // A frame that comes before this one is decided waits, and is then skipped at any clock.
        traffic.wait_clocks(self.design().timing().departure().decision_clocks + DECISION_MARGIN);
        for parity in 0..ATTEMPTS_PER_EVENT {
            self.align_traffic(traffic, parity);
            self.stray_transfer(traffic, true);
            let frame = self.frame_source().quiet_frame();
            traffic.expect_frame(ExpectedFrame { fate: FrameFate::Skipped, ..taken_frame(frame) });
        }
        traffic.hold_sink(0);
        self.end_clearing(traffic, "frame_skipped", ExpectedEventCount::SkippedFrames);
    }

    /// Stops the sink from the last line of the first row of regions to the end of the next frame.
    /// The FRAME packet has left by then, so the next frame begins while all rows of this one wait.
    fn stopped_sinks(
        &mut self,
        traffic: &mut Traffic<'a>,
        event: &'static str,
        raised: ExpectedEventCount,
    ) {
        self.begin_clearing(traffic, event, true);
        let hold = 2 * self.design().timing().clocks_per_frame();
        let line = self.design().region_size() - 1;
        // All attempts send the same frames, so they differ in the parity of the clock alone.
        let [first, second] = self.frame_source().active_frames();
        for parity in 0..ATTEMPTS_PER_EVENT {
            self.align_traffic(traffic, parity);
            traffic.send_frame_around(taken_frame(first.clone()), line, |traffic| {
                traffic.hold_sink(hold);
            });
            traffic.send_frame(taken_frame(second.clone()));
            traffic.drain();
        }
        self.end_clearing(traffic, event, raised);
    }

    /// Stops the sink from the last transfer of a frame until all packets wait. The END packet then
    /// leaves a fixed number of clocks after the sink goes on.
    fn delay_ends(&mut self, traffic: &mut Traffic<'a>) {
        self.begin_clearing(traffic, "frame_done", true);
        // All attempts send the same frame, so the same packets wait.
        let frame = self.frame_source().quiet_frame();
        traffic.send_frame(taken_frame(frame.clone()));
        for parity in 0..ATTEMPTS_PER_EVENT {
            traffic.drain();
            traffic.send_frame(taken_frame(frame.clone()));
            traffic.hold_sink(u64::from(u32::MAX));
            traffic.wait_clocks(traffic.drain_clocks());
            self.align_traffic(traffic, parity);
            traffic.hold_sink(0);
            traffic.drain();
        }
        self.end_clearing(
            traffic,
            "frame_done",
            ExpectedEventCount::Exactly(ATTEMPTS_PER_EVENT + 1),
        );
    }

    /// Waits until the effects of the earlier traffic have ended, and then for a clock of this
    /// parity.
    fn align_traffic(&self, traffic: &mut Traffic<'a>, parity: u32) {
        traffic.wait_clocks(u64::from(2 * self.design().region_size()) + 8);
        traffic.align_to_parity(parity);
    }

    /// Sends a transfer that belongs to no whole frame; `sof` marks it as the first of a frame.
    fn stray_transfer(&mut self, traffic: &mut Traffic<'a>, sof: bool) {
        let pixels = vec![traffic.max_pixel(); self.design().pixels_per_clock() as usize];
        traffic.send_beat(sof, false, &pixels);
    }
}
