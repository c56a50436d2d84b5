// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of thresholds in grey levels at different depths of pixels.

use std::ops::RangeInclusive;

use foveate_camera::{CameraConfig, Decimal, FeatureKind, SpatialConfig, SpatialFeature};
use foveate_design::{Design, DesignConfig, Organization, PRESETS};

fn config_with(text: &str, overrides: &[&str]) -> DesignConfig {
    DesignConfig::from_toml_with(text, overrides).unwrap()
}

fn design(text: &str, overrides: &[&str]) -> Design {
    config_with(text, overrides).validate().unwrap()
}

fn refusal(text: &str, overrides: &[&str]) -> String {
    config_with(text, overrides).validate().unwrap_err().to_string()
}

/// Returns the name and the text of every preset, and of a configuration for every feature alone
/// with its default thresholds.
fn base_configs() -> Vec<(String, String)> {
    let presets = PRESETS.iter().map(|preset| (preset.name.to_owned(), preset.toml.to_owned()));
    let features =
        FeatureKind::ALL.iter().map(|&kind| (format!("feature {kind}"), config_of_feature(kind)));
    presets.chain(features).collect()
}

/// Returns the text of a configuration with one feature, in the default organization if that has
/// the feature.
fn config_of_feature(kind: FeatureKind) -> String {
    let feature = format!("[[spatial]]\nfeature = \"{kind}\"\n");
    if Organization::Pipelined.feature_kinds().contains(&kind) {
        return feature;
    }
    format!("{feature}[hardware]\norganization = \"serial\"\n")
}

/// Returns the depths at which the defaults are valid. The default mean of `segment` has no
/// fraction bits, and pixels of 1 bit need one.
fn valid_depths(text: &str) -> RangeInclusive<u32> {
    if text.contains("segment") { 2..=16 } else { 1..=16 }
}

/// Fingerprints are written to generated cores and to results. They change only if the text of a
/// configuration does, which the changelog then says.
#[test]
fn fingerprints_of_8_bits_do_not_change() {
    let expected = [
        ("paper", "01f4289644ba258c"),
        ("bare", "c17e3d8addddce81"),
        ("corner", "c03b8ea4808a157a"),
        ("mad", "e1a7a23bb6565b8e"),
        ("steady", "58cf1eaacddd3ef1"),
        ("fovea", "1843016389d5517d"),
        ("seamless", "ee321534ea4827c2"),
        ("serial", "a870875c0d8107ae"),
        ("raster", "c9c646f6e33b4e80"),
        ("feature edge", "01f4289644ba258c"),
        ("feature corner", "8e01518590eb7e86"),
        ("feature mad", "a981aba3ff9adc74"),
        ("feature variance", "a4010676e4d65b40"),
        ("feature range", "89dfcf11d0e58a37"),
        ("feature surface", "a15808c24da4c046"),
        ("feature segment", "379a073ec4a1fb83"),
        ("feature flow", "afbf775e47dc8e31"),
    ];
    let found: Vec<(String, String)> = base_configs()
        .into_iter()
        .map(|(name, text)| (name, design(&text, &[]).fingerprint()))
        .collect();
    let expected: Vec<(String, String)> =
        expected.map(|(name, print)| (name.to_owned(), print.to_owned())).into();
    assert_eq!(found, expected);
}

#[test]
fn defaults_follow_the_depth_and_are_within_reach_at_every_one() {
    for (name, text) in base_configs() {
        let eight = design(&text, &[]);
        for bits in valid_depths(&text) {
            let own = design(&text, &[&format!("frame.pixel_bits={bits}")]);
            // A level is the same fraction of 2^P as the level at 8 bits is of 256, rounded down to
            // a whole level.
            let near = |level: u32, of_8: u32| {
                let exact = f64::from(of_8) * f64::from(own.pixel_max() + 1) / 256.0;
                (f64::from(level)..f64::from(level) + 1.0).contains(&exact)
            };
            let temporal = own.temporal().level;
            assert!(temporal < own.pixel_max(), "{name}, {bits} bits");
            assert!(near(temporal, eight.temporal().level), "{name}, {bits}: {temporal}");
            for (feature, of_8) in own.features().iter().zip(eight.features()) {
                assert!(feature.min_score() <= feature.score_max(), "{name}, {bits} bits");
                if let (Some(level), Some(of_8)) = (feature.level(), of_8.level()) {
                    assert!(near(level, of_8), "{name}, {bits} bits: {level}");
                }
            }
        }
    }
}

