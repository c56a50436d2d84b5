// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cases of references: over long clips, the difference between the screen and the scene stays
//! what a reference promises ([`invariant_on_scenes`]).

use crate::stress::designs::{config, design, frame_from_fn};
use crate::stress::{CaseRow, RunDepth};
use foveate_camera::{DenoiseFilter, FeatureKind, ReferencePolicy};
use foveate_design::{Design, DesignConfig};
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use foveate_pixels::{Frame, Scene, SceneParameters};

const SIDE: u32 = 8;

const SIZE: (u32, u32) = (16, 16);

/// Returns a checked texture whose brightness is `light`. Every region of it is relevant.
fn textured(light: u32) -> Frame {
    frame_from_fn(SIZE, 8, |x, y| if (x / 2 + y / 2) % 2 == 0 { light } else { light + 100 })
}

fn config_with_reference(reference: ReferencePolicy) -> DesignConfig {
    let mut config = config(SIZE, SIDE, 8, &[FeatureKind::Edge]);
    config.camera.denoise.filter = DenoiseFilter::None;
    config.camera.temporal.level = Some(8);
    config.camera.temporal.min_count = 5;
    config.camera.temporal.reference = reference;
    config
}

/// The largest errors of the screen in relevant regions.
#[derive(Clone, Copy, Debug, Default)]
struct ScreenErrors {
    /// The number of frames and regions in which `min_count` pixels or more were off by more than
    /// `level`.
    off_regions: u64,
    /// The number of frames and regions that were compared: those with SRS.
    compared_regions: u64,
    /// The largest difference of a pixel.
    difference: u32,
}

impl ScreenErrors {
    fn add_frame(&mut self, design: &Design, outcome: &FunctionalOutcome) {
        let side = design.region_size();
        let temporal = design.temporal();
        for region in 0..design.regions() {
            if !outcome.srs[region as usize] {
                continue;
            }
            let (left, top) = (region % design.columns() * side, region / design.columns() * side);
            let positions = (top..(top + side).min(design.height()))
                .flat_map(|y| (left..(left + side).min(design.width())).map(move |x| (x, y)));
            let differences: Vec<u32> = positions
                .map(|(x, y)| {
                    u32::from(outcome.rendered.get(x, y).abs_diff(outcome.denoised.get(x, y)))
                })
                .collect();
            let exceeding =
                differences.iter().filter(|&&difference| difference > temporal.level).count();
            self.compared_regions += 1;
            self.off_regions +=
                u64::from(temporal.min_count > 0 && exceeding >= temporal.min_count as usize);
            self.difference =
                self.difference.max(differences.into_iter().max().expect("a region has pixels"));
        }
    }
}

fn screen_errors(design: &Design, frames: impl Iterator<Item = Frame>) -> ScreenErrors {
    let mut worst = ScreenErrors::default();
    let mut camera = FunctionalCamera::new(design);
    for frame in frames {
        if let Ok(outcome) = camera.step(&frame) {
            worst.add_frame(design, outcome);
        }
    }
    worst
}

fn last_sent_row(case: &'static str, designs: String, worst: ScreenErrors) -> CaseRow {
    let tally = (worst.off_regions, worst.compared_regions);
    CaseRow::for_no_errors(
        case,
        designs,
        "regions off by min_count pixels",
        tally,
        worst.difference,
    )
}

/// Tests a fade of one level per frame, up and down.
pub(crate) fn slow_fade(depth: RunDepth) -> Vec<CaseRow> {
    let frames = depth.choose(600, 10_000);
    let light = |t: u32| if (t / 150).is_multiple_of(2) { t % 150 } else { 150 - t % 150 };
    let run = |reference| {
        screen_errors(
            &design(&config_with_reference(reference)),
            (0..frames).map(|t| textured(light(t))),
        )
    };
    let designs = |reference| format!("{reference}, level 8, {frames} frames");
    let drift = run(ReferencePolicy::Previous);
    vec![
        last_sent_row(
            "fade of one level per frame",
            designs(ReferencePolicy::LastSent),
            run(ReferencePolicy::LastSent),
        ),
        CaseRow {
            case: "fade of one level per frame",
            designs: designs(ReferencePolicy::Previous),
            expected: "drifts: 150 levels off".to_owned(),
            observed: format!("{} of {} regions off", drift.off_regions, drift.compared_regions),
            worst: drift.difference.to_string(),
            is_as_expected: drift.difference == 150,
        },
    ]
}

