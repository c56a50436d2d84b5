// SPDX-License-Identifier: MIT OR Apache-2.0
//! The difference between the screen and the scene over long runs.

use foveate_design::{Config, Design, FeatureKind, Filter, Reference};
use foveate_frame::Frame;
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use foveate_scenes::{Scene, SceneSize};

use crate::designs::{config, design};
use crate::pixels::frame;
use crate::{CaseRow, Depth};

const SIDE: u32 = 8;
const SIZE: (u32, u32) = (16, 16);

/// Returns a checked texture whose brightness is `light`. Every region of it is relevant.
fn textured(light: u32) -> Frame {
    frame(SIZE, 8, |x, y| if (x / 2 + y / 2) % 2 == 0 { light } else { light + 100 })
}

fn with(reference: Reference) -> Config {
    let mut config = config(SIZE, SIDE, 8, &[FeatureKind::Edge]);
    config.camera.denoise.filter = Filter::None;
    config.camera.temporal.level = Some(8);
    config.camera.temporal.min_count = 5;
    config.camera.temporal.reference = reference;
    config
}

/// The largest errors of the screen in relevant regions.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    /// The number of frames and regions in which `min_count` pixels or more were off by more than
    /// `level`.
    broken: u64,
    /// The number of frames and regions that were compared: those with SRS.
    relevant: u64,
    /// The largest difference of a pixel.
    difference: u32,
}

impl Worst {
    fn look(&mut self, design: &Design, outcome: &FunctionalOutcome) {
        let side = design.region_size();
        let temporal = design.temporal();
        for region in 0..design.regions() {
            if !outcome.srs[region as usize] {
                continue;
            }
            let (left, top) = (region % design.columns() * side, region / design.columns() * side);
            let inside = (top..(top + side).min(design.height()))
                .flat_map(|y| (left..(left + side).min(design.width())).map(move |x| (x, y)));
            let off: Vec<u32> = inside
                .map(|(x, y)| {
                    u32::from(outcome.rendered.get(x, y).abs_diff(outcome.denoised.get(x, y)))
                })
                .collect();
            let above = off.iter().filter(|&&off| off > temporal.level).count();
            self.relevant += 1;
            self.broken +=
                u64::from(temporal.min_count > 0 && above >= temporal.min_count as usize);
            self.difference =
                self.difference.max(off.into_iter().max().expect("a region has pixels"));
        }
    }
}

fn watch(design: &Design, frames: impl Iterator<Item = Frame>) -> Worst {
    let mut worst = Worst::default();
    let mut camera = FunctionalCamera::new(design);
    for frame in frames {
        if let Ok(outcome) = camera.step(&frame) {
            worst.look(design, outcome);
        }
    }
    worst
}

/// Makes the row of a case that tests the promise of `last-sent`.
fn invariant(case: &'static str, designs: String, worst: Worst) -> CaseRow {
    let tally = (worst.broken, worst.relevant);
    CaseRow::none(case, designs, "regions off by min_count pixels", tally, worst.difference)
}

/// Tests a fade of one level per frame, up and down.
pub(crate) fn slow_fade(depth: Depth) -> Vec<CaseRow> {
    let frames = depth.pick(600, 10_000);
    let light = |t: u32| if (t / 150).is_multiple_of(2) { t % 150 } else { 150 - t % 150 };
    let run = |reference| watch(&design(&with(reference)), (0..frames).map(|t| textured(light(t))));
    let designs = |reference| format!("{reference}, level 8, {frames} frames");
    let drift = run(Reference::Previous);
    vec![
        invariant(
            "fade of one level per frame",
            designs(Reference::LastSent),
            run(Reference::LastSent),
        ),
        CaseRow {
            case: "fade of one level per frame",
            designs: designs(Reference::Previous),
            expected: "drifts: 150 levels off".to_owned(),
            observed: format!("{} of {} regions off", drift.broken, drift.relevant),
            worst: drift.difference.to_string(),
            holds: drift.difference == 150,
        },
    ]
}

