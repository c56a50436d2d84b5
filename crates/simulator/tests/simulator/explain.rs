// SPDX-License-Identifier: MIT OR Apache-2.0
//! Explanations agree with the model, are consistent, and fit a terminal.

use crate::support::{design, frames, grey};
use foveate_camera::FeatureKind;
use foveate_design::DesignConfig;
use foveate_media::{InputOptions, open};
use foveate_model::{
    FunctionalCamera,
    explanation::{DifferenceSum, SpatialExplanation},
    feature::surface::DisplacementSums,
    region_pixels,
};
use foveate_pixels::Frame;
use foveate_simulator::{RegionExplanation, SimulatorError, explain_region};

const MANY: &str = r#"spatial=[{feature="edge",level=40},{feature="corner",level=10},{feature="mad",min_score=4,mean_fraction_bits=1},{feature="variance",min_score=90},{feature="surface"},{feature="segment",mean_fraction_bits=1},{feature="flow",radius=2}]"#;
const SERIAL: &str = "hardware.organization=\"serial\"";

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
    assert_eq!(spatial.displacement.is_some(), *feature == FeatureKind::Flow);
}

/// Returns the sum of differences between a region and its reference moved by a displacement, and
/// the number of pixels that have a partner.
fn difference(told: &RegionExplanation, (dx, dy): (isize, isize)) -> DifferenceSum {
    let reference = told.temporal.reference.as_ref().unwrap();
    let partner = |at: usize, shift: isize| at.checked_add_signed(-shift);
    let mut found = DifferenceSum { sum: 0, pixels: 0 };
    for (y, row) in told.denoised.iter().enumerate() {
        for (x, pixel) in row.iter().enumerate() {
            let row = partner(y, dy).and_then(|y| reference.get(y));
            if let Some(other) = row.and_then(|row| row.get(partner(x, dx)?)) {
                found.sum += u64::from(pixel.abs_diff(*other));
                found.pixels += 1;
            }
        }
    }
    found
}

/// Checks that the differences of `flow` are those from the reference that is shown, that no other
/// displacement of at most two pixels has a smaller mean error, and that they give the score.
/// Returns true if the content has moved.
fn check_displacement(told: &RegionExplanation, spatial: &SpatialExplanation) -> bool {
    let displacement = spatial.displacement.unwrap();
    let (dx, dy) = (displacement.displacement.dx.into(), displacement.displacement.dy.into());
    let Some(differences) = displacement.differences else {
        assert!(told.temporal.reference.is_none());
        assert_eq!((dx, dy, spatial.score), (0, 0, 0));
        return false;
    };
    let (still, displaced) = (differences.still, differences.displaced);
    assert_eq!((still, displaced), (difference(told, (0, 0)), difference(told, (dx, dy))));
    for other in (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| (dx, dy))) {
        let other = difference(told, other);
        assert!(displaced.sum * other.pixels <= other.sum * displaced.pixels);
    }
    let gain = still.sum * displaced.pixels - displaced.sum * still.pixels;
    assert_eq!(gain / displaced.pixels, spatial.score);
    (dx, dy) != (0, 0)
}

/// Tests every region of every frame: bits and scores are the model's, the hits add up to the
/// scores, and the reference follows the rule of the contract.
#[test]
fn every_explanation_is_the_models_and_adds_up() {
    let mut moved = 0;
    for more in [
        &["temporal.reference=\"last-sent\"", "region.neighborhood=\"shared\""][..],
        &["render.irrelevant=\"hold\"", "denoise.filter=\"none\"", "decision.combine=\"all\""],
        &["denoise.filter=\"switching3x3\""],
        &["denoise.filter=\"binomial3x3\""],
    ] {
        let overrides = [&["frame.width=30", "frame.height=20", MANY, SERIAL], more].concat();
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
                let flow = told.spatial.last().unwrap();
                assert_eq!(flow.displacement.unwrap().displacement, outcome.displacements[at]);
                moved += usize::from(check_displacement(&told, flow));
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
    assert!(moved > 10, "only {moved} regions have moved");
}

/// A picture of four squares moves by two columns and a row, and then stays.
#[test]
fn a_movement_is_explained_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let image = |name: &str, shift: (u32, u32)| {
        let inside = |at: u32, shift: u32| matches!((at + 16 - shift) % 8, 2 | 3);
        grey(&folder.path().join(name), 16, 16, |x, y| {
            if inside(x, shift.0) && inside(y, shift.1) { 200 } else { 20 }
        })
    };
    let images = [image("a.png", (0, 0)), image("b.png", (2, 1)), image("c.png", (2, 1))];
    let config = DesignConfig::from_toml_with(
        "",
        &[SERIAL, "denoise.filter=\"none\"", "spatial=[{feature=\"flow\",radius=2}]"],
    );
    let config = config.unwrap();
    let lines = |frame| {
        let input = open(&images, &config.camera, &InputOptions::default()).unwrap();
        let told = explain_region(&config, input, frame, (1, 0)).unwrap().to_string();
        let start = told.find("\nflow").unwrap() + 1;
        told[start..told.find("          SRS").unwrap()].to_owned()
    };
    assert_eq!(
        lines(0),
        "flow      0 < 128: does not vote; 0.000 per pixel\n          \
         there is no valid reference, so no movement can be found\n"
    );
    assert_eq!(
        lines(1),
        "flow      1440 >= 128: votes; 22.500 per pixel\n          \
         the content has moved by 2 columns to the right and 1 row down:\n          \
         mean error 22.500 (1440 / 64) as it stands,\n          0.000 (0 / 42) moved\n"
    );
    assert_eq!(
        lines(2),
        "flow      0 < 128: does not vote; 0.000 per pixel\n          \
         the content has not moved: the reference matches best as it stands,\n          \
         mean error 0.000 (0 / 64)\n"
    );
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
        // Only `serial` has `flow`, and it has regions of 4x4 pixels or more.
        let (flow, organization) = if size < 4 {
            ("", "pipelined")
        } else {
            (",{feature=\"flow\",min_score=0.1,radius=3}", "serial")
        };
        for bits in [1, 8, 9, 12, 16] {
            let overrides = [
                format!("region.size={size}"),
                format!("frame.pixel_bits={bits}"),
                format!("hardware.organization=\"{organization}\""),
                format!(
                    "spatial=[{{feature=\"edge\",level=1,min_score=1}},{{feature=\"variance\",min_score=0.1}},{{feature=\"surface\",min_score=0.1}},{{feature=\"segment\",level=0,min_score=1,mean_fraction_bits=2}}{flow}]"
                ),
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
    let overrides = ["frame.width=64", "frame.height=64", MANY, SERIAL];
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
