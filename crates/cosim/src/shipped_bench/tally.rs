// SPDX-License-Identifier: MIT OR Apache-2.0
//! Counts of what vectors contain, taken from their expected outputs alone.

use crate::layout::RecordLayout;
use crate::situations::{Occurrences, can_be_irrelevant, can_hold, can_lose, has_sink};
use foveate_design::{Design, PortRole};
use foveate_emit::Top;

/// The smallest number of frames that vectors must contain.
const MIN_FRAMES: u64 = 3;

/// The counts of what vectors contain.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VectorTally {
    /// The number of frames whose regions are all decided.
    pub frames: u64,
    /// The number of decisions for an active region.
    pub active: u64,
    /// The number of decisions for a region that is relevant but has not changed, and is held.
    pub held: u64,
    /// The number of decisions for a region that is not relevant, and is blanked (or held, by
    /// `render.irrelevant`).
    pub blank: u64,
    /// The number of the `blank` decisions that send a summary.
    pub summaries: u64,
    /// The number of comparisons with an earlier frame: temporal counts below that of a region
    /// without a reference.
    pub compared: u64,
    /// The largest number of regions lost to a stalling sink after one reset.
    pub lost: u64,
    /// The number of beats that fit no frame, for hardware with `sync`.
    pub sync_errors: u64,
    /// The number of decisions after the first sync error. If there are more than a frame has, some
    /// belong to frames behind the damaged one.
    pub after_error: u64,
    /// The kinds of losses to a stalling sink.
    pub losses: RegionLosses,
    /// The number of times that each situation occurred that the design can have.
    pub situations: Occurrences,
    /// The names of outputs whose expected value is always 0, though they can have others.
    pub zero_outputs: Vec<String>,
}

/// The losses of regions to a stalling sink, counted over all sequences.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RegionLosses {
    /// The number of regions lost before any of their words left.
    pub whole: u64,
    /// The number of regions lost after words of them were fetched, while their last word waits for
    /// the sink.
    pub waiting: u64,
    /// The number of regions lost after words of them were fetched, at an edge at which their last
    /// word comes to the ports.
    pub arriving: u64,
    /// The number of the `waiting` and `stepping` losses with a single word, which is first and
    /// last.
    pub single: u64,
}

/// A counter that runs while vectors are made.
pub(super) struct TallyCounter {
    regions: u64,
    region_pixels: u64,
    can_lose: bool,
    tally: VectorTally,
    /// The number of regions that were lost; `aborted` is the region and frame of the last word
    /// with `abort`.
    lost: u64,
    last_aborted: Option<(u64, u64)>,
    /// For each field, the lanes whose expected value was 0 whenever it was compared.
    zero_lanes: Vec<Vec<u32>>,
}

impl TallyCounter {
    pub(super) fn new(part: &Design, outputs: &RecordLayout) -> Self {
        Self {
            regions: part.regions().into(),
            region_pixels: part.region_pixels().into(),
            can_lose: can_lose(part),
            tally: VectorTally::default(),
            lost: 0,
            last_aborted: None,
            zero_lanes: outputs
                .fields()
                .iter()
                .map(|field| (0..field.port.lanes).collect())
                .collect(),
        }
    }