#[test]
fn defaults_of_some_depths_by_hand() {
    let at = |bits: u32| {
        let mut config = CameraConfig::default();
        config.frame.pixel_bits = bits;
        config.spatial = FeatureKind::ALL.iter().map(|&kind| SpatialConfig::new(kind)).collect();
        for entry in config.spatial.iter_mut().filter(|entry| entry.has_mean_fraction()) {
            entry.mean_fraction_bits = Some(1);
        }
        let camera = config.validate().unwrap();
        let mut levels = vec![camera.temporal().level];
        levels.extend(camera.features().iter().filter_map(SpatialFeature::level));
        let entries = camera.config().spatial.iter();
        let minima = entries.map(|entry| entry.min_score.unwrap().to_string());
        (levels, minima.collect::<Vec<_>>())
    };
    // The levels are those of `temporal`, `edge`, `corner` and `segment`. The minima are those of
    // all features in the order of the documentation.
    let row =
        |levels: [u32; 4], minima: [&str; 8]| (levels.to_vec(), minima.map(str::to_owned).to_vec());
    assert_eq!(at(8), row([8, 100, 20, 8], ["5", "5", "5", "50", "20", "5", "8", "2"]));
    assert_eq!(
        at(5),
        row([1, 12, 2, 1], ["5", "5", "0.625", "0.78125", "2.5", "0.625", "8", "0.25"])
    );
    assert_eq!(
        at(1),
        row(
            [0; 4],
            ["5", "5", "0.0390625", "0.003051758", "0.15625", "0.0390625", "8", "0.015625"]
        )
    );
    assert_eq!(at(10), row([32, 400, 80, 32], ["5", "5", "20", "800", "80", "20", "8", "8"]));
    assert_eq!(
        at(16),
        row([2048, 25_600, 5_120, 2048], ["5", "5", "1280", "3276800", "5120", "1280", "8", "512"])
    );
}

#[test]
fn a_file_with_every_key_follows_an_override_of_the_depth() {
    for (name, text) in base_configs() {
        let every_key = design(&text, &[]).config();
        for bits in valid_depths(&text) {
            let bits = format!("frame.pixel_bits={bits}");
            let short = design(&text, &[&bits]);
            assert_eq!(design(&every_key.to_toml(), &[&bits]), short, "{name}, {bits}");
        }
    }
}

#[test]
fn what_is_written_is_in_levels_of_the_depth_that_it_is_written_with() {
    let five = "[frame]\npixel_bits = 5\n[temporal]\nlevel = 2\n";
    assert_eq!(design(five, &[]).temporal().level, 2);
    assert_eq!(design(five, &["frame.pixel_bits=8"]).temporal().level, 16);
    assert_eq!(design(five, &["frame.pixel_bits=8", "temporal.level=3"]).temporal().level, 3);
    assert_eq!(design("", &["frame.pixel_bits=5", "temporal.level=3"]).temporal().level, 3);
    assert_eq!(design("", &["temporal.level=3", "frame.pixel_bits=5"]).temporal().level, 3);
    // A table that replaces all of `frame` has the default depth.
    assert_eq!(design(five, &["frame={width=64}"]).temporal().level, 16);
    let scores = "[[spatial]]\nfeature = \"variance\"\nmin_score = 8\n";
    let six = config_with(scores, &["frame.pixel_bits=6"]);
    assert_eq!(six.camera.spatial[0].min_score, Decimal::from_f64(0.5));
    // An error message shows the value of the file, whatever the depth.
    let wrong =
        DesignConfig::from_toml_with("[temporal]\nlevel = \"high\"\n", &["frame.pixel_bits=5"]);
    assert!(wrong.unwrap_err().to_string().contains("`temporal.level`: \"high\" is not valid"));
}

