// SPDX-License-Identifier: MIT OR Apache-2.0
//! A monitor of the ports of an array or unit, which counts situations clock by clock
//! ([`SituationMonitor`]). It looks only at places of the pixel port that carry a pixel of the
//! frame ([`has_pixel`]).

use super::occurrence::Occurrences;
use super::port_situations::{PortSituationCounts, flushed_windows};
use super::region_traces::{ClassActivity, RegionTraces, ShownDecision};
use super::watched_ports::{WatchedClock, WatchedPorts};
use crate::layout::RecordLayout;
use foveate_design::{ArrayStructure, Design, Hardware, PixelFeed};
use foveate_emit::Top;
use std::hash::{DefaultHasher, Hash, Hasher};

/// The frame that comes in, and the frames before it since the last reset.
#[derive(Clone, Debug, Default)]
struct IntakeState {
    /// The number of beats of the current frame; between two frames, the number of beats of a whole
    /// one.
    beats: u64,
    /// The hash of the pixels so far; `hashes` has those of whole frames.
    hasher: DefaultHasher,
    hashes: Vec<u64>,
    /// The number of clocks since the last beat.
    idle: u64,
    /// True if a frame has begun since the last reset, and its number of beats was right since
    /// then.
    is_in_step: bool,
    thresholds: Vec<u8>,
}

/// A counter of situations.
#[derive(Clone, Debug)]
pub(crate) struct SituationMonitor {
    design: Design,
    top: Top,
    ports: WatchedPorts,
    facts: PortSituationCounts,
    regions: RegionTraces,
    beats_per_frame: u64,
    /// The radius of `flow`, if the design has it.
    radius: Option<u64>,
    /// The number of clocks in which the first window flushes; `flushes` is that of all windows.
    first_flush_clocks: u64,
    flush_clocks: u64,
    intake: IntakeState,
    classes: ClassActivity,
    /// The number of decisions since the last reset, over all lanes.
    decision_count: u64,
    /// The temporal count of each region that a serial array has shown.
    counts: Vec<Option<u64>>,
    /// The outputs after the edge before.
    was_ready: bool,
    had_output: bool,
    had_mean: bool,
    had_underrun: bool,
    /// True if the last decisions send a summary.
    means_are_due: bool,
    /// The regions with a summary at the last reset, each with the hash of the frame of the
    /// summary.
    shown_at_reset: Vec<(usize, u64)>,
    /// The hashes from `shown_at_reset` of regions whose summary was sent again in the first frame.
    sent_again: Vec<u64>,
    has_error: bool,
    decided_since_error: u64,
    lost: u64,
    aborted: Option<(u64, u64)>,
}

impl SituationMonitor {
    /// Creates a monitor for the simulated part; `design` is the design at the level of the run.
    pub(crate) fn new(
        design: &Design,
        top: Top,
        inputs: &RecordLayout,
        outputs: &RecordLayout,
    ) -> Self {
        let regions = match (top, design.unit().array) {
            (Top::Rpu, ArrayStructure::RpuCopies) => 1,
            (Top::Rpu, ArrayStructure::SharedLogic)
            | (Top::Rcm, ArrayStructure::RpuCopies | ArrayStructure::SharedLogic) => {
                design.regions()
            }
        };
        Self {
            ports: WatchedPorts::new(inputs, outputs),
            facts: PortSituationCounts::default(),
            regions: RegionTraces::of(design, regions),
            radius: design.displacement_feature().and_then(|flow| flow.radius()).map(u64::from),
            beats_per_frame: design.timing().pixels_per_frame(),
            first_flush_clocks: u64::from(design.region_size()) + 1,
            flush_clocks: (u64::from(design.region_size()) + 1) * flushed_windows(design),
            intake: IntakeState::default(),
            classes: ClassActivity::default(),
            decision_count: 0,
            counts: vec![None; regions as usize],
            was_ready: false,
            had_output: false,
            had_mean: false,
            had_underrun: false,
            means_are_due: false,
            shown_at_reset: Vec::new(),
            sent_again: Vec::new(),
            has_error: false,
            decided_since_error: 0,
            lost: 0,
            aborted: None,
            design: design.clone(),
            top,
        }
    }

