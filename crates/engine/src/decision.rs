// SPDX-License-Identifier: MIT OR Apache-2.0
//! The decision: from sums to scores, votes, SRS, TRS and the action of every region of a band.

use foveate_camera::{
    Displacement, FeatureKind, IrrelevantRendering, ReferencePolicy, RegionAction, RegionClass,
    VoteCombination,
};

use super::plan::ZonePlan;
use crate::kernel::flow::{self, DisplacedErrors};
use crate::kernel::mad;
use crate::outcome::RegionResults;
use crate::plan::CameraPlan;
use crate::working_memory::RegionSums;
use foveate_pixels::vectors::VectorPixel;

impl<T: VectorPixel> CameraPlan<T> {
    /// Decides every region of one band. Regions that are not affected keep their scores, and their
    /// temporal count follows from the last frame.
    #[inline(always)]
    pub(crate) fn decide_band(
        &self,
        (sums, flow_errors): (&RegionSums, &[DisplacedErrors]),
        affected: &[bool],
        valid: &[bool],
        classes: &[RegionClass],
        results: &mut RegionResults<'_>,
    ) {
        self.update_temporal_counts(sums, affected, valid, results);
        let n = u64::from(self.region_pixels());
        for (feature, scores) in self.features.iter().zip(&mut results.scores) {
            match feature.kind {
                FeatureKind::Edge => update_affected(scores, affected, |at| sums.edge[at]),
                FeatureKind::Corner => update_affected(scores, affected, |at| sums.corner[at]),
                FeatureKind::Mad => {
                    let bits = self.passes.mad.expect("the plan has what its features need");
                    let score = |at| {
                        mad::mad_score(n, bits, sums.sum[at], sums.above[at], sums.count_above[at])
                    };
                    update_affected(scores, affected, score);
                }
                FeatureKind::Variance => {
                    update_affected(scores, affected, |at| {
                        n * sums.square[at] - sums.sum[at] * sums.sum[at]
                    });
                }
                FeatureKind::Range => update_affected(scores, affected, |at| sums.range[at]),
                FeatureKind::Surface => {
                    let [right, below, below_right, below_left] = &sums.differences;
                    let score = |at: usize| {
                        right[at].min(below[at]).min(below_right[at]).min(below_left[at])
                    };
                    update_affected(scores, affected, score);
                }
                FeatureKind::Segment => {
                    let [above, below] = &sums.segment;
                    update_affected(scores, affected, |at| above[at].min(below[at]));
                }
                FeatureKind::Flow => {
                    let regions = affected.iter().zip(valid).zip(&mut *results.displacements);
                    for (at, ((&affected, &valid), displacement)) in regions.enumerate() {
                        // A region that is not affected stands still, and its last displacement
                        // was 0: `select_runs` adds all others. So its score was 0, and stays 0.
                        if affected {
                            (*displacement, scores[at]) = match valid {
                                true => flow::best_match(flow_errors, at),
                                false => (Displacement::default(), 0),
                            };
                        }
                    }
                }
            }
        }
        self.update_srs(results);
        for (trs, &count) in results.trs.iter_mut().zip(&*results.temporal_count) {
            *trs = count >= self.min_count;
        }
        if let Some(zones) = &self.zones {
            self.apply_classes(zones, classes, results);
        }
        let bits = results.srs.iter().zip(&*results.trs);
        for (((&srs, &trs), active), action) in
            bits.zip(&mut *results.active).zip(&mut *results.actions)
        {
            *active = srs & trs;
            *action = self.choose_action(srs, trs);
        }
    }

    /// Replaces SRS and TRS of the regions whose class is not `normal`.
    #[inline(always)]
    fn apply_classes(
        &self,
        zones: &ZonePlan<T>,
        classes: &[RegionClass],
        results: &mut RegionResults<'_>,
    ) {
        for (at, &class) in classes.iter().enumerate() {
            match class {
                RegionClass::Normal => {}
                RegionClass::Off => results.srs[at] = false,
                RegionClass::Always => results.srs[at] = true,
                RegionClass::Keen => {
                    let features = zones.keen_features.iter().zip(&results.scores);
                    let mut votes =
                        features.map(|(feature, scores)| scores[at] >= feature.min_score);
                    results.srs[at] = match self.combine {
                        VoteCombination::Any => votes.any(|vote| vote),
                        VoteCombination::All => votes.all(|vote| vote),
                    };
                    results.trs[at] = results.temporal_count[at] >= zones.keen_min_count;
                }
            }
        }
    }

    /// Computes the temporal counts. The count of a region that is not affected follows from its
    /// last count and action, because its pixels are those of the last frame.
    #[inline(always)]
    fn update_temporal_counts(
        &self,
        sums: &RegionSums,
        affected: &[bool],
        valid: &[bool],
        results: &mut RegionResults<'_>,
    ) {
        let n = self.region_pixels();
        let regions = sums.changed.iter().zip(affected).zip(valid);
        let last = results.temporal_count.iter_mut().zip(&*results.actions);
        for (((&changed, &affected), &valid), (count, &action)) in regions.zip(last) {
            let changed = u32::try_from(changed).expect("no more than the pixels of a region");
            *count = match affected {
                true => {
                    if valid {
                        changed
                    } else {
                        n
                    }
                }
                false => self.count_of_identical((action, *count), n),
            };
        }
    }

    /// Computes SRS from the scores.
    #[inline(always)]
    fn update_srs(&self, results: &mut RegionResults<'_>) {
        let srs = &mut *results.srs;
        srs.fill(self.combine == VoteCombination::All);
        for (feature, scores) in self.features.iter().zip(&results.scores) {
            let votes = scores.iter().map(|&score| score >= feature.min_score);
            match self.combine {
                VoteCombination::Any => {
                    srs.iter_mut().zip(votes).for_each(|(srs, vote)| *srs |= vote);
                }
                VoteCombination::All => {
                    srs.iter_mut().zip(votes).for_each(|(srs, vote)| *srs &= vote);
                }
            }
        }
    }

    /// Returns the temporal count of a region whose denoised pixels are those of the previous
    /// frame. The action of that frame determines the count, because after it the reference equals
    /// these pixels, is unchanged, or is not valid.
    #[inline(always)]
    fn count_of_identical(&self, (action, count): (RegionAction, u32), n: u32) -> u32 {
        match (self.reference, action) {
            (ReferencePolicy::Previous, _) | (ReferencePolicy::LastSent, RegionAction::Forward) => {
                0
            }
            (ReferencePolicy::LastSent, RegionAction::Hold) => count,
            (ReferencePolicy::LastSent, RegionAction::Blank | RegionAction::Summarize) => n,
        }
    }

    #[inline(always)]
    fn choose_action(&self, srs: bool, trs: bool) -> RegionAction {
        match (srs, trs) {
            (true, true) => RegionAction::Forward,
            (true, false) => RegionAction::Hold,
            (false, _) => match self.irrelevant {
                IrrelevantRendering::Zero => RegionAction::Blank,
                // The periphery decides afterwards, from these actions, which summaries are sent.
                IrrelevantRendering::Hold | IrrelevantRendering::Mean => RegionAction::Hold,
            },
        }
    }
}

/// Writes new scores for affected regions. The other regions have the same pixels and the same
/// scores as before.
#[inline(always)]
fn update_affected(scores: &mut [u64], affected: &[bool], new: impl Fn(usize) -> u64) {
    for (at, (score, &affected)) in scores.iter_mut().zip(affected).enumerate() {
        if affected {
            *score = new(at);
        }
    }
}
