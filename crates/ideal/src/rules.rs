// SPDX-License-Identifier: MIT OR Apache-2.0
//! Thresholds and decisions, as the configuration writes them.

use foveate_camera::Action;
use foveate_camera::{Camera, Combine, Decimal, FeatureKind, Irrelevant};

/// One feature.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Feature {
    pub(crate) kind: FeatureKind,
    /// Per pixel, in grey levels; 0 where the feature has none.
    pub(crate) level: f64,
    /// Per region, in the unit of the score.
    min_score: f64,
}

/// When a region is relevant, and what becomes of it.
#[derive(Clone, Debug)]
pub(crate) struct Rules {
    pub(crate) features: Vec<Feature>,
    combine: Combine,
    /// A pixel has changed when it differs by more grey levels than this.
    pub(crate) level: f64,
    min_count: f64,
    irrelevant: Irrelevant,
}

impl Rules {
    pub(crate) fn of(camera: &Camera) -> Self {
        let feature = |entry: &foveate_camera::SpatialConfig| Feature {
            kind: entry.feature,
            // A feature that counts no hits does not ask for it.
            level: f64::from(entry.level.unwrap_or(0)),
            min_score: real(entry.min_score.expect("a camera has every key filled in")),
        };
        Self {
            features: camera.config().spatial.iter().map(feature).collect(),
            combine: camera.combine(),
            level: f64::from(camera.temporal().level),
            min_count: f64::from(camera.temporal().min_count),
            irrelevant: camera.irrelevant(),
        }
    }

    /// SRS of a region from its scores by feature.
    pub(crate) fn spatial(&self, scores: &[Vec<f64>], region: usize) -> bool {
        let mut votes =
            self.features.iter().zip(scores).map(|(rule, all)| all[region] >= rule.min_score);
        match self.combine {
            Combine::Any => votes.any(|vote| vote),
            Combine::All => votes.all(|vote| vote),
        }
    }

    /// TRS of a region from its changed pixels.
    pub(crate) fn temporal(&self, changed: f64) -> bool {
        changed >= self.min_count
    }

    /// What becomes of a region on the screen; `is_summary_due` is asked only where irrelevant regions send their means.
    pub(crate) fn action(
        &self,
        srs: bool,
        trs: bool,
        is_summary_due: impl FnOnce() -> bool,
    ) -> Action {
        match (srs, trs, self.irrelevant) {
            (true, true, _) => Action::Forward,
            (true, false, _) | (false, _, Irrelevant::Hold) => Action::Hold,
            (false, _, Irrelevant::Zero) => Action::Blank,
            (false, _, Irrelevant::Mean) if is_summary_due() => Action::Summarize,
            (false, _, Irrelevant::Mean) => Action::Hold,
        }
    }
}

/// The nearest `f64`; a decimal prints as digits that are one.
fn real(decimal: Decimal) -> f64 {
    decimal.to_string().parse().expect("a decimal is written as a number")
}
