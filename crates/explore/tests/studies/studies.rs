// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every study over small scenes with known results.

use std::fs;

use crate::support::{cells, config, run};
use foveate_camera::FeatureKind;
use foveate_design::{DesignConfig, Organization};
use foveate_explore::studies::Study;

#[test]
fn the_temporal_table_of_known_scenes_is_golden() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let config = config("region.size=8");
    // Independent pixels are always active. A frame of one grey level is never relevant. A fade of
    // one level per frame never changes, however long it lasts.
    let report =
        run(Study::Temporal, &["scene:random", "scene:zero", "scene:fade"], &config, &out).unwrap();
    assert_eq!(report.files, ["temporal.csv", "temporal.svg", "temporal.png"]);
    let fingerprint = config.validate().unwrap().fingerprint();
    let clip = |name: &str| {
        format!("# {name}: design {fingerprint}, 32x16 pixels, 5 frames, inputs scene:{name}\n")
    };
    let expected = format!(
        "# foveate {} analyze temporal\n{}{}{}\
         clip,frames,regions,active_mean,active_min,active_max,srs_share,trs_share,design\n\
         random,5,8,1.000000,1.000000,1.000000,1.000000,1.000000,{fingerprint}\n\
         zero,5,8,0.000000,0.000000,0.000000,0.000000,0.000000,{fingerprint}\n\
         fade,5,8,0.000000,0.000000,0.000000,1.000000,0.000000,{fingerprint}\n",
        env!("CARGO_PKG_VERSION"),
        clip("random"),
        clip("zero"),
        clip("fade"),
    );
    assert_eq!(fs::read_to_string(out.join("temporal.csv")).unwrap(), expected);
}

#[test]
fn activity_has_a_row_per_frame_and_clip() {
    let dir = tempfile::tempdir().unwrap();
    let config = config("region.size=8");
    let out = dir.path().join("out");
    let report = run(Study::Activity, &["scene:zero", "scene:random"], &config, &out).unwrap();
    assert_eq!(cells(&report, "frame"), ["0", "1", "2", "3", "4", "0", "1", "2", "3", "4"]);
    assert_eq!(cells(&report, "t_us")[..3], ["0", "33333", "66667"]);
    let trs = cells(&report, "trs_share");
    assert_eq!((trs[0], trs[1], trs[6]), ("1.000000", "0.000000", "1.000000"));
    assert_eq!(report.files.len(), 1 + 2 * 3);
}

#[test]
fn redundancy_and_histogram_of_plain_and_striped_frames() {
    let dir = tempfile::tempdir().unwrap();
    let config = config("denoise.filter='none'");
    let out = dir.path().join("out");
    let inputs = ["scene:zero", "scene:checkerboard"];
    let report = run(Study::Redundancy, &inputs, &config, &out).unwrap();
    for feature in ["mad", "variance"] {
        assert_eq!(cells(&report, feature), ["1.000000", "0.000000"], "{feature}");
    }
    assert_eq!(cells(&report, "edge")[0], "1.000000");
    // The other features take the mean of the own one, and small regions have few pixels.
    let mut small = self::config("spatial=[{feature='mad',mean_fraction_bits=3,min_score=4}]");
    small.camera.region.size = 3;
    let report = run(Study::Redundancy, &inputs, &small, &dir.path().join("small")).unwrap();
    for feature in Organization::Pipelined.feature_kinds() {
        assert_eq!(cells(&report, feature.name())[0], "1.000000", "{feature}");
    }
    let report = run(Study::MadHistogram, &inputs, &config, &out).unwrap();
    let full: Vec<&Vec<String>> = report.rows.iter().filter(|row| row[4] == "1.000000").collect();
    // Half of the pixels are 0 and half are 255, so the deviation is 127.5.
    assert_eq!(full.len(), 2);
    assert_eq!((full[0][0].as_str(), full[0][1].as_str()), ("zero", "0"));
    assert_eq!((full[1][0].as_str(), full[1][1].as_str()), ("checkerboard", "127"));
}