#[test]
fn what_no_pixel_can_reach_is_refused_with_the_value_to_use() {
    let five = "frame.pixel_bits=5";
    for (overrides, message) in [
        (
            [five, "temporal.level=40"],
            "`temporal.level` = 40 is out of range; the valid range is 0..=30 for pixels of 5 bits, which differ by at most 31; 40 at 8 bits is 5 at 5 bits",
        ),
        (
            ["frame.pixel_bits=8", "temporal.level=255"],
            "`temporal.level` = 255 is out of range; the valid range is 0..=254 for pixels of 8 bits, which differ by at most 255",
        ),
        (
            ["frame.pixel_bits=3", "spatial.0.level=100"],
            "`spatial[0].level` = 100 is out of range; the valid range is 0..=41 (pixels of 3 bits reach 42) for `edge`; 100 at 8 bits is 3 at 3 bits",
        ),
        (
            [five, "spatial=[{feature=\"corner\",level=31}]"],
            "`spatial[0].level` = 31 is out of range; the valid range is 0..=30 (pixels of 5 bits reach 31) for `corner`; 31 at 8 bits is 3 at 5 bits",
        ),
        (
            [five, "spatial=[{feature=\"segment\",level=31}]"],
            "`spatial[0].level` = 31 is out of range; the valid range is 0..=14 (pixels of 5 bits reach 31, and some must be above and some below their mean) for `segment`; 31 at 8 bits is 3 at 5 bits",
        ),
        (
            [five, "spatial=[{feature=\"segment\",min_score=33}]"],
            "`spatial[0].min_score` = 33 is out of range; the valid range is 0..=32 for `segment`",
        ),
        (
            [five, "spatial=[{feature=\"surface\",min_score=40}]"],
            "`spatial[0].min_score` = 40 is out of range; the valid range is 0..=31 for `surface`; 40 at 8 bits is 5 at 5 bits",
        ),
        (
            [five, "spatial=[{feature=\"mad\",min_score=20}]"],
            "`spatial[0].min_score` = 20 is out of range; the valid range is 0..=15.5 for `mad`; 20 at 8 bits is 2.5 at 5 bits",
        ),
        (
            [five, "spatial=[{feature=\"variance\",min_score=300}]"],
            "`spatial[0].min_score` = 300 is out of range; the valid range is 0..=240.25 for `variance`; 300 at 8 bits is 4.6875 at 5 bits",
        ),
        (
            [five, "spatial.0.min_score=65"],
            "`spatial[0].min_score` = 65 is out of range; the valid range is 0..=64 for `edge`",
        ),
    ] {
        assert_eq!(refusal("", &overrides), message);
    }
}

/// A region has pixels above and pixels below its mean by more than a level only if the level is
/// less than half of the range of pixels. With the largest valid level such a region exists.
#[test]
fn the_level_of_segment_leaves_room_on_both_sides_of_the_mean() {
    let range = |level: u32, bits: u32, fraction: u32| {
        let entry = format!(
            "spatial=[{{feature='segment',level={level},min_score=1,mean_fraction_bits={fraction}}}]"
        );
        config_with("", &[&format!("frame.pixel_bits={bits}"), &entry]).validate()
    };
    for (bits, fraction, largest) in
        [(8, 0, 126), (8, 1, 127), (8, 6, 127), (2, 0, 0), (2, 3, 1), (1, 1, 0), (16, 0, 32_766)]
    {
        assert!(range(largest, bits, fraction).is_ok(), "{bits} {fraction}");
        let refused = range(largest + 1, bits, fraction).unwrap_err().to_string();
        assert!(refused.contains(&format!("the valid range is 0..={largest} (")), "{refused}");
        assert!(some_region_votes(largest, bits, fraction), "{bits} {fraction}");
        assert!(!some_region_votes(largest + 1, bits, fraction), "{bits} {fraction}");
    }
    assert_eq!(
        range(0, 1, 0).unwrap_err().to_string(),
        "`spatial[0].mean_fraction_bits` = 0 cannot be combined with frame.pixel_bits = 1, because no region would have pixels on both sides of its mean; set mean_fraction_bits = 1 or more in every feature that has this key"
    );
    let always = "spatial=[{feature='segment',level=1,min_score=0}]";
    assert!(config_with("", &["frame.pixel_bits=1", always]).validate().is_ok());
}

/// Returns true if `segment` has a score above 0 in some region of 64 pixels, by the formula of the
/// contract. If any region has one, so has a region of black and white pixels and one grey pixel.
fn some_region_votes(level: u32, bits: u32, fraction: u32) -> bool {
    let (max, unit) = ((1_u64 << bits) - 1, 1_u64 << fraction);
    let level = u64::from(level);
    (1..63).any(|white| {
        (0..=max.min(300)).any(|grey| {
            let sum = white * max + grey;
            let mean = (unit * sum + 32) / 64;
            unit * max > mean + unit * level && unit * level < mean
        })
    })
}

/// If a score passes its minimum without any hit, its level has no effect and may be any value that
/// its port holds.
#[test]
fn a_level_that_decides_nothing_may_be_the_largest() {
    let temporal = design("", &["temporal.level=255", "temporal.min_count=0"]);
    assert_eq!(temporal.temporal().level, 255);
    let spatial = design("", &["spatial.0.level=1530", "spatial.0.min_score=0"]);
    assert_eq!(spatial.features()[0].level(), Some(1530));
    assert!(refusal("", &["spatial.0.level=1531", "spatial.0.min_score=0"]).contains("0..=1530"));
}
