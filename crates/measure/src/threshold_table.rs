// SPDX-License-Identifier: MIT OR Apache-2.0
//! The decisions of a camera with any minimum scores and any minimum count, from one run over
//! frames.
//!
//! While scores do not depend on decisions, a run needs to count only the area of every combination
//! of scores, changed pixels and ideal decision: the decisions with all other minima follow from
//! it.

use std::collections::HashMap;

use foveate_camera::{
    Camera, CameraConfig, FeatureKind, IrrelevantRendering, ReferencePolicy, RegionAction,
    VoteCombination,
};
use foveate_engine::FrameOutcome;

use super::fixed_point::count_to_f64;
use crate::areas::{DecisionAreas, DecisionState, FrameOrder};
use crate::overlap::GridCells;

/// The most steps of a minimum.
const MAX_STEPS: usize = u8::MAX as usize;

/// The minima that are compared with the changed pixels and the scores of regions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MinimumSteps {
    /// The minimum counts of changed pixels, rising; at most 255.
    pub counts: Vec<u32>,
    /// The minimum scores of every feature, rising, in the integers of the camera; at most 255
    /// each.
    pub scores: Vec<Vec<u64>>,
}

/// Limits on the decisions of a camera, as shares from 0 to 1; `None` is no limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DecisionLimits {
    /// The largest share of the area whose action differs.
    pub flips: Option<f64>,
    /// The largest share of the ideal's active area that is not active in the candidate.
    pub missed: Option<f64>,
    /// The largest share of the candidate's active area that is not active in the ideal.
    pub false_alarms: Option<f64>,
    /// The distance up to which of two cameras the one that is active more is nearer, if there is
    /// one.
    pub prefers_active_below: Option<f64>,
}

impl DecisionLimits {
    /// Returns the largest ratio of a rate and its limit. A limit of 0 is far from every other
    /// rate. Up to [`Self::prefers_active_below`] it is the negative share of the area that is
    /// `active`.
    #[must_use]
    pub fn distance(&self, [flips, missed, false_alarms]: [f64; 3], active: f64) -> f64 {
        let ratio = |limit: Option<f64>, rate: f64| limit.map_or(0.0, |limit| ratio(rate, limit));
        let most = ratio(self.flips, flips).max(ratio(self.missed, missed));
        let most = most.max(ratio(self.false_alarms, false_alarms));
        if self.prefers_active_below.is_some_and(|bound| most <= bound) { -active } else { most }
    }
}

fn ratio(rate: f64, limit: f64) -> f64 {
    const LEAST: f64 = 1e-4;
    match rate > 0.0 {
        true => rate / limit.max(LEAST) + f64::from(u8::from(limit == 0.0)),
        false => 0.0,
    }
}

/// The numbers of steps that the changed pixels and each score of a region reach.
type ReachedSteps = [u8; 1 + FeatureKind::COUNT];

/// The numbers of the minima among the steps: that of the count, and that of every score.
pub type ChosenSteps = Vec<usize>;

/// The areas of regions that reach some steps, by groups of frames.
type GroupAreas = Vec<u64>;

/// The counts of a camera over frames.
#[derive(Clone, Debug)]
pub struct ThresholdTable {
    cells: GridCells,
    combine: VoteCombination,
    irrelevant: IrrelevantRendering,
    steps: MinimumSteps,
    groups: usize,
    /// The steps that the regions of the last frame reach.
    regions: Vec<ReachedSteps>,
    areas: HashMap<(DecisionState, FrameOrder, ReachedSteps), GroupAreas>,
}

/// The regions of one ideal decision that reach the same steps.
struct TableRow {
    reached: ReachedSteps,
    area: u64,
    is_ideal_active: bool,
    is_later: bool,
    /// Whether a camera flips if it is active, if it has SRS only, and if it has not.
    flips: [bool; 3],
}

/// Minima, and how far the camera is from some limits with them.
#[derive(Clone, Debug, PartialEq)]
pub struct MinimumChoice {
    /// The numbers of the minima among the steps.
    pub chosen: ChosenSteps,
    /// The distance from the limits.
    pub distance: f64,
}