/// The features are those of the organization. A displacement has no reference with `last-sent` and
/// votes of all features.
#[test]
fn redundancy_is_that_of_the_features_of_the_organization() {
    let dir = tempfile::tempdir().unwrap();
    let features = |overrides: &[&str]| {
        let base = config("region.size=8").to_toml();
        let config = DesignConfig::from_toml_with(&base, overrides).unwrap();
        let name = overrides.len().to_string();
        let report =
            run(Study::Redundancy, &["scene:shake"], &config, &dir.path().join(name)).unwrap();
        let columns = report.columns.len();
        (report.columns[3..columns - 1].to_vec(), report)
    };
    let (pipelined, _) = features(&[]);
    let supported = Organization::Pipelined.feature_kinds();
    assert_eq!(pipelined, supported.iter().map(|kind| kind.name()).collect::<Vec<_>>());
    let serial = "hardware.organization='serial'";
    let (all, report) = features(&[serial]);
    assert_eq!(all, FeatureKind::NAMES);
    let still: f64 = cells(&report, "flow")[0].parse().unwrap();
    assert!(still > 0.0 && still < 1.0, "some regions of a camera that shakes move: {still}");
    let last_sent = "temporal.reference='last-sent'";
    assert_eq!(features(&[serial, last_sent]).0, FeatureKind::NAMES);
    let (without, _) = features(&[serial, last_sent, "decision.combine='all'"]);
    assert_eq!(without, pipelined);
}

#[test]
fn sweeps_vary_one_number_and_keep_the_rest() {
    let dir = tempfile::tempdir().unwrap();
    let (out, config) = (dir.path().join("out"), config("region.size=8"));
    let report = run(Study::Size, &["scene:random"], &config, &out).unwrap();
    assert_eq!(cells(&report, "value"), ["4", "8", "16", "32"]);
    let report = run(Study::Threshold, &["scene:flicker", "scene:random"], &config, &out).unwrap();
    let share = |clip: &str, key: &str, value: &str| {
        let wanted = |row: &&Vec<String>| row[0] == clip && row[1] == key && row[2] == value;
        report.rows.iter().find(wanted).unwrap()[5].clone()
    };
    // The flicker is one level: more than 0, and not more than 1.
    assert_eq!(share("flicker", "temporal.level", "0"), "1.000000");
    assert_eq!(share("flicker", "temporal.level", "1"), "0.000000");
    assert_eq!(share("random", "temporal.min_count", "1"), "1.000000");
    let fingerprint = config.validate().unwrap().fingerprint();
    let own = report.rows.iter().filter(|row| row[6] == fingerprint).count();
    assert_eq!(own, 2 * 3, "the design itself is a point of each sweep");
}

#[test]
fn charts_are_well_formed_labelled_and_the_same_every_time() {
    let dir = tempfile::tempdir().unwrap();
    let (out, again) = (dir.path().join("out"), dir.path().join("again"));
    let config = config("region.size=8");
    let inputs = ["scene:street", "scene:shake"];
    for study in [Study::Temporal, Study::Size, Study::MadHistogram] {
        let report = run(study, &inputs, &config, &out).unwrap();
        run(study, &inputs, &config, &again).unwrap();
        for file in &report.files {
            let contents = fs::read(out.join(file)).unwrap();
            assert_eq!(contents, fs::read(again.join(file)).unwrap(), "{file}");
        }
        let svg = fs::read_to_string(out.join(&report.files[1])).unwrap();
        assert!(svg.trim_end().ends_with("</svg>"));
        assert_eq!(svg.matches("<text").count(), svg.matches("</text>").count());
        for part in ["analyze", "share of regions [%]", "design ", "scene:street", "scene:shake"] {
            assert!(svg.contains(part), "{study:?} lacks {part}");
        }
        let png = fs::read(out.join(&report.files[2])).unwrap();
        assert!(png.starts_with(b"\x89PNG") && png.len() > 5000);
    }
}

/// The real clips are in the folder that the environment variable FOVEATE_DATA names.
#[test]
fn real_clips_are_studied() {
    let Some(data) = foveate_tools::testing::data_folder() else { return };
    let dir = tempfile::tempdir().unwrap();
    let mut clips = vec![];
    for clip in ["video_static/vtest.avi", "video_moving/dashcam_solidWhiteRight.mp4"] {
        clips.push(data.join(clip).display().to_string());
    }
    let clips: Vec<&str> = clips.iter().map(String::as_str).collect();
    let out = dir.path().join("out");
    let report = run(Study::Temporal, &clips, &DesignConfig::default(), &out).unwrap();
    let shares: Vec<f64> =
        cells(&report, "active_mean").iter().map(|share| share.parse().unwrap()).collect();
    assert!(shares[0] < shares[1], "a static camera is less active than a moving one: {shares:?}");
}