    /// Returns the count of each situation that the design can have.
    pub(crate) fn occurrences(&self) -> Occurrences {
        let mut facts = self.facts.clone();
        facts.lost_whole = self.lost.saturating_sub(facts.lost_within);
        facts.occurrences(&self.design, self.top)
    }

    pub(crate) fn add_clocks(&mut self, input: &[u8], output: &[u8], clocks: u64) {
        let clock = WatchedClock { input, output };
        if clock.is_high(&self.ports.reset) {
            self.reset();
        } else {
            let is_within = (1..self.beats_per_frame).contains(&self.intake.beats);
            self.classes.count_maps(&self.ports, clock, is_within, &mut self.facts);
            self.count_intake(clock, clocks);
            self.count_stalls(clock);
            self.count_losses(clock);
            self.count_decisions(clock);
        }
        self.keep_outputs(clock);
    }

    fn reset(&mut self) {
        let (facts, intake) = (&mut self.facts, &mut self.intake);
        facts.reset_within +=
            u64::from(intake.is_in_step && (1..self.beats_per_frame).contains(&intake.beats));
        facts.reset_while_leaving += u64::from(self.had_output);
        facts.reset_at_mean += u64::from(self.had_mean);
        let shown = self.regions.reset();
        // Several clocks of reset count as one.
        if intake.is_in_step {
            let hash = |(region, frame): (usize, usize)| Some((region, *intake.hashes.get(frame)?));
            self.shown_at_reset = shown.into_iter().filter_map(hash).collect();
        }
        *intake = IntakeState::default();
        self.classes.reset();
        self.counts.fill(None);
        (self.decision_count, self.means_are_due) = (0, false);
        (self.has_error, self.decided_since_error) = (false, 0);
        self.sent_again.clear();
        self.aborted = None;
    }

    /// Records the pixels that the core takes or refuses.
    fn count_intake(&mut self, clock: WatchedClock<'_>, clocks: u64) {
        let has_ready = self.ports.ready.exists();
        let is_open = !has_ready || self.was_ready;
        let valid = clock.is_high(&self.ports.valid);
        self.facts.refused += u64::from(valid && !is_open);
        let is_within = (1..self.beats_per_frame).contains(&self.intake.beats);
        if !(valid && is_open) {
            self.facts.gap_within += u64::from(is_open && is_within && self.intake.is_in_step);
            self.facts.gap_before_means += u64::from(is_open && is_within && self.means_are_due);
            self.intake.idle += if is_open { clocks } else { 0 };
            return;
        }
        let syncs = self.ports.start_of_frame.exists();
        let sof = clock.is_high(&self.ports.start_of_frame);
        if syncs && sof && is_within {
            self.facts.too_few += u64::from(self.intake.is_in_step);
            // All beats up to the next start are dropped, and the core completes the frame.
            self.intake.is_in_step = false;
        } else if syncs && !sof && !is_within {
            let was_in_step = self.intake.is_in_step;
            self.facts.too_many +=
                u64::from(was_in_step && self.intake.beats == self.beats_per_frame);
            self.facts.no_start += u64::from(self.intake.beats == 0 || !was_in_step);
        } else if !syncs || sof || is_within {
            self.beat(clock, is_within);
        }
        self.intake.idle = 0;
    }

    fn beat(&mut self, clock: WatchedClock<'_>, is_within: bool) {
        if !is_within {
            self.begin_frame(clock);
        }
        let intake = &mut self.intake;
        let lanes = 0..self.ports.pixel.lanes();
        for lane in lanes.filter(|&lane| has_pixel(&self.design, intake.beats, lane)) {
            clock.lane(&self.ports.pixel, lane).hash(&mut intake.hasher);
        }
        intake.beats += 1;
        if intake.beats == self.beats_per_frame {
            let is_first = intake.hashes.is_empty();
            let hash = intake.hasher.finish();
            intake.hashes.push(hash);
            if is_first {
                let same = self.sent_again.iter().filter(|&&shown| shown == hash).count();
                self.facts.summary_reset_summary += same as u64;
                self.shown_at_reset.retain(|&(_, shown)| shown == hash);
            }
        }
    }