    pub(super) fn count_clock(&mut self, outputs: &RecordLayout, expected: &[u8]) {
        let at = |role| outputs.fields().iter().find(|field| field.port.role == role);
        let is_high = |role| at(role).is_some_and(|field| field.get(expected, 0) == 1);
        self.tally.sync_errors += u64::from(is_high(PortRole::SyncError));
        if is_high(PortRole::DecisionValid) {
            let lanes = at(PortRole::Srs).expect("where there are decisions").port.lanes;
            if self.tally.sync_errors > 0 {
                self.tally.after_error += u64::from(lanes);
            }
            for lane in 0..lanes {
                let bit = |role| at(role).is_some_and(|field| field.get(expected, lane) == 1);
                match (bit(PortRole::Srs), bit(PortRole::Trs)) {
                    (true, true) => self.tally.active += 1,
                    (true, false) => self.tally.held += 1,
                    (false, _) => self.tally.blank += 1,
                }
                self.tally.summaries += u64::from(bit(PortRole::Summary));
                let count = at(PortRole::TemporalCount).map(|field| field.get(expected, lane));
                self.tally.compared += u64::from(count.is_some_and(|c| c < self.region_pixels));
            }
        }
        if is_high(PortRole::ScoreValid)
            && at(PortRole::ScoreIndex).is_some_and(|field| field.get(expected, 0) == 0)
        {
            let count = at(PortRole::AnyScore).map(|field| field.get(expected, 0));
            self.tally.compared += u64::from(count.is_some_and(|c| c < self.region_pixels));
        }
        let lost = at(PortRole::LostCount).map_or(0, |field| field.get(expected, 0));
        self.tally.lost = self.tally.lost.max(lost);
        self.count_losses(outputs, expected);
        for (field, silent) in outputs.fields().iter().zip(&mut self.zero_lanes) {
            if !silent.is_empty() && !field.gate.is_closed(outputs.fields(), expected) {
                let is_compared = |lane| field.gate.compares_lane(outputs.fields(), expected, lane);
                silent.retain(|&lane| !is_compared(lane) || field.get(expected, lane) == 0);
            }
        }
    }

    /// Counts the losses of a clock. A word with `abort` is counted once; it is a new word if its
    /// region or frame differs.
    fn count_losses(&mut self, outputs: &RecordLayout, expected: &[u8]) {
        let at = |role| outputs.fields().iter().find(|field| field.port.role == role);
        let value = |role| at(role).map_or(0, |field| field.get(expected, 0));
        let is_lost = value(PortRole::LostValid) == 1;
        self.lost += u64::from(is_lost);
        let is_aborted = value(PortRole::ForwardValid) == 1 && value(PortRole::ForwardAbort) == 1;
        let of = (value(PortRole::ForwardRegion), value(PortRole::ForwardFrame));
        let aborted = is_aborted.then_some(of);
        if aborted.is_some() && aborted != self.last_aborted {
            let losses = &mut self.tally.losses;
            // The region of this word is lost at the same edge, or was lost earlier.
            let is_now = is_lost && (value(PortRole::LostRegion), value(PortRole::LostFrame)) == of;
            losses.arriving += u64::from(is_now);
            losses.waiting += u64::from(!is_now);
            losses.single += value(PortRole::ForwardFirst);
        }
        self.last_aborted = aborted;
    }

    pub(super) fn finish(self, outputs: &RecordLayout) -> VectorTally {
        let Self { regions, can_lose, mut tally, zero_lanes: silent, lost, .. } = self;
        let RegionLosses { waiting, arriving: stepping, .. } = tally.losses;
        tally.losses.whole = lost.saturating_sub(waiting + stepping);
        tally.frames = (tally.active + tally.held + tally.blank) / regions.max(1);
        for (field, silent) in outputs.fields().iter().zip(silent) {
            let port = &field.port;
            // The number of the only region is always 0.
            let is_numbered = matches!(port.role, PortRole::Region | PortRole::ForwardRegion);
            let is_loss = is_loss_role(port.role);
            if (is_numbered && regions == 1) || (is_loss && !can_lose) {
                continue;
            }
            tally.zero_outputs.extend(silent.into_iter().map(|lane| match port.lanes {
                1 => port.name.clone(),
                _ => format!("lane {lane} of {}", port.name),
            }));
        }
        tally
    }
}

