// SPDX-License-Identifier: MIT OR Apache-2.0
//! From sums to scores, votes, both relevances and the action of every region of a band.

use foveate_model::Action;
use foveate_spec::{Combine, FeatureKind, Irrelevant, Reference};

use crate::kernel::mad;
use crate::lane::Lane;
use crate::outcome::Results;
use crate::plan::{Feature, Plan};
use crate::scratch::Sums;

impl<T: Lane> Plan<T> {
    /// Decides every region of one band; those that are not affected keep their scores, and their
    /// temporal count is what it must be when no pixel has changed.
    #[inline(always)]
    pub(crate) fn decide(
        &self,
        sums: &Sums,
        affected: &[bool],
        valid: &[bool],
        results: &mut Results<'_>,
    ) {
        let n = self.region_pixels();
        for at in 0..self.columns {
            if affected[at] {
                let changed = u32::try_from(sums.changed[at]).unwrap_or(n);
                results.temporal_count[at] = if valid[at] { changed } else { n };
                for (feature, scores) in self.features.iter().zip(&mut results.scores) {
                    scores[at] = self.score(*feature, sums, at);
                }
                results.srs[at] = self.votes(results, at);
            } else {
                let last = (results.actions[at], results.temporal_count[at]);
                results.temporal_count[at] = self.count_of_identical(last, n);
            }
            let (srs, trs) = (results.srs[at], results.temporal_count[at] >= self.min_count);
            results.trs[at] = trs;
            results.active[at] = srs && trs;
            results.actions[at] = self.action(srs, trs);
        }
    }

    #[inline(always)]
    fn score(&self, feature: Feature, sums: &Sums, at: usize) -> u64 {
        let n = u64::from(self.region_pixels());
        match feature.kind {
            FeatureKind::Edge => sums.edge[at],
            FeatureKind::Corner => sums.corner[at],
            FeatureKind::Mad => {
                let fraction_bits = self.mad.unwrap_or_default();
                mad::score(n, fraction_bits, sums.sum[at], sums.above[at], sums.over[at])
            }
            FeatureKind::Variance => n * sums.square[at] - sums.sum[at] * sums.sum[at],
        }
    }

    #[inline(always)]
    fn votes(&self, results: &Results<'_>, at: usize) -> bool {
        let mut votes = self
            .features
            .iter()
            .zip(&results.scores)
            .map(|(feature, scores)| scores[at] >= feature.min_score);
        match self.combine {
            Combine::Any => votes.any(|vote| vote),
            Combine::All => votes.all(|vote| vote),
        }
    }

    /// The temporal count of a region whose denoised pixels are those of the frame before, from
    /// what happened then: its reference is now those very pixels, or what it was, or none.
    #[inline(always)]
    fn count_of_identical(&self, (action, count): (Action, u32), n: u32) -> u32 {
        match (self.reference, action) {
            (Reference::Previous, _) | (Reference::LastSent, Action::Forward) => 0,
            (Reference::LastSent, Action::Hold) => count,
            (Reference::LastSent, Action::Blank) => n,
        }
    }

    #[inline(always)]
    fn action(&self, srs: bool, trs: bool) -> Action {
        match (srs, trs) {
            (true, true) => Action::Forward,
            (true, false) => Action::Hold,
            (false, _) => match self.irrelevant {
                Irrelevant::Zero => Action::Blank,
                Irrelevant::Hold => Action::Hold,
            },
        }
    }
}
