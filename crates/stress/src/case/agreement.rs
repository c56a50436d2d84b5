// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cases in which the functional model, the engine and the cycle-level model must agree.

use foveate_design::Design;
use foveate_scenes::{Scene, SceneSize};
use rayon::prelude::*;

use crate::designs::{matrix, with_means};
use crate::pixels::Random;
use crate::trio::{AgreementTally, compare};
use crate::{CaseRow, Depth};

fn row(case: &'static str, designs: String, tally: AgreementTally) -> CaseRow {
    CaseRow::none(
        case,
        designs,
        "values differ",
        (tally.wrong, tally.tried),
        u8::from(tally.wrong > 0),
    )
}

fn all(
    designs: &[Design],
    one: impl Fn(&Design) -> AgreementTally + Send + Sync,
) -> AgreementTally {
    designs.par_iter().map(one).reduce(AgreementTally::default, AgreementTally::plus)
}

/// Compares the models on every scene: all zero, all maximum, checkerboard, hot pixels, ramps, half
/// means, flicker, fade, light step, shake, rain at night, one moving pixel, late change, random.
pub(crate) fn scenes(depth: Depth) -> Vec<CaseRow> {
    let (width, height) = depth.pick((40, 24), (96, 72));
    let designs = matrix((width, height), 8, 8);
    let run = |&scene: &Scene| {
        let frames = depth.pick(6, scene.default_frames());
        let size = SceneSize { width, height, bits: 8, region_size: 8, frames };
        let tally = all(&designs, |design| compare(design, scene.frames(size), false));
        row("models agree: scene", format!("{scene}, {} designs", designs.len()), tally)
    };
    Scene::ALL.iter().map(run).collect()
}

/// Compares the models on odd regions, and on frames that are smaller than a region or one pixel
/// larger.
pub(crate) fn sizes(depth: Depth) -> Vec<CaseRow> {
    let frames = depth.pick(3, 24);
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
        let designs = matrix(size, side, 8);
        let tally = all(&designs, |design| compare(design, random(size, 8, frames), false));
        let (width, height) = size;
        let designs = format!("N {side}, frame {width}x{height}, {} designs", designs.len());
        row("models agree: size", designs, tally)
    })
    .into()
}

/// Compares the models on depths of 1, 10, 12 and 16 bits.
pub(crate) fn depths(depth: Depth) -> Vec<CaseRow> {
    let frames = depth.pick(3, 24);
    [1, 10, 12, 16]
        .map(|bits| {
            let designs = matrix((24, 16), 8, bits);
            let tally =
                all(&designs, |design| compare(design, random((24, 16), bits, frames), false));
            row("models agree: depth", format!("P {bits}, {} designs", designs.len()), tally)
        })
        .into()
}

/// Compares the models with gaps between valid pixels and resets in the middle of a frame.
pub(crate) fn unrest(depth: Depth) -> Vec<CaseRow> {
    let frames = depth.pick(18, 200);
    let designs = matrix((24, 16), 8, 8);
    let tally = all(&designs, |design| compare(design, random((24, 16), 8, frames), true));
    vec![row("models agree: gaps and resets", format!("{} designs", designs.len()), tally)]
}

/// Compares the models with irrelevant regions that show the means of blocks, on frames that end
/// within a region.
pub(crate) fn means(depth: Depth) -> Vec<CaseRow> {
    let frames = depth.pick(18, 200);
    [(8, 8), (4, 12), (20, 8)]
        .map(|(side, bits)| {
            let designs = with_means((27, 18), side, bits);
            let tally =
                all(&designs, |design| compare(design, random((27, 18), bits, frames), true));
            let designs = format!("N {side}, P {bits}, {} designs", designs.len());
            row("models agree: means", designs, tally)
        })
        .into()
}

/// Returns random frames. Every second one repeats the upper half of the frame before it.
fn random(size: (u32, u32), bits: u32, frames: u64) -> impl Iterator<Item = foveate_frame::Frame> {
    (0..frames).map(move |t| {
        let now = Random::new(t).frame(size, bits);
        let before = Random::new(t.saturating_sub(1)).frame(size, bits);
        let repeats = t % 2 == 1;
        crate::pixels::frame(size, bits, |x, y| {
            let source = if repeats && y < size.1 / 2 { &before } else { &now };
            source.get(x, y).into()
        })
    })
}