impl ThresholdTable {
    /// Returns true if the scores of a camera do not depend on its decisions.
    #[must_use]
    pub fn has_free_scores(config: &CameraConfig) -> bool {
        let is_reference_free = match config.temporal.reference {
            ReferencePolicy::Previous => true,
            ReferencePolicy::LastSent => false,
        };
        let has_no_summaries = match config.render.irrelevant {
            IrrelevantRendering::Zero | IrrelevantRendering::Hold => true,
            IrrelevantRendering::Mean => false,
        };
        is_reference_free && has_no_summaries
    }

    /// Creates the table of a camera whose scores do not depend on its decisions, for frames in so
    /// many groups.
    #[must_use]
    pub fn new(ideal: &Camera, candidate: &Camera, steps: MinimumSteps, groups: usize) -> Self {
        let lists = || std::iter::once(steps.counts.len()).chain(steps.scores.iter().map(Vec::len));
        assert!(lists().all(|list| list <= MAX_STEPS), "there are more than 255 minima");
        Self {
            cells: GridCells::new(ideal, candidate),
            combine: candidate.combine(),
            irrelevant: candidate.irrelevant(),
            steps,
            groups,
            regions: Vec::new(),
            areas: HashMap::new(),
        }
    }

    /// Adds a frame: the decisions of the ideal and the outcome of the candidate, region by region.
    pub fn add_frame(
        &mut self,
        ideal: &[DecisionState],
        candidate: &FrameOutcome,
        (order, group): (FrameOrder, usize),
    ) {
        let Self { cells, steps, groups, regions, areas, .. } = self;
        regions.clear();
        regions.extend((0..candidate.srs.len()).map(|region| steps.reached(candidate, region)));
        cells.for_each(|ideal_region, region, pixels| {
            let key = (ideal[ideal_region], order, regions[region]);
            areas.entry(key).or_insert_with(|| vec![0; *groups])[group] += pixels;
        });
    }

    /// Returns the least area that flips with any of the minima of one feature; with several
    /// features, the least that the search of [`Self::nearest`] finds.
    #[must_use]
    pub fn least_flips(&self) -> u64 {
        let rows = self.rows();
        let flips = |chosen: &ChosenSteps| self.sums(&rows, chosen).2;
        let start = vec![0; 1 + self.steps.scores.len()];
        let mut least = u64::MAX;
        self.for_each_neighborhood(start, |chosen| {
            let found = flips(chosen);
            let is_less = found < least;
            least = least.min(found);
            is_less
        });
        least
    }

    /// Returns the minima that are nearest to the limits, at most `most`, the nearest first, and
    /// the number of minima that were compared. The search begins at `start`.
    #[must_use]
    pub fn nearest(
        &self,
        start: ChosenSteps,
        limits: &DecisionLimits,
        most: usize,
    ) -> (Vec<MinimumChoice>, usize) {
        let rows = self.rows();
        let (mut found, mut compared): (Vec<MinimumChoice>, usize) = (Vec::new(), 0);
        self.for_each_neighborhood(start, |chosen| {
            compared += 1;
            let (rates, active, _) = self.sums(&rows, chosen);
            let distance = limits.distance(rates, active);
            let at = found.partition_point(|known| known.distance <= distance);
            if at < most && !found.iter().any(|known| known.chosen == *chosen) {
                found.insert(at, MinimumChoice { chosen: chosen.clone(), distance });
                found.truncate(most);
            }
            at == 0
        });
        (found, compared)
    }

    /// Returns the areas of the decisions with some minima, by groups of frames.
    #[must_use]
    pub fn decisions(&self, chosen: &ChosenSteps) -> Vec<DecisionAreas> {
        let mut groups = vec![DecisionAreas::default(); self.groups];
        for ((ideal, order, reached), areas) in &self.areas {
            let (srs, trs) = self.relevance(reached, chosen);
            let own = DecisionState::new(srs, trs, self.action(srs, trs));
            for (group, &area) in groups.iter_mut().zip(areas) {
                group.add_pair((*ideal, own), area, *order);
            }
        }
        groups
    }

