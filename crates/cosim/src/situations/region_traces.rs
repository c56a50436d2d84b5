// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the monitor remembers from clock to clock, as a situation is often a sequence: the
//! history of every region, from its decisions and its losses ([`RegionTraces`]), and the
//! classes of regions with the map that waits ([`ClassActivity`]).

use super::port_situations::PortSituationCounts;
use super::watched_ports::{WatchedClock, WatchedPorts};
use foveate_camera::{IrrelevantRendering, ReferencePolicy, RegionClass};
use foveate_design::{CLASS_BITS, CLASSES_PER_WORD, Design};

/// A decision as the ports show it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShownDecision {
    pub(super) srs: bool,
    pub(super) trs: bool,
    pub(super) summary: bool,
    /// The number of changed pixels, if the ports show it.
    pub(super) count: Option<u64>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum LastDecision {
    #[default]
    Undecided,
    Active,
    Held,
    Irrelevant,
}

/// The history of one region since the last reset.
#[derive(Clone, Copy, Debug, Default)]
struct RegionTrace {
    last_decision: LastDecision,
    has_reference: bool,
    /// The index of the frame whose summary the screen shows.
    summary_frame: Option<usize>,
    /// True if the region was held while a summary was shown.
    held_with_summary: bool,
    active_after_summary: bool,
    /// True if the region was active, and has been irrelevant since.
    active_then_irrelevant: bool,
    /// True if the region was lost, and has not been decided since.
    is_lost: bool,
    /// True if means of the right neighbor have left the core while this region was held.
    beside_means: bool,
}

/// The histories of all regions since the last reset.
#[derive(Clone, Debug)]
pub(super) struct RegionTraces {
    regions: Vec<RegionTrace>,
    columns: usize,
    pixels: u64,
    blanks_irrelevant: bool,
    is_last_sent: bool,
}

impl RegionTraces {
    pub(super) fn of(design: &Design, regions: u32) -> Self {
        Self {
            regions: vec![RegionTrace::default(); regions as usize],
            columns: design.columns() as usize,
            pixels: design.region_pixels().into(),
            blanks_irrelevant: match design.irrelevant() {
                IrrelevantRendering::Zero | IrrelevantRendering::Mean => true,
                IrrelevantRendering::Hold => false,
            },
            is_last_sent: match design.temporal().reference {
                ReferencePolicy::LastSent => true,
                ReferencePolicy::Previous => false,
            },
        }
    }

    /// Forgets everything. Returns the regions of which the screen shows a summary, each with the
    /// frame of the summary.
    pub(super) fn reset(&mut self) -> Vec<(usize, usize)> {
        let shown = |(region, trace): (usize, &RegionTrace)| Some((region, trace.summary_frame?));
        let all = self.regions.iter().enumerate().filter_map(shown).collect();
        self.regions.fill(RegionTrace::default());
        all
    }

    /// Records the decision of a region in a frame.
    pub(super) fn decide(
        &mut self,
        region: usize,
        frame: usize,
        decided: ShownDecision,
        facts: &mut PortSituationCounts,
    ) {
        let (pixels, blanks) = (self.pixels, self.blanks_irrelevant);
        let Some(trace) = self.regions.get_mut(region) else { return };
        let is_compared = decided.count.is_some_and(|count| count < pixels);
        facts.minimum_above += u64::from(decided.count == Some(pixels) && !decided.trs);
        let was_held = trace.last_decision == LastDecision::Held;
        facts.lost_decided += u64::from(trace.is_lost);
        facts.reference_kept += u64::from(was_held && trace.has_reference && is_compared);
        facts.mean_beside_reference += u64::from(trace.beside_means && was_held && is_compared);
        trace.beside_means = false;
        match (decided.srs, decided.trs) {
            (true, true) => trace.activate(facts),
            (true, false) => {
                facts.held += 1;
                trace.last_decision = LastDecision::Held;
                trace.held_with_summary |= trace.summary_frame.is_some();
            }
            (false, _) => {
                facts.irrelevant += 1;
                trace.active_then_irrelevant |= trace.last_decision == LastDecision::Active;
                trace.last_decision = LastDecision::Irrelevant;
                trace.has_reference &= !blanks;
                trace.summarize(decided.summary, frame, facts);
            }
        }
        trace.is_lost = false;
    }