    fn begin_frame(&mut self, clock: WatchedClock<'_>) {
        let Self { facts, intake, ports, first_flush_clocks: flush, flush_clocks: flushes, .. } =
            self;
        if intake.beats == self.beats_per_frame && intake.is_in_step {
            facts.back_to_back += u64::from(intake.idle == 0);
            facts.flush_cut += u64::from((1..*flush).contains(&intake.idle));
            facts.flush_ended += u64::from(intake.idle > *flushes);
        }
        let fields = ports.thresholds.iter();
        let thresholds: Vec<u8> =
            fields.flat_map(|field| field.bytes_in(clock.input).iter().copied()).collect();
        let has_changed = intake.is_in_step && thresholds != intake.thresholds;
        facts.threshold_changed += u64::from(has_changed);
        self.classes.begin_frame(ports, clock, facts);
        (intake.beats, intake.hasher, intake.is_in_step) = (0, DefaultHasher::new(), true);
        intake.thresholds = thresholds;
    }

    /// Counts words that wait for the sink.
    fn count_stalls(&mut self, clock: WatchedClock<'_>) {
        if !self.ports.forward_ready.exists() {
            return;
        }
        let waits = self.had_output && !clock.is_high(&self.ports.forward_ready);
        self.facts.mean_waits += u64::from(waits && self.had_mean);
        self.facts.pixel_waits += u64::from(waits && !self.had_mean);
        let is_inner = waits
            && self.had_mean
            && clock.is_high(&self.ports.forward_summary)
            && !clock.is_high(&self.ports.forward_last);
        self.facts.inner_mean_waits += u64::from(is_inner);
        if clock.is_high(&self.ports.forward_valid) && clock.is_high(&self.ports.forward_summary) {
            self.regions.leave_means(index(clock.value(&self.ports.forward_region)));
        }
    }

    fn count_losses(&mut self, clock: WatchedClock<'_>) {
        if clock.is_high(&self.ports.lost_valid) {
            self.lost += 1;
            self.regions.lose(index(clock.value(&self.ports.lost_region)));
        }
        let is_aborted =
            clock.is_high(&self.ports.forward_valid) && clock.is_high(&self.ports.forward_abort);
        let of = (clock.value(&self.ports.forward_region), clock.value(&self.ports.forward_frame));
        let aborted = is_aborted.then_some(of);
        self.facts.lost_within += u64::from(aborted.is_some() && aborted != self.aborted);
        self.aborted = aborted;
    }

    fn count_decisions(&mut self, clock: WatchedClock<'_>) {
        if clock.is_high(&self.ports.sync_error) {
            self.has_error = true;
        }
        if clock.is_high(&self.ports.score_valid) && clock.value(&self.ports.score_index) == 0 {
            let region = index(clock.value(&self.ports.region));
            if let Some(count) = self.counts.get_mut(region) {
                *count = Some(clock.value(&self.ports.any_score));
            }
        }
        self.count_movements(clock);
        if !clock.is_high(&self.ports.decision_valid) {
            return;
        }
        let lanes = self.ports.srs.lanes();
        let first = if lanes == 1 { index(clock.value(&self.ports.region)) } else { 0 };
        self.means_are_due = clock.is_high(&self.ports.summary);
        for lane in 0..lanes {
            self.decide_region(clock, lane, first + lane as usize);
        }
    }

    /// Counts the displacements that are not 0. The ports are 0 with all scores but that of `flow`.
    fn count_movements(&mut self, clock: WatchedClock<'_>) {
        let Some(radius) = self.radius else { return };
        if !clock.is_high(&self.ports.score_valid) {
            return;
        }
        // The highest of the 2 or 3 bits of a coordinate is its sign.
        let sign = if radius > 1 { 4 } else { 2 };
        let distance = |value: u64| if value < sign { value } else { 2 * sign - value };
        let ports = [&self.ports.displacement_x, &self.ports.displacement_y];
        let moved = ports.map(|port| distance(clock.value(port)));
        self.facts.moved += u64::from(moved != [0; 2]);
        self.facts.moved_far += u64::from(moved == [radius; 2]);
    }

