// SPDX-License-Identifier: MIT OR Apache-2.0
//! Explanations agree with the model, are consistent, and fit a terminal.

use crate::support::{design, frames};
use foveate_design::{DesignConfig, FeatureKind};
use foveate_footage::{InputOptions, open};
use foveate_frame::Frame;
use foveate_model::explanation::SpatialExplanation;
use foveate_model::feature::surface::DisplacementSums;
use foveate_model::{FunctionalCamera, region_pixels};
use foveate_simulator::{RegionExplanation, SimulatorError, explain_region};

const MANY: &str = r#"spatial=[{feature="edge",level=40},{feature="corner",level=10},{feature="mad",min_score=4,mean_fraction_bits=1},{feature="variance",min_score=90},{feature="surface"},{feature="segment",mean_fraction_bits=1}]"#;

fn explained(
    overrides: &[&str],
    frame: u64,
    region: (u32, u32),
) -> Result<RegionExplanation, SimulatorError> {
    let config = DesignConfig::from_toml_with("", overrides).unwrap();
    let limit = InputOptions { frames: Some(5), ..InputOptions::default() };
    explain_region(&config, open(&["scene:street"], &config.camera, &limit).unwrap(), frame, region)
}

fn hits(rows: &[Vec<bool>]) -> u64 {
    rows.iter().flatten().map(|&hit| u64::from(hit)).sum()
}

/// Checks that the parts that are shown add up to the score.
fn check_parts_of_score(spatial: &SpatialExplanation) {
    let SpatialExplanation { feature, score, .. } = spatial;
    if let Some(rows) = &spatial.hits {
        assert_eq!(hits(rows), *score, "{feature}");
    }
    assert_eq!(spatial.parts.is_some(), *feature == FeatureKind::Segment);
    if let Some(parts) = &spatial.parts {
        assert_eq!(
            (hits(&parts.above), hits(&parts.below)),
            (parts.count_above, parts.count_below)
        );
        assert_eq!(parts.count_above.min(parts.count_below), *score);
    }
    assert_eq!(spatial.displacements.is_some(), *feature == FeatureKind::Surface);
    if let Some(DisplacementSums { right, below, below_right, below_left }) = spatial.displacements
    {
        assert_eq!([right, below, below_right, below_left].into_iter().min(), Some(*score));
    }
}

/// Tests every region of every frame: bits and scores are the model's, the hits add up to the
/// scores, and the reference follows the rule of the contract.
#[test]
fn every_explanation_is_the_models_and_adds_up() {
    for more in [
        &["temporal.reference=\"last-sent\"", "region.neighborhood=\"shared\""][..],
        &["render.irrelevant=\"hold\"", "denoise.filter=\"none\"", "decision.combine=\"all\""],
        &["denoise.filter=\"switching3x3\""],
        &["denoise.filter=\"binomial3x3\""],
    ] {
        let overrides = [&["frame.width=30", "frame.height=20", MANY], more].concat();
        let design = design(&overrides);
        let frames: Vec<Frame> = frames(&design).collect();
        let mut camera = FunctionalCamera::new(&design);
        let mut sent: Vec<Option<Vec<u16>>> = vec![None; 12];
        for (number, frame) in (0..).zip(&frames) {
            let outcome = camera.step(frame).unwrap().clone();
            for region in 0..12 {
                let at = region as usize;
                let told = explained(&overrides, number, (region % 4, region / 4)).unwrap();
                assert_eq!((told.srs, told.trs), (outcome.srs[at], outcome.trs[at]));
                assert_eq!(told.action, outcome.actions[at].name());
                for (spatial, scores) in told.spatial.iter().zip(&outcome.scores) {
                    assert_eq!(spatial.score, scores[at]);
                    assert_eq!(spatial.vote, spatial.score >= spatial.min_score);
                    check_parts_of_score(spatial);
                }
                assert_eq!(told.temporal.count, outcome.temporal_count[at]);
                assert_eq!(hits(&told.temporal.hits), u64::from(told.temporal.count));
                let mut denoised = Vec::new();
                region_pixels(&design, &outcome.denoised, region, &mut denoised);
                assert_eq!(told.denoised.concat(), denoised);
                assert_eq!(told.temporal.reference.map(|rows| rows.concat()), sent[at]);
                let last_sent = told.temporal.against == "last-sent";
                match (last_sent, told.action) {
                    (true, "hold") => {}
                    (true, "blank") => sent[at] = None,
                    _ => sent[at] = Some(denoised),
                }
            }
        }
    }
}

#[test]
fn raw_pixels_are_the_frames_and_padding_is_named() {
    let overrides = ["frame.width=30", "frame.height=20"];
    let told = explained(&overrides, 2, (3, 2)).unwrap();
    let frame = frames(&design(&overrides)).nth(2).unwrap();
    for (y, row) in (16..).zip(&told.raw) {
        for (x, &pixel) in (24..).zip(row) {
            assert_eq!(pixel, frame.get_clamped(x, y));
        }
    }
    assert_eq!((told.region.padding_right, told.region.padding_below), (2, 4));
    let text = told.to_string();
    assert!(text.contains("padding: the last 2 columns and the last 4 rows"), "{text}");
}

#[test]
fn texts_fit_80_columns_at_every_size_and_depth() {
    for size in [2, 8, 16, 17, 32, 64] {
        for bits in [1, 8, 9, 12, 16] {
            let overrides = [
                format!("region.size={size}"),
                format!("frame.pixel_bits={bits}"),
                "spatial=[{feature=\"edge\",level=1,min_score=1},{feature=\"variance\",min_score=0.1},{feature=\"surface\",min_score=0.1},{feature=\"segment\",level=0,min_score=1,mean_fraction_bits=2}]".into(),
                "temporal={level=0,min_count=1}".into(),
            ];
            let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
            for frame in [0, 1] {
                let text = explained(&overrides, frame, (0, 1)).unwrap().to_string();
                for line in text.lines() {
                    assert!(line.chars().count() <= 80, "{size} {bits}: {line}");
                }
                assert_eq!(text.contains("one character per pixel"), size > 16);
            }
        }
    }
}

#[test]
fn a_small_scene_is_explained_as_in_the_golden_file() {
    let overrides = ["frame.width=64", "frame.height=64", MANY];
    let text = explained(&overrides, 3, (2, 5)).unwrap().to_string();
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/simulator/golden/explain.txt");
    if std::env::var_os("FOVEATE_BLESS").is_some() {
        std::fs::write(golden, &text).unwrap();
    }
    assert_eq!(std::fs::read_to_string(golden).unwrap(), text);
}

#[test]
fn frames_and_regions_that_are_not_there_are_named() {
    let overrides = ["frame.width=30", "frame.height=20"];
    let message = explained(&overrides, 5, (0, 0)).unwrap_err().to_string();
    assert_eq!(message, "there is no frame 5; scene:street has 5 frames, counted from 0");
    let message = explained(&overrides, 0, (4, 0)).unwrap_err().to_string();
    assert_eq!(message, "there is no region 4,0; columns are 0 to 3, rows 0 to 2");
}
