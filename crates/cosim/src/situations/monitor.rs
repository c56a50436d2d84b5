// SPDX-License-Identifier: MIT OR Apache-2.0
//! A monitor of the ports of an array or unit, which counts situations clock by clock.

use super::occurrence::Occurrences;
use super::places::has_pixel;
use super::port_situations::{PortSituationCounts, flushed_windows};
use super::region_traces::{RegionTraces, ShownDecision};
use crate::field::RecordField;
use crate::layout::RecordLayout;
use foveate_design::{ArrayStructure, Design, PortRole};
use foveate_emit::Top;

/// Returns true if a role is a threshold.
fn is_threshold(role: PortRole) -> bool {
    matches!(
        role,
        PortRole::Level(_)
            | PortRole::MinScore(_)
            | PortRole::TemporalLevel
            | PortRole::TemporalMinCount
            | PortRole::SummaryLevel
    )
}

/// The ports that are watched.
#[derive(Clone, Debug)]
struct WatchedPorts {
    inputs: Vec<RecordField>,
    outputs: Vec<RecordField>,
}

/// One clock: the applied inputs, and the outputs after its edge.
#[derive(Clone, Copy)]
struct WatchedClock<'a> {
    ports: &'a WatchedPorts,
    input: &'a [u8],
    output: &'a [u8],
}

impl WatchedClock<'_> {
    fn field(&self, role: PortRole) -> Option<(&RecordField, &[u8])> {
        let find =
            |fields: &'_ [RecordField]| fields.iter().position(|field| field.port.role == role);
        match find(&self.ports.outputs) {
            Some(at) => Some((&self.ports.outputs[at], self.output)),
            None => find(&self.ports.inputs).map(|at| (&self.ports.inputs[at], self.input)),
        }
    }

    fn value(&self, role: PortRole) -> u64 {
        self.field(role).map_or(0, |(field, record)| field.get(record, 0))
    }

    fn is_high(&self, role: PortRole) -> bool {
        self.field(role)
            .is_some_and(|(field, record)| field.bytes_in(record).iter().any(|&b| b != 0))
    }

    fn bit(&self, role: PortRole, lane: u32) -> bool {
        self.field(role).is_some_and(|(field, record)| field.get(record, lane) == 1)
    }
}

