// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cases in which the functional model, the engine and the cycle-level model must agree.

use foveate_design::Design;
use foveate_pixels::{Scene, SceneParameters};
use rayon::prelude::*;

use crate::stress::designs::{RandomNumbers, design_matrix, designs_with_means};
use crate::stress::model_comparison::{AgreementTally, compare_models};
use crate::stress::{CaseRow, RunDepth};

fn agreement_row(case: &'static str, designs: String, tally: AgreementTally) -> CaseRow {
    CaseRow::for_no_errors(
        case,
        designs,
        "values differ",
        (tally.differing, tally.compared),
        u8::from(tally.differing > 0),
    )
}

fn compare_designs(
    designs: &[Design],
    compare: impl Fn(&Design) -> AgreementTally + Send + Sync,
) -> AgreementTally {
    designs.par_iter().map(compare).reduce(AgreementTally::default, AgreementTally::add)
}

/// Compares the models on every scene: all zero, all maximum, checkerboard, hot pixels, ramps, half
/// means, flicker, fade, light step, shake, rain at night, one moving pixel, late change, random.
pub(crate) fn scenes(depth: RunDepth) -> Vec<CaseRow> {
    let (width, height) = depth.choose((40, 24), (96, 72));
    let designs = design_matrix((width, height), 8, 8);
    let run = |&scene: &Scene| {
        let frames = depth.choose(6, scene.default_frames());
        let size = SceneParameters { width, height, bits: 8, region_size: 8, frames };
        let tally =
            compare_designs(&designs, |design| compare_models(design, scene.frames(size), false));
        agreement_row("models agree: scene", format!("{scene}, {} designs", designs.len()), tally)
    };
    Scene::ALL.iter().map(run).collect()
}

/// Compares the models on odd regions, and on frames that are smaller than a region or one pixel
/// larger.
pub(crate) fn sizes(depth: RunDepth) -> Vec<CaseRow> {
    let frames = depth.choose(3, 24);
    [
        (2, (5, 4)),
        (3, (10, 7)),
        (5, (4, 4)),
        (5, (6, 11)),
        (7, (8, 8)),
        (64, (65, 64)),
        (64, (20, 9)),
    ]
    .map(|(side, size)| {
        let designs = design_matrix(size, side, 8);
        let tally = compare_designs(&designs, |design| {
            compare_models(design, random_frames(size, 8, frames), false)
        });
        let (width, height) = size;
        let designs = format!("N {side}, frame {width}x{height}, {} designs", designs.len());
        agreement_row("models agree: size", designs, tally)
    })
    .into()
}

/// Compares the models on depths of 1, 10, 12 and 16 bits.
pub(crate) fn depths(depth: RunDepth) -> Vec<CaseRow> {
    let frames = depth.choose(3, 24);
    [1, 10, 12, 16]
        .map(|bits| {
            let designs = design_matrix((24, 16), 8, bits);
            let tally = compare_designs(&designs, |design| {
                compare_models(design, random_frames((24, 16), bits, frames), false)
            });
            agreement_row(
                "models agree: depth",
                format!("P {bits}, {} designs", designs.len()),
                tally,
            )
        })
        .into()
}

/// Compares the models with gaps between valid pixels and resets in the middle of a frame.
pub(crate) fn gaps_and_resets(depth: RunDepth) -> Vec<CaseRow> {
    let frames = depth.choose(18, 200);
    let designs = design_matrix((24, 16), 8, 8);
    let tally = compare_designs(&designs, |design| {
        compare_models(design, random_frames((24, 16), 8, frames), true)
    });
    vec![agreement_row(
        "models agree: gaps and resets",
        format!("{} designs", designs.len()),
        tally,
    )]
}

/// Compares the models with irrelevant regions that show the means of blocks, on frames that end
/// within a region.
pub(crate) fn means(depth: RunDepth) -> Vec<CaseRow> {
    let frames = depth.choose(18, 200);
    [(8, 8), (4, 12), (20, 8)]
        .map(|(side, bits)| {
            let designs = designs_with_means((27, 18), side, bits);
            let tally = compare_designs(&designs, |design| {
                compare_models(design, random_frames((27, 18), bits, frames), true)
            });
            let designs = format!("N {side}, P {bits}, {} designs", designs.len());
            agreement_row("models agree: means", designs, tally)
        })
        .into()
}

/// Returns random frames. Every second one repeats the upper half of the frame before it.
fn random_frames(
    size: (u32, u32),
    bits: u32,
    frames: u64,
) -> impl Iterator<Item = foveate_pixels::Frame> {
    (0..frames).map(move |t| {
        let current = RandomNumbers::new(t).frame(size, bits);
        let previous = RandomNumbers::new(t.saturating_sub(1)).frame(size, bits);
        let repeats = t % 2 == 1;
        crate::stress::designs::frame_from_fn(size, bits, |x, y| {
            let source = if repeats && y < size.1 / 2 { &previous } else { &current };
            source.get(x, y).into()
        })
    })
}