/// Tests two levels that alternate from frame to frame, with differences below, at and above the
/// temporal level.
pub(crate) fn flicker(depth: RunDepth) -> Vec<CaseRow> {
    let frames = depth.choose(600, 10_000);
    let amplitudes = [1, 8, 9];
    amplitudes
        .map(|amplitude| {
            let frames = (0..frames).map(|t| textured(20 + amplitude * (t % 2)));
            let worst =
                screen_errors(&design(&config_with_reference(ReferencePolicy::LastSent)), frames);
            let designs = format!("last-sent, level 8, amplitude {amplitude}");
            last_sent_row("flicker", designs, worst)
        })
        .into()
}

/// Tests a region whose relevance goes and returns. If its pixels have changed, both references
/// send it again. If they have not, `last-sent` sends it again, and `previous` leaves it black, as
/// the paper defines it.
pub(crate) fn relevance_returns(_: RunDepth) -> Vec<CaseRow> {
    let flat_frame = || frame_from_fn(SIZE, 8, |_, _| 50);
    let pixels_after_a_change = |reference| {
        let design = design(&config_with_reference(reference));
        let mut camera = FunctionalCamera::new(&design);
        let mut shown = 0;
        // The texture appears, disappears, and returns for two frames. The second of these has no
        // change.
        for frame in [textured(0), flat_frame(), textured(0), textured(0)] {
            if let Ok(outcome) = camera.step(&frame) {
                shown = outcome.rendered.pixels().iter().map(|&pixel| u64::from(pixel > 0)).sum();
            }
        }
        shown
    };
    let textured_pixels: u64 = textured(0).pixels().iter().map(|&pixel| u64::from(pixel > 0)).sum();
    // When the texture returns after the plain frame, its pixels change, so both references detect
    // it. In a return without a change, only SRS may change.
    let pixels_after_no_change = |reference| {
        let mut config = config_with_reference(reference);
        config.camera.spatial[0].level = Some(390);
        let design = design(&config);
        let mut camera = FunctionalCamera::new(&design);
        let mut shown = 0;
        // The contrast falls below the level of an edge by less than the temporal level, and
        // returns.
        for contrast in [100, 95, 100] {
            let frame =
                frame_from_fn(SIZE, 8, |x, y| if (x / 2 + y / 2) % 2 == 0 { 0 } else { contrast });
            if let Ok(outcome) = camera.step(&frame) {
                shown = outcome.rendered.pixels().iter().map(|&pixel| u64::from(pixel > 0)).sum();
            }
        }
        shown
    };
    vec![
        CaseRow::for_equal_numbers(
            "region comes back, changed",
            "last-sent, lit pixels",
            textured_pixels,
            pixels_after_a_change(ReferencePolicy::LastSent),
        ),
        CaseRow::for_equal_numbers(
            "region comes back, changed",
            "previous, lit pixels",
            textured_pixels,
            pixels_after_a_change(ReferencePolicy::Previous),
        ),
        CaseRow::for_equal_numbers(
            "region comes back as it was",
            "last-sent, lit pixels",
            textured_pixels,
            pixels_after_no_change(ReferencePolicy::LastSent),
        ),
        CaseRow::for_equal_numbers(
            "region comes back as it was (stays black)",
            "previous, lit pixels",
            0,
            pixels_after_no_change(ReferencePolicy::Previous),
        ),
    ]
}

/// Tests the promise of `last-sent` on every scene.
pub(crate) fn invariant_on_scenes(depth: RunDepth) -> Vec<CaseRow> {
    let mut worst = ScreenErrors::default();
    let size = depth.choose((48, 40), (224, 224));
    for &scene in Scene::ALL {
        for filter in DenoiseFilter::ALL {
            let mut config = config_with_reference(ReferencePolicy::LastSent);
            (config.camera.frame.width, config.camera.frame.height) = (Some(size.0), Some(size.1));
            config.camera.denoise.filter = *filter;
            let design = design(&config);
            let (width, height) = size;
            let frames = scene.default_frames();
            let parameters = SceneParameters { width, height, bits: 8, region_size: SIDE, frames };
            let errors = screen_errors(&design, scene.frames(parameters));
            worst.off_regions += errors.off_regions;
            worst.compared_regions += errors.compared_regions;
            worst.difference = worst.difference.max(errors.difference);
        }
    }
    let designs = format!("last-sent, {} scenes, every filter", Scene::ALL.len());
    vec![last_sent_row("screen follows the scene", designs, worst)]
}
