// SPDX-License-Identifier: MIT OR Apache-2.0
//! The facts about a camera that a page gets.

use foveate_camera::KeyBound;
use foveate_design::Design;
use serde_json::{Map, Value, json};

/// Returns every key with its value, the sizes that follow, and the possible values of each key
/// while the others stay.
pub(crate) fn camera_facts(design: &Design) -> Value {
    let config = design.config();
    let features = design.features().iter().map(|feature| feature.kind().name());
    json!({
        "toml": config.to_toml(),
        "config": config,
        "fingerprint": design.fingerprint(),
        "width": design.width(),
        "height": design.height(),
        "columns": design.columns(),
        "rows": design.rows(),
        "side": design.region_size(),
        "bits": design.pixel_bits(),
        "features": features.collect::<Vec<_>>(),
        "organization": design.organization().name(),
        "raw_bits_per_frame": u64::from(design.width()) * u64::from(design.height()) * u64::from(design.pixel_bits()),
        "bounds": design.bounds().into_iter().map(|(key, bound)| (key, described_bound(bound))).collect::<Map<_, _>>(),
    })
}

fn described_bound(bound: KeyBound) -> Value {
    match bound {
        KeyBound::Maximum { largest, whole } => {
            json!({ "kind": if whole { "whole" } else { "decimal" }, "min": 0, "max": largest })
        }
        KeyBound::OneOf(values) => json!({ "kind": "choice", "choices": values }),
    }
}