/// Tests two levels that alternate from frame to frame, with differences below, at and above the
/// temporal level.
pub(crate) fn flicker(depth: Depth) -> Vec<CaseRow> {
    let frames = depth.pick(600, 10_000);
    let amplitudes = [1, 8, 9];
    amplitudes
        .map(|amplitude| {
            let frames = (0..frames).map(|t| textured(20 + amplitude * (t % 2)));
            let worst = watch(&design(&with(Reference::LastSent)), frames);
            let designs = format!("last-sent, level 8, amplitude {amplitude}");
            invariant("flicker", designs, worst)
        })
        .into()
}

/// Tests a region whose relevance goes and returns. If its pixels have changed, both references
/// send it again. If they have not, `last-sent` sends it again, and `previous` leaves it black, as
/// the paper defines it.
pub(crate) fn blanked(_: Depth) -> Vec<CaseRow> {
    let plain = || frame(SIZE, 8, |_, _| 50);
    let black = |reference| {
        let design = design(&with(reference));
        let mut camera = FunctionalCamera::new(&design);
        let mut shown = 0;
        // The texture appears, disappears, and returns for two frames. The second of these has no
        // change.
        for frame in [textured(0), plain(), textured(0), textured(0)] {
            if let Ok(outcome) = camera.step(&frame) {
                shown = outcome.rendered.pixels().iter().map(|&pixel| u64::from(pixel > 0)).sum();
            }
        }
        shown
    };
    let lit: u64 = textured(0).pixels().iter().map(|&pixel| u64::from(pixel > 0)).sum();
    // When the texture returns after the plain frame, its pixels change, so both references detect it.
    // In a return without a change, only SRS may change.
    let returned = |reference| {
        let mut config = with(reference);
        config.camera.spatial[0].level = Some(390);
        let design = design(&config);
        let mut camera = FunctionalCamera::new(&design);
        let mut shown = 0;
        // The contrast falls below the level of an edge by less than the temporal level, and
        // returns.
        for contrast in [100, 95, 100] {
            let frame = frame(SIZE, 8, |x, y| if (x / 2 + y / 2) % 2 == 0 { 0 } else { contrast });
            if let Ok(outcome) = camera.step(&frame) {
                shown = outcome.rendered.pixels().iter().map(|&pixel| u64::from(pixel > 0)).sum();
            }
        }
        shown
    };
    vec![
        CaseRow::equal(
            "region comes back, changed",
            "last-sent, lit pixels",
            lit,
            black(Reference::LastSent),
        ),
        CaseRow::equal(
            "region comes back, changed",
            "previous, lit pixels",
            lit,
            black(Reference::Previous),
        ),
        CaseRow::equal(
            "region comes back as it was",
            "last-sent, lit pixels",
            lit,
            returned(Reference::LastSent),
        ),
        CaseRow::equal(
            "region comes back as it was (stays black)",
            "previous, lit pixels",
            0,
            returned(Reference::Previous),
        ),
    ]
}

/// Tests the promise of `last-sent` on every scene.
pub(crate) fn invariant_on_scenes(depth: Depth) -> Vec<CaseRow> {
    let mut worst = Worst::default();
    let size = depth.pick((48, 40), (224, 224));
    for &scene in Scene::ALL {
        for filter in Filter::ALL {
            let mut config = with(Reference::LastSent);
            (config.camera.frame.width, config.camera.frame.height) = (Some(size.0), Some(size.1));
            config.camera.denoise.filter = *filter;
            let design = design(&config);
            let (width, height) = size;
            let frames = scene.default_frames();
            let kind = SceneSize { width, height, bits: 8, region_size: SIDE, frames };
            let seen = watch(&design, scene.frames(kind));
            worst.broken += seen.broken;
            worst.relevant += seen.relevant;
            worst.difference = worst.difference.max(seen.difference);
        }
    }
    let designs = format!("last-sent, {} scenes, both filters", Scene::ALL.len());
    vec![invariant("screen follows the scene", designs, worst)]
}
