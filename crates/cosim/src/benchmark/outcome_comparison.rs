// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison of a recording with the functional model: scores, counts and decisions of every
//! region of every frame, at whatever clock they come.

use foveate_design::{BeatRegion, Design, PortRole, StreamRole};
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use foveate_pixels::Frame;

use super::unpacked_inputs::{field_of_role, for_each_clock};
use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::recording::Recording;
use crate::timed_run::OutputAgreement;

/// Compares a recording of `streamed` frames. The recording repeats the last of `frames` until all
/// outputs have left.
pub(super) fn outcome_agreement(
    design: &Design,
    recording: &Recording,
    frames: &[Frame],
    streamed: u64,
) -> Result<OutputAgreement, CosimError> {
    let last = frames.len().saturating_sub(1);
    let mut camera = FunctionalCamera::new(design);
    let mut outcomes = Vec::new();
    for number in 0..usize::try_from(streamed).expect("they were in memory") {
        let frame = frames.get(number.min(last)).ok_or(CosimError::NoFrames)?;
        outcomes.push(camera.step(frame)?.clone());
    }
    let mut judge = OutcomeComparison::new(design, recording.outputs(), outcomes);
    for_each_clock(recording, |_, expected| judge.compare_clock(expected))?;
    Ok(judge.finish())
}

/// The comparison of one clock after the other.
struct OutcomeComparison<'a> {
    design: &'a Design,
    layout: &'a RecordLayout,
    outcomes: Vec<FunctionalOutcome>,
    /// Scores come one after the other on their own stream, not together with their decision.
    has_scores: bool,
    /// The way in which a decision names its region.
    region_naming: BeatRegion,
    /// The number of decisions so far, by region.
    decision_counts: Vec<usize>,
    agreement: OutputAgreement,
}

impl<'a> OutcomeComparison<'a> {
    fn new(design: &'a Design, layout: &'a RecordLayout, outcomes: Vec<FunctionalOutcome>) -> Self {
        let interface = design.rcm_interface();
        let decisions = interface.stream(StreamRole::Decisions).expect("every core decides");
        Self {
            design,
            layout,
            outcomes,
            has_scores: interface.stream(StreamRole::Scores).is_some(),
            region_naming: decisions.region,
            decision_counts: vec![0; design.regions() as usize],
            agreement: OutputAgreement::default(),
        }
    }

    fn compare_clock(&mut self, record: &[u8]) {
        if self.has_scores {
            return self.compare_one_score(record);
        }
        if self.port_value(record, PortRole::DecisionValid, 0) != Some(1) {
            return;
        }
        match self.region_naming {
            BeatRegion::Number(role) => {
                self.compare_scores(record, self.port_number(record, role), 0);
            }
            BeatRegion::Lane => {
                for lane in 0..self.design.regions() {
                    self.compare_scores(record, lane as usize, lane);
                }
            }
            BeatRegion::None | BeatRegion::Slot(_) => {
                unreachable!("a decision names its region by its lane or its number")
            }
        }
    }

    fn port_number(&self, record: &[u8], role: PortRole) -> usize {
        let value = self.port_value(record, role, 0).expect("the port is there");
        usize::try_from(value).expect("a number of at most 32 bits")
    }

    /// Compares the decision of a region with all its scores, in one lane of the ports.
    fn compare_scores(&mut self, record: &[u8], region: usize, lane: u32) {
        let count = self.port_value(record, PortRole::TemporalCount, lane);
        self.compare_value(region, count, |outcome| outcome.temporal_count[region].into());
        for (place, feature) in self.design.features().iter().enumerate() {
            let score = self.port_value(record, PortRole::Score(feature.kind()), lane);
            self.compare_value(region, score, |outcome| outcome.scores[place][region]);
        }
        self.compare_decision(record, region, lane);
    }

    /// Compares one score of a region, and its decision if it comes at the same clock.
    fn compare_one_score(&mut self, record: &[u8]) {
        if self.port_value(record, PortRole::ScoreValid, 0) != Some(1) {
            return;
        }
        let region = self.port_number(record, PortRole::Region);
        let place = self.port_number(record, PortRole::ScoreIndex);
        let score = self.port_value(record, PortRole::AnyScore, 0);
        self.compare_value(region, score, |outcome| match place.checked_sub(1) {
            None => outcome.temporal_count[region].into(),
            Some(place) => outcome.scores[place][region],
        });
        if self.port_value(record, PortRole::DecisionValid, 0) == Some(1) {
            self.compare_decision(record, region, 0);
        }
    }

    fn compare_decision(&mut self, record: &[u8], region: usize, lane: u32) {
        for (role, bit) in [
            (PortRole::Srs, (|outcome| &outcome.srs) as fn(&FunctionalOutcome) -> &Vec<bool>),
            (PortRole::Trs, |outcome| &outcome.trs),
            (PortRole::Active, |outcome| &outcome.active),
        ] {
            let got = self.port_value(record, role, lane);
            self.compare_value(region, got, |outcome| bit(outcome)[region].into());
        }
        if let Some(decided) = self.decision_counts.get_mut(region) {
            *decided += 1;
        }
    }

    /// Compares one value with the region's current frame. A port that does not exist is not
    /// compared.
    fn compare_value(
        &mut self,
        region: usize,
        got: Option<u64>,
        wanted: impl Fn(&FunctionalOutcome) -> u64,
    ) {
        let Some(got) = got else { return };
        let outcome = self.decision_counts.get(region).and_then(|&frame| self.outcomes.get(frame));
        self.agreement.compared += 1;
        self.agreement.differing += u64::from(outcome.map(wanted) != Some(got));
    }

    fn port_value(&self, record: &[u8], role: PortRole, lane: u32) -> Option<u64> {
        field_of_role(self.layout, role).map(|field| field.get(record, lane))
    }

    /// Returns the result. A decision that never came counts as a difference.
    fn finish(mut self) -> OutputAgreement {
        let missing = |&decided: &usize| self.outcomes.len().saturating_sub(decided) as u64;
        let missing = self.decision_counts.iter().map(missing).sum::<u64>();
        self.agreement.compared += missing;
        self.agreement.differing += missing;
        self.agreement
    }
}