/// The frame that comes in, and the frames before it since the last reset.
#[derive(Clone, Debug, Default)]
struct IntakeState {
    /// The number of beats of the current frame; between two frames, the number of beats of a whole
    /// one.
    beats: u64,
    /// The hash of the pixels so far; `hashes` has those of whole frames.
    hash: u64,
    hashes: Vec<u64>,
    /// The number of clocks since the last beat.
    idle: u64,
    /// True if the core has not been ready at some clock since the last beat.
    was_closed: bool,
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
    /// The number of clocks in which the first window flushes; `flushes` is that of all windows.
    first_flush_clocks: u64,
    flush_clocks: u64,
    intake: IntakeState,
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
        let pick = |layout: &RecordLayout| {
            let fields = layout.fields().iter();
            fields.filter(|field| is_watched(field.port.role)).cloned().collect::<Vec<_>>()
        };
        Self {
            ports: WatchedPorts { inputs: pick(inputs), outputs: pick(outputs) },
            facts: PortSituationCounts::default(),
            regions: RegionTraces::of(design, regions),
            beats_per_frame: design.timing().pixels_per_frame(),
            first_flush_clocks: u64::from(design.region_size()) + 1,
            flush_clocks: (u64::from(design.region_size()) + 1) * flushed_windows(design),
            intake: IntakeState::default(),
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

    /// Adds `clocks` clocks with the same inputs and outputs.
    pub(crate) fn add_clocks(&mut self, input: &[u8], output: &[u8], clocks: u64) {
        let ports =
            std::mem::replace(&mut self.ports, WatchedPorts { inputs: vec![], outputs: vec![] });
        let clock = WatchedClock { ports: &ports, input, output };
        if clock.is_high(PortRole::Reset) {
            self.reset();
        } else {
            self.count_intake(&clock, clocks);
            self.count_stalls(&clock);
            self.count_losses(&clock);
            self.count_decisions(&clock);
        }
        self.keep_outputs(&clock);
        self.ports = ports;
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
        self.counts.fill(None);
        (self.decision_count, self.means_are_due) = (0, false);
        (self.has_error, self.decided_since_error) = (false, 0);
        self.sent_again.clear();
        self.aborted = None;
    }

    /// Records the pixels that the core takes or refuses.
    fn count_intake(&mut self, clock: &WatchedClock<'_>, clocks: u64) {
        let has_ready = clock.field(PortRole::Ready).is_some();
        let is_open = !has_ready || self.was_ready;
        let valid = clock.is_high(PortRole::Valid);
        self.facts.refused += u64::from(valid && !is_open);
        self.intake.was_closed |= !is_open;
        let is_within = (1..self.beats_per_frame).contains(&self.intake.beats);
        if !(valid && is_open) {
            self.facts.gap_within += u64::from(is_open && is_within && self.intake.is_in_step);
            self.facts.gap_before_means += u64::from(is_open && is_within && self.means_are_due);
            self.intake.idle += if is_open { clocks } else { 0 };
            return;
        }
        let syncs = clock.field(PortRole::StartOfFrame).is_some();
        let sof = clock.is_high(PortRole::StartOfFrame);
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
        (self.intake.idle, self.intake.was_closed) = (0, false);
    }

    fn beat(&mut self, clock: &WatchedClock<'_>, is_within: bool) {
        if !is_within {
            self.begin_frame(clock);
        }
        let intake = &mut self.intake;
        if let Some((field, record)) = clock.field(PortRole::Pixel) {
            let lanes = 0..field.port.lanes;
            for lane in lanes.filter(|&lane| has_pixel(&self.design, intake.beats, lane)) {
                let pixel = field.get(record, lane);
                intake.hash = (intake.hash ^ pixel).wrapping_mul(0x0000_0100_0000_01b3);
            }
        }
        intake.beats += 1;
        if intake.beats == self.beats_per_frame {
            let is_first = intake.hashes.is_empty();
            intake.hashes.push(intake.hash);
            if is_first {
                let hash = intake.hash;
                let same = self.sent_again.iter().filter(|&&shown| shown == hash).count();
                self.facts.summary_reset_summary += same as u64;
                self.shown_at_reset.retain(|&(_, shown)| shown == hash);
            }
        }
    }

    fn begin_frame(&mut self, clock: &WatchedClock<'_>) {
        let Self { facts, intake, first_flush_clocks: flush, flush_clocks: flushes, .. } = self;
        if intake.beats == self.beats_per_frame && intake.is_in_step {
            facts.back_to_back += u64::from(intake.idle == 0);
            facts.flush_cut += u64::from((1..*flush).contains(&intake.idle));
            facts.flush_ended += u64::from(intake.idle > *flushes);
        }
        let fields = clock.ports.inputs.iter().filter(|field| is_threshold(field.port.role));
        let thresholds: Vec<u8> =
            fields.flat_map(|field| field.bytes_in(clock.input).iter().copied()).collect();
        let has_changed = intake.is_in_step && thresholds != intake.thresholds;
        facts.threshold_changed += u64::from(has_changed);
        (intake.beats, intake.hash, intake.is_in_step) = (0, 0xcbf2_9ce4_8422_2325, true);
        intake.thresholds = thresholds;
    }

    /// Counts words that wait for the sink.
    fn count_stalls(&mut self, clock: &WatchedClock<'_>) {
        if clock.field(PortRole::ForwardReady).is_none() {
            return;
        }
        let waits = self.had_output && !clock.is_high(PortRole::ForwardReady);
        self.facts.mean_waits += u64::from(waits && self.had_mean);
        self.facts.pixel_waits += u64::from(waits && !self.had_mean);
        let is_inner = waits
            && self.had_mean
            && clock.is_high(PortRole::ForwardSummary)
            && !clock.is_high(PortRole::ForwardLast);
        self.facts.inner_mean_waits += u64::from(is_inner);
        if clock.is_high(PortRole::ForwardValid) && clock.is_high(PortRole::ForwardSummary) {
            self.regions.leave_means(index(clock.value(PortRole::ForwardRegion)));
        }
    }

    fn count_losses(&mut self, clock: &WatchedClock<'_>) {
        if clock.is_high(PortRole::LostValid) {
            self.lost += 1;
            self.regions.lose(index(clock.value(PortRole::LostRegion)));
        }
        let is_aborted =
            clock.is_high(PortRole::ForwardValid) && clock.is_high(PortRole::ForwardAbort);
        let of = (clock.value(PortRole::ForwardRegion), clock.value(PortRole::ForwardFrame));
        let aborted = is_aborted.then_some(of);
        self.facts.lost_within += u64::from(aborted.is_some() && aborted != self.aborted);
        self.aborted = aborted;
    }

    fn count_decisions(&mut self, clock: &WatchedClock<'_>) {
        if clock.is_high(PortRole::SyncError) {
            self.has_error = true;
        }
        if clock.is_high(PortRole::ScoreValid) && clock.value(PortRole::ScoreIndex) == 0 {
            let region = index(clock.value(PortRole::Region));
            if let Some(count) = self.counts.get_mut(region) {
                *count = Some(clock.value(PortRole::AnyScore));
            }
        }
        if !clock.is_high(PortRole::DecisionValid) {
            return;
        }
        let lanes = clock.field(PortRole::Srs).map_or(0, |(field, _)| field.port.lanes);
        let first = if lanes == 1 { index(clock.value(PortRole::Region)) } else { 0 };
        self.means_are_due = clock.is_high(PortRole::Summary);
        for lane in 0..lanes {
            self.decide_region(clock, lane, first + lane as usize);
        }
    }

    fn decide_region(&mut self, clock: &WatchedClock<'_>, lane: u32, region: usize) {
        let regions = self.counts.len() as u64;
        let frame = index(self.decision_count / regions.max(1));
        self.decision_count += 1;
        if self.has_error {
            self.decided_since_error += 1;
            // The first frame is the damaged one.
            self.facts.whole_behind_error += u64::from(self.decided_since_error == 2 * regions);
        }
        let counted = clock.field(PortRole::TemporalCount);
        let count = match counted {
            Some((field, record)) => Some(field.get(record, lane)),
            None => self.counts.get(region).copied().flatten(),
        };
        let bit = |role| clock.bit(role, lane);
        let summary = bit(PortRole::Summary);
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
        let decided =
            ShownDecision { srs: bit(PortRole::Srs), trs: bit(PortRole::Trs), summary, count };
        self.regions.decide(region, frame, decided, &mut self.facts);
    }

    /// Keeps the outputs for the next clock.
    fn keep_outputs(&mut self, clock: &WatchedClock<'_>) {
        self.was_ready = clock.is_high(PortRole::Ready);
        self.had_output = clock.is_high(PortRole::ForwardValid);
        self.had_mean = self.had_output && clock.is_high(PortRole::ForwardSummary);
        let underrun = clock.is_high(PortRole::Underrun);
        self.facts.underrun += u64::from(underrun && !self.had_underrun);
        self.had_underrun = underrun;
    }
}

/// Returns true if the monitor uses a port of this role.
fn is_watched(role: PortRole) -> bool {
    use PortRole::{
        AnyScore, DecisionValid, ForwardAbort, ForwardFrame, ForwardLast, ForwardReady,
        ForwardRegion, ForwardSummary, ForwardValid, LostRegion, LostValid, Pixel, Ready, Region,
        Reset, ScoreIndex, ScoreValid, Srs, StartOfFrame, Summary, SyncError, TemporalCount, Trs,
        Underrun, Valid,
    };
    let others = [
        AnyScore,
        DecisionValid,
        ForwardAbort,
        ForwardFrame,
        ForwardLast,
        ForwardReady,
        ForwardRegion,
        ForwardSummary,
        ForwardValid,
        LostRegion,
        LostValid,
        Pixel,
        Ready,
        Region,
        Reset,
        ScoreIndex,
        ScoreValid,
        Srs,
        StartOfFrame,
        Summary,
        SyncError,
        TemporalCount,
        Trs,
        Underrun,
        Valid,
    ];
    is_threshold(role) || others.contains(&role)
}

/// Converts a small number to an index.
fn index(number: u64) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}
