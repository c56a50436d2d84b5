// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate features`: the spatial features with their units, defaults and organizations.

use foveate_camera::{FeatureKind, SpatialConfig};
use foveate_design::Organization;
use serde::Serialize;

use crate::args::FeaturesArgs;
use crate::error::CliError;
use crate::output;

#[derive(Serialize)]
struct FeatureListing {
    format_version: u32,
    features: Vec<FeatureEntry>,
}

/// A feature with the defaults of its keys for pixels of 8 bits.
#[derive(Serialize)]
struct FeatureEntry {
    summary: &'static str,
    unit: &'static str,
    #[serde(flatten)]
    defaults: SpatialConfig,
    organizations: Vec<&'static str>,
}

pub(crate) fn run(args: &FeaturesArgs) -> Result<(), CliError> {
    let features = FeatureKind::ALL.iter().map(|&kind| FeatureEntry::of_kind(kind)).collect();
    let listing = FeatureListing { format_version: 1, features };
    output::print_result((args.json, false), &listing, || {
        listing.features.iter().map(FeatureEntry::text).collect()
    })
}

impl FeatureEntry {
    fn of_kind(kind: FeatureKind) -> Self {
        let supports = |one: &&Organization| one.feature_kinds().contains(&kind);
        Self {
            summary: kind.spec().summary,
            unit: kind.score_unit().name(),
            defaults: SpatialConfig::new(kind).with_defaults(8),
            organizations: Organization::ALL
                .iter()
                .filter(supports)
                .map(|one| one.name())
                .collect(),
        }
    }

    fn text(&self) -> String {
        let SpatialConfig { feature, level, min_score, .. } = &self.defaults;
        let level = level.map_or_else(String::new, |level| format!("level {level}, "));
        let minimum = min_score.as_ref().map_or_else(String::new, ToString::to_string);
        format!(
            "{feature:10}{}; {level}min_score {minimum} {}; {}\n",
            self.summary,
            self.unit,
            self.organizations.join(", ")
        )
    }
}
