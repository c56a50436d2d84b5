// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a page is told, so that it has no range of its own: the facts about a camera
//! ([`camera_facts`]), and the description of what it can offer, as presets, scenes, keys with
//! their values, and features with their defaults ([`page_description`]), from the tables that the
//! command uses.

use super::limits::{MAX_CAMERAS, MAX_NETWORK_FILE, MAX_PIXELS, MAX_RECORDING};
use foveate_camera::toml_text::TomlConfig as _;
use foveate_camera::{
    AcceptedValues, CameraConfig, ConfigError, ConfigKey, FeatureKind, IrrelevantRendering,
    KeyBound,
};
use foveate_design::{Design, DesignConfig, FeatureDescription, PRESETS};
use foveate_pixels::Scene;
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

/// Returns the whole description.
pub(crate) fn page_description() -> Result<Value, ConfigError> {
    let defaults = defaults()?;
    let presets = PRESETS.iter().map(
        |preset| json!({ "name": preset.name, "summary": preset.summary, "toml": preset.toml }),
    );
    let scenes = Scene::ALL.iter().map(|scene| {
        json!({ "name": scene.name(), "summary": scene.summary(), "frames": scene.default_frames() })
    });
    let keys = DesignConfig::keys().map(|key| described_key(key, &defaults));
    let features = FeatureKind::ALL.iter().map(|&kind| FeatureDescription::of_kind(kind));
    Ok(json!({
        "version": env!("CARGO_PKG_VERSION"),
        "presets": presets.collect::<Vec<_>>(),
        "scenes": scenes.collect::<Vec<_>>(),
        "keys": keys.collect::<Vec<_>>(),
        "features": features.collect::<Vec<_>>(),
        "limits": { "cameras": MAX_CAMERAS, "pixels": MAX_PIXELS, "network_bytes": MAX_NETWORK_FILE, "recording_bytes": MAX_RECORDING },
    }))
}

/// Returns the default camera with every key. The keys of a periphery are included, although the
/// default has no periphery.
fn defaults() -> Result<Value, ConfigError> {
    let design = DesignConfig::default().validate()?;
    let mut shown = CameraConfig::default();
    shown.render.irrelevant = IrrelevantRendering::Mean;
    let mut defaults = json!(design.config());
    defaults["periphery"] = json!(shown.validate()?.config().periphery);
    Ok(defaults)
}

/// Describes a key: its kind, its values in words, its range or choices if these depend on no other
/// key, and its default.
fn described_key((key, values): &ConfigKey, defaults: &Value) -> Value {
    let path = format!("/{}", key.replacen("spatial.", "spatial.0.", 1).replace('.', "/"));
    let mut told =
        json!({ "key": key, "takes": values.to_string(), "default": defaults.pointer(&path) });
    match values {
        AcceptedValues::Whole(range) => {
            told["kind"] = json!("whole");
            (told["min"], told["max"]) = (json!(range.start()), json!(range.end()));
        }
        AcceptedValues::Names(names) => {
            (told["kind"], told["choices"]) = (json!("choice"), json!(names));
        }
        AcceptedValues::Text(_) => told["kind"] = json!("text"),
    }
    told
}
