// SPDX-License-Identifier: MIT OR Apache-2.0
//! The description of a feature for programs and people that choose one ([`FeatureDescription`]).

use super::FeatureHardware;
use foveate_camera::{FeatureKind, SpatialConfig};
use serde::Serialize;

/// A feature with the defaults of its keys for pixels of 8 bits. Keys that do not apply are left
/// out of its JSON.
#[derive(Clone, Debug, Serialize)]
pub struct FeatureDescription {
    /// The quantity that the score measures, in a few words.
    pub summary: &'static str,
    /// The name of the unit of `min_score`.
    pub unit: &'static str,
    /// The name of the feature and its defaults.
    #[serde(flatten)]
    pub defaults: SpatialConfig,
    /// The names of the organizations that compute the score.
    pub organizations: Vec<&'static str>,
}

impl FeatureDescription {
    /// Returns the description of a feature.
    #[must_use]
    pub fn of_kind(kind: FeatureKind) -> Self {
        let organizations = FeatureHardware::of_kind(kind).organizations();
        Self {
            summary: kind.spec().summary,
            unit: kind.score_unit().name(),
            defaults: SpatialConfig::new(kind).with_defaults(8),
            organizations: organizations.map(|organization| organization.name()).collect(),
        }
    }
}