impl VectorTally {
    /// Returns what is missing, in words, or `None` if the vectors contain all that they can.
    pub(super) fn shortcoming(&self, part: &Design) -> Option<String> {
        let mut missing = Vec::new();
        let mut need = |is_there: bool, words: String| {
            if !is_there {
                missing.push(words);
            }
        };
        need(self.frames >= MIN_FRAMES, format!("only {} frames are decided", self.frames));
        need(self.active > 0, "no region is active".to_owned());
        need(self.held > 0 || !can_hold(part), "no region is held".to_owned());
        need(self.blank > 0 || !can_be_irrelevant(part), "no region is blank".to_owned());
        if part.periphery().is_some() && can_be_irrelevant(part) {
            need(self.summaries > 0, "no summary is sent".to_owned());
            need(self.summaries < self.blank, "no summary stays on the screen".to_owned());
        }
        need(self.compared > 0, "nothing is compared with an earlier frame".to_owned());
        let goes_on = self.sync_errors == 0 || self.after_error > u64::from(part.regions());
        need(goes_on, "no frame is decided behind a damaged one".to_owned());
        if can_lose(part) {
            let RegionLosses { whole, waiting, arriving: stepping, .. } = self.losses;
            need(whole > 0, "no region is lost as a whole".to_owned());
            need(waiting + stepping > 0, "no region is lost in the middle".to_owned());
        }
        for situation in self.situations.missing() {
            need(false, format!("it does not occur that {situation}"));
        }
        let silent = self.zero_outputs.join(" and ");
        need(self.zero_outputs.is_empty(), format!("{silent} never differs from 0"));
        (!missing.is_empty()).then(|| missing.join(", "))
    }

    /// Returns a summary of the vectors, as lines of a comment.
    pub(super) fn description_lines(
        &self,
        design: &Design,
        part: &Design,
        top: Top,
    ) -> Vec<String> {
        let grid = |design: &Design| format!("{} x {}", design.columns(), design.rows());
        let of = match top {
            Top::Rcm if grid(part) != grid(design) => {
                format!(", a part of the core's {} that parameters select", grid(design))
            }
            Top::Rcm | Top::Rpu => String::new(),
        };
        let mut lines = vec![
            format!("The vectors show {} frames of {} regions{of}.", self.frames, grid(part)),
            format!(
                "Decisions: {} active, {} held, {} blank; {} comparisons with an earlier frame.",
                self.active, self.held, self.blank, self.compared
            ),
        ];
        if part.periphery().is_some() {
            lines.push(format!("A summary is sent by {} of the blank ones.", self.summaries));
        }
        if self.lost > 0 {
            lines.push(format!("The sink stalls until {} regions are lost.", self.lost));
            let RegionLosses { whole, waiting, arriving: stepping, single } = self.losses;
            lines.push(format!(
                "In all sequences {whole} are lost as a whole, {} in the middle:",
                waiting + stepping
            ));
            lines.push(format!(
                "{waiting} while their last word waits, {stepping} when it reaches the ports; \
                 {single} after one word."
            ));
        }
        if self.sync_errors > 0 {
            lines.push(format!(
                "Frames come damaged: {} sync errors, and {} decisions after the first.",
                self.sync_errors, self.after_error
            ));
        }
        lines
    }
}

/// Returns what the configuration makes impossible for any pixels, as sentences.
pub(super) fn impossible_region_remarks(design: &Design) -> Vec<String> {
    let mut list = Vec::new();
    if !can_hold(design) {
        list.push("No region is ever held: temporal.min_count is 0.".to_owned());
    }
    if !can_be_irrelevant(design) {
        list.push("No region is ever blank: a min_score of 0 always votes.".to_owned());
    }
    if has_sink(design) && !can_lose(design) {
        list.push("No region is ever lost: a frame waits for the sink.".to_owned());
    }
    list
}

/// Returns true if a port differs from 0 only where a region is lost.
fn is_loss_role(role: PortRole) -> bool {
    use PortRole::{ForwardAbort, Lost, LostCount, LostFrame, LostRegion, LostValid};
    matches!(role, ForwardAbort | Lost | LostCount | LostValid | LostRegion | LostFrame)
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::DesignConfig;

    #[test]
    fn a_bench_that_stays_out_of_step_never_passes() {
        let design = DesignConfig::from_toml("hardware.sync = true").unwrap().validate().unwrap();
        let (active, held, blank) = (800, 800, 800);
        let whole = VectorTally {
            frames: 3,
            active,
            held,
            blank,
            compared: 1,
            sync_errors: 2,
            ..VectorTally::default()
        };
        for (after_error, shortcoming) in
            [(785, None), (784, Some("no frame is decided behind a damaged one".to_owned()))]
        {
            let tally = VectorTally { after_error, ..whole.clone() };
            assert_eq!(tally.shortcoming(&design), shortcoming);
        }
    }
}