    /// Records that a region of the last frame was lost.
    pub(super) fn lose(&mut self, region: usize) {
        if let Some(trace) = self.regions.get_mut(region) {
            trace.is_lost = true;
            trace.summary_frame = None;
            trace.has_reference &= !self.is_last_sent;
        }
    }

    /// Records that means of a region leave; the left neighbor counts if it is held with a
    /// reference of an earlier frame.
    pub(super) fn leave_means(&mut self, region: usize) {
        if !region.is_multiple_of(self.columns)
            && let Some(left) = self.regions.get_mut(region - 1)
            && left.last_decision == LastDecision::Held
            && left.has_reference
        {
            left.beside_means = true;
        }
    }
}

impl RegionTrace {
    fn activate(&mut self, facts: &mut PortSituationCounts) {
        facts.active += 1;
        facts.reference_dropped += u64::from(self.active_then_irrelevant);
        self.active_after_summary |= self.summary_frame.is_some();
        self.last_decision = LastDecision::Active;
        self.has_reference = true;
        (self.active_then_irrelevant, self.held_with_summary, self.summary_frame) =
            (false, false, None);
    }

    fn summarize(&mut self, is_sent: bool, frame: usize, facts: &mut PortSituationCounts) {
        facts.summary_held_irrelevant +=
            u64::from(self.held_with_summary && self.summary_frame.is_some());
        self.held_with_summary = false;
        facts.summary_kept += u64::from(!is_sent && self.summary_frame.is_some());
        if is_sent {
            facts.summary_sent += 1;
            facts.summary_renewed += u64::from(self.summary_frame.is_some());
            facts.summary_active_summary += u64::from(self.active_after_summary);
            facts.lost_summary_again += u64::from(self.is_lost);
            (self.active_after_summary, self.summary_frame) = (false, Some(frame));
        }
    }
}

/// The classes of the last frame, and whether a map waits.
#[derive(Clone, Debug, Default)]
pub(super) struct ClassActivity {
    /// The codes of the classes of the last frame; empty after a reset until a frame begins.
    codes: Vec<u64>,
    was_pending: bool,
}

impl ClassActivity {
    pub(super) fn reset(&mut self) {
        self.codes.clear();
    }

    /// Counts the classes at the ports of a pipelined array at the first pixel of a frame.
    pub(super) fn begin_frame(
        &mut self,
        ports: &WatchedPorts,
        clock: WatchedClock<'_>,
        facts: &mut PortSituationCounts,
    ) {
        let lanes = 0..ports.region_class.lanes();
        let codes: Vec<u64> = lanes.map(|lane| clock.lane(&ports.region_class, lane)).collect();
        codes.iter().for_each(|&code| count_class(code, facts));
        let changes = self.codes.iter().zip(&codes).filter(|(before, now)| before != now);
        facts.class_changed += changes.count() as u64;
        self.codes = codes;
    }

    /// Counts the words and commits of a clock. `is_within` is true between the first and the last
    /// pixel of a frame.
    pub(super) fn count_maps(
        &mut self,
        ports: &WatchedPorts,
        clock: WatchedClock<'_>,
        is_within: bool,
        facts: &mut PortSituationCounts,
    ) {
        let [is_written, is_committed] =
            [&ports.class_write, &ports.class_commit].map(|port| clock.is_high(port));
        if self.was_pending {
            facts.word_while_pending += u64::from(is_written);
            facts.commit_while_pending += u64::from(is_committed);
            return;
        }
        if is_written {
            let word = clock.value(&ports.class_word);
            let codes = (0..CLASSES_PER_WORD).map(|place| word >> (CLASS_BITS * place));
            codes.for_each(|code| count_class(code & ((1 << CLASS_BITS) - 1), facts));
        }
        facts.map_within_frame += u64::from(is_committed && is_within);
        facts.map_between_frames += u64::from(is_committed && !is_within);
    }

    pub(super) fn keep_outputs(&mut self, ports: &WatchedPorts, clock: WatchedClock<'_>) {
        self.was_pending = clock.is_high(&ports.class_pending);
    }
}

fn count_class(code: u64, facts: &mut PortSituationCounts) {
    match u8::try_from(code).ok().and_then(RegionClass::from_code) {
        Some(RegionClass::Off) => facts.class_off += 1,
        Some(RegionClass::Keen) => facts.class_keen += 1,
        Some(RegionClass::Always) => facts.class_always += 1,
        Some(RegionClass::Normal) | None => {}
    }
}