    /// Calls `compare` for the start and for all pairs of a minimum count and a minimum score of
    /// one feature after the other, from the last minima for which it returned true, until no more
    /// are better. With one feature these are all minima.
    fn for_each_neighborhood(
        &self,
        start: ChosenSteps,
        mut compare: impl FnMut(&ChosenSteps) -> bool,
    ) {
        compare(&start);
        let mut best = start;
        loop {
            let mut is_better = false;
            for feature in 0..self.steps.scores.len() {
                let mut chosen = best.clone();
                for count in 0..self.steps.counts.len() {
                    for score in 0..self.steps.scores[feature].len() {
                        (chosen[0], chosen[1 + feature]) = (count, score);
                        if compare(&chosen) {
                            best.clone_from(&chosen);
                            is_better = true;
                        }
                    }
                }
            }
            if !is_better || self.steps.scores.len() == 1 {
                return;
            }
        }
    }

    fn rows(&self) -> Vec<TableRow> {
        let row = |((ideal, order, reached), areas): (&(_, _, ReachedSteps), &GroupAreas)| {
            let flips = [(true, true), (true, false), (false, false)].map(|(srs, trs)| {
                let own = DecisionState::new(srs, trs, self.action(srs, trs));
                let mut one = DecisionAreas::default();
                one.add_pair((*ideal, own), 1, *order);
                one.action > 0
            });
            let (is_ideal_active, is_later) = (ideal.is_active(), *order == FrameOrder::Later);
            TableRow {
                reached: *reached,
                area: areas.iter().sum(),
                is_ideal_active,
                is_later,
                flips,
            }
        };
        self.areas.iter().map(row).collect()
    }

    /// Returns the rates with some minima, the share of the area that is active, and the area that
    /// flips.
    fn sums(&self, rows: &[TableRow], chosen: &ChosenSteps) -> ([f64; 3], f64, u64) {
        let (mut all, mut flips) = (0, 0);
        let (mut ideal, mut candidate, mut both) = (0, 0, 0);
        for row in rows {
            let (srs, trs) = self.relevance(&row.reached, chosen);
            let outcome = if srs { usize::from(!trs) } else { 2 };
            let area_if = |yes: bool| if yes { row.area } else { 0 };
            all += row.area;
            flips += area_if(row.flips[outcome]);
            let (is_ideal, is_own) = (row.is_later & row.is_ideal_active, row.is_later & srs & trs);
            ideal += area_if(is_ideal);
            candidate += area_if(is_own);
            both += area_if(is_ideal & is_own);
        }
        let share = |part: u64, whole: u64| count_to_f64(part) / count_to_f64(whole.max(1));
        let (missed, false_alarms) =
            (share(ideal - both, ideal), share(candidate - both, candidate));
        ([share(flips, all), missed, false_alarms], share(candidate, all), flips)
    }

    /// Returns SRS and TRS of regions that reach some steps, with some minima.
    fn relevance(&self, reached: &ReachedSteps, chosen: &ChosenSteps) -> (bool, bool) {
        let mut votes =
            reached.iter().zip(chosen).map(|(&reached, &step)| usize::from(reached) > step);
        let trs = votes.next().unwrap_or(false);
        let srs = match self.combine {
            VoteCombination::Any => votes.any(|vote| vote),
            VoteCombination::All => votes.all(|vote| vote),
        };
        (srs, trs)
    }

    /// Returns the action of a camera that sends no summaries.
    fn action(&self, srs: bool, trs: bool) -> RegionAction {
        match (srs, trs, self.irrelevant) {
            (true, true, _) => RegionAction::Forward,
            (false, _, IrrelevantRendering::Zero) => RegionAction::Blank,
            (true, false, _)
            | (false, _, IrrelevantRendering::Hold | IrrelevantRendering::Mean) => {
                RegionAction::Hold
            }
        }
    }
}

impl MinimumSteps {
    fn reached(&self, outcome: &FrameOutcome, region: usize) -> ReachedSteps {
        let mut reached = [0; 1 + FeatureKind::COUNT];
        let number = |steps: usize| u8::try_from(steps).expect("there are at most 255 steps");
        let count = outcome.temporal_count[region];
        reached[0] = number(self.counts.partition_point(|least| *least <= count));
        for ((own, steps), scores) in reached[1..].iter_mut().zip(&self.scores).zip(&outcome.scores)
        {
            *own = number(steps.partition_point(|least| *least <= scores[region]));
        }
        reached
    }
}