    fn decide_region(&mut self, clock: WatchedClock<'_>, lane: u32, region: usize) {
        let regions = self.counts.len() as u64;
        let frame = index(self.decision_count / regions.max(1));
        self.decision_count += 1;
        if self.has_error {
            self.decided_since_error += 1;
            // The first frame is the damaged one.
            self.facts.whole_behind_error += u64::from(self.decided_since_error == 2 * regions);
        }
        let count = match self.ports.temporal_count.exists() {
            true => Some(clock.lane(&self.ports.temporal_count, lane)),
            false => self.counts.get(region).copied().flatten(),
        };
        let summary = clock.bit(&self.ports.summary, lane);
        if summary && frame == 0 {
            let again = self.shown_at_reset.iter().filter(|&&(shown, _)| shown == region);
            let again: Vec<u64> = again.map(|&(_, hash)| hash).collect();
            // The first frame is complete, or is still to come.
            match self.intake.hashes.first() {
                Some(hash) => {
                    let same = again.iter().filter(|&own| own == hash).count();
                    self.facts.summary_reset_summary += same as u64;
                }
                None => self.sent_again.extend(again),
            }
        }
        let (srs, trs) = (clock.bit(&self.ports.srs, lane), clock.bit(&self.ports.trs, lane));
        let decided = ShownDecision { srs, trs, summary, count };
        self.regions.decide(region, frame, decided, &mut self.facts);
    }

    fn keep_outputs(&mut self, clock: WatchedClock<'_>) {
        self.was_ready = clock.is_high(&self.ports.ready);
        self.classes.keep_outputs(&self.ports, clock);
        self.had_output = clock.is_high(&self.ports.forward_valid);
        self.had_mean = self.had_output && clock.is_high(&self.ports.forward_summary);
        let underrun = clock.is_high(&self.ports.underrun);
        self.facts.underrun += u64::from(underrun && !self.had_underrun);
        self.had_underrun = underrun;
    }
}

/// Converts a small number to an index.
fn index(number: u64) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}

/// Returns whether a lane of the pixel port carries a pixel of the frame at a beat, counted from
/// the first beat of the frame. A lane of a serial array has none in the slots that no region uses,
/// and the last word of a row of a raster core may reach beyond the frame. Values in such places
/// are arbitrary.
pub(super) fn has_pixel(design: &Design, beat: u64, lane: u32) -> bool {
    match design.hardware() {
        Hardware::Pipelined(_) => true,
        Hardware::Serial(own) => {
            let own = design.with_hardware(own);
            match own.feed() {
                PixelFeed::Raster => true,
                PixelFeed::Parallel => {
                    let slot = beat / u64::from(design.stream_pixels());
                    let region = u64::from(lane) * u64::from(own.fold()) + slot;
                    region < own.regions().into()
                }
            }
        }
        Hardware::Raster(own) => {
            let pixels = u64::from(design.with_hardware(own).pixels_per_clock());
            let words = u64::from(design.width()).div_ceil(pixels);
            beat % words * pixels + u64::from(lane) < design.width().into()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::DesignConfig;

    fn design(toml: &str) -> Design {
        DesignConfig::from_toml(toml).unwrap().validate().unwrap()
    }

    #[test]
    fn slots_without_a_region_carry_no_pixel() {
        let design = design(
            "frame={width=12,height=4}\nregion.size=4\nhardware={organization='serial',fold=2}",
        );
        let stream = u64::from(design.stream_pixels());
        let carried = |beat| (0..2).map(|lane| has_pixel(&design, beat, lane)).collect::<Vec<_>>();
        assert_eq!(carried(stream - 1), [true, true]);
        assert_eq!(carried(stream), [true, false], "three regions, four slots");
    }

    #[test]
    fn a_word_beyond_the_end_of_a_row_carries_fewer_pixels() {
        let design = design(
            "frame={width=58,height=8}\nhardware={organization='raster',pixels_per_clock=4}",
        );
        let carried = |beat| (0..4).filter(|&lane| has_pixel(&design, beat, lane)).count();
        assert_eq!([0, 13, 14, 15, 29].map(carried), [4, 4, 2, 4, 2]);
    }
}
