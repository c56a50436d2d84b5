// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thresholds and decisions, with the decimal numbers of the configuration.

use foveate_camera::RegionAction;
use foveate_camera::{Camera, Decimal, FeatureKind, IrrelevantRendering, VoteCombination};

/// A spatial feature and its thresholds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FeatureRule {
    pub(crate) kind: FeatureKind,
    /// The level of a pixel in grey levels; 0 for a feature without a level.
    pub(crate) level: f64,
    /// The radius of the search in pixels; 0 for a feature without a search.
    pub(crate) radius: u32,
    /// The minimum score of a region, in the unit of the score.
    min_score: f64,
}

/// The rules that decide the relevance of a region and its action on the screen.
#[derive(Clone, Debug)]
pub(crate) struct DecisionRules {
    pub(crate) features: Vec<FeatureRule>,
    combine: VoteCombination,
    /// The temporal level: a pixel has changed if it differs by more grey levels than this.
    pub(crate) level: f64,
    min_count: f64,
    irrelevant: IrrelevantRendering,
}

impl DecisionRules {
    pub(crate) fn from_camera(camera: &Camera) -> Self {
        let feature = |entry: &foveate_camera::SpatialConfig| FeatureRule {
            kind: entry.feature,
            // A feature without a level ignores it.
            level: f64::from(entry.level.unwrap_or(0)),
            radius: entry.radius.unwrap_or(0),
            min_score: decimal_to_f64(entry.min_score.expect("a camera has every key filled in")),
        };
        Self {
            features: camera.config().spatial.iter().map(feature).collect(),
            combine: camera.combine(),
            level: f64::from(camera.temporal().level),
            min_count: f64::from(camera.temporal().min_count),
            irrelevant: camera.irrelevant(),
        }
    }

    /// Returns the SRS of a region from its scores of all features.
    pub(crate) fn srs(&self, scores: &[Vec<f64>], region: usize) -> bool {
        let mut votes =
            self.features.iter().zip(scores).map(|(rule, all)| all[region] >= rule.min_score);
        match self.combine {
            VoteCombination::Any => votes.any(|vote| vote),
            VoteCombination::All => votes.all(|vote| vote),
        }
    }

    /// Returns the TRS of a region from its number of changed pixels.
    pub(crate) fn trs(&self, changed: f64) -> bool {
        changed >= self.min_count
    }

    /// Returns the action for a region. It calls `is_summary_due` only where irrelevant regions
    /// send their means.
    pub(crate) fn action(
        &self,
        srs: bool,
        trs: bool,
        is_summary_due: impl FnOnce() -> bool,
    ) -> RegionAction {
        match (srs, trs, self.irrelevant) {
            (true, true, _) => RegionAction::Forward,
            (true, false, _) | (false, _, IrrelevantRendering::Hold) => RegionAction::Hold,
            (false, _, IrrelevantRendering::Zero) => RegionAction::Blank,
            (false, _, IrrelevantRendering::Mean) if is_summary_due() => RegionAction::Summarize,
            (false, _, IrrelevantRendering::Mean) => RegionAction::Hold,
        }
    }
}

/// Returns the nearest `f64`. Every decimal is printed with digits that parse as a number.
fn decimal_to_f64(decimal: Decimal) -> f64 {
    decimal.to_string().parse().expect("a decimal is written as a number")
}
