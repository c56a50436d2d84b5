// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scaling of thresholds, as if the contrast of the scene were scaled.

use foveate_camera::{CameraConfig, Decimal};

/// Multiplies every threshold of the task in grey levels by `2^octaves`.
pub(super) fn scale_thresholds(task: &CameraConfig, octaves: f64) -> CameraConfig {
    scale_thresholds_by(task, octaves, octaves)
}

/// Multiplies the thresholds of features by `2^spatial` and the temporal level by `2^temporal`.
pub(super) fn scale_thresholds_by(
    task: &CameraConfig,
    spatial: f64,
    temporal: f64,
) -> CameraConfig {
    let scale = |octaves: f64| move |level: u32| round_to_level(f64::from(level) * octaves.exp2());
    let (level, changed) = (scale(spatial), scale(temporal));
    let factor = spatial.exp2();
    let mut config = task.clone();
    let bits = task.frame.pixel_bits;
    config.temporal.level = Some(changed(config.temporal.level_or_default(bits)));
    for entry in &mut config.spatial {
        *entry = entry.with_defaults(bits);
        let measure = entry.feature.score_unit();
        entry.level = entry.level.map(level);
        if !measure.is_count() {
            // Deviations scale with the contrast, and their squares with its square.
            let factor = (0..measure.scaling_exponent()).map(|_| factor).product::<f64>();
            let scale = |score: Decimal| {
                let score: f64 = score.to_string().parse().expect("a decimal is a number");
                Decimal::from_f64((score * factor * 1000.0).round() / 1000.0)
            };
            entry.min_score = entry.min_score.and_then(scale);
        }
    }
    config
}

/// Returns the nearest whole number, within the range of a level.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before")]
fn round_to_level(value: f64) -> u32 {
    value.round().clamp(0.0, f64::from(u32::MAX)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaling_is_of_grey_levels_and_of_their_squares() {
        let text = "[[spatial]]\nfeature = \"edge\"\n[[spatial]]\nfeature = \"mad\"\n[[spatial]]\nfeature = \"variance\"\n";
        let twice = scale_thresholds(&CameraConfig::from_toml(text).unwrap(), 1.0);
        assert_eq!((twice.temporal.level, twice.temporal.min_count), (Some(16), 5));
        assert_eq!(twice.spatial[0].level, Some(200));
        let scores: Vec<String> =
            twice.spatial.iter().map(|entry| entry.min_score.unwrap().to_string()).collect();
        assert_eq!(scores, ["5", "10", "200"]);
    }
}
