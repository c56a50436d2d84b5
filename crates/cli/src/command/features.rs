// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate features`: the spatial features with their units, defaults and organizations.

use foveate_camera::{FeatureKind, SpatialConfig};
use foveate_design::FeatureDescription;
use serde::Serialize;

use crate::args::FeaturesArgs;
use crate::error::CliError;
use crate::output;

#[derive(Serialize)]
struct FeatureListing {
    format_version: u32,
    features: Vec<FeatureDescription>,
}

pub(crate) fn run(args: &FeaturesArgs) -> Result<(), CliError> {
    let kinds = FeatureKind::ALL.iter();
    let features = kinds.map(|&kind| FeatureDescription::of_kind(kind)).collect();
    let listing = FeatureListing { format_version: 1, features };
    output::print_result((args.json, false), &listing, || {
        listing.features.iter().map(text).collect()
    })
}

fn text(described: &FeatureDescription) -> String {
    let SpatialConfig { feature, level, min_score, .. } = &described.defaults;
    let level = level.map_or_else(String::new, |level| format!("level {level}, "));
    let minimum = min_score.as_ref().map_or_else(String::new, ToString::to_string);
    format!(
        "{feature:10}{}; {level}min_score {minimum} {}; {}\n",
        described.summary,
        described.unit,
        described.organizations.join(", ")
    )
}
