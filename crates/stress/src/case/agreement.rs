// SPDX-License-Identifier: MIT OR Apache-2.0
//! The functional model, the engine and the cycle-level model say the same.

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

/// Every scene: all zero, all maximum, checkerboard, hot pixels, ramps, half means, flicker, fade, light
/// step, shake, rain at night, one moving pixel, late change, random.
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

/// Odd regions, frames smaller than a region and one pixel larger.
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

/// Every depth that the contract names.
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

/// Gaps between valid pixels, resets in mid-frame.
pub(crate) fn unrest(depth: Depth) -> Vec<CaseRow> {
    let frames = depth.pick(18, 200);
    let designs = matrix((24, 16), 8, 8);
    let tally = all(&designs, |design| compare(design, random((24, 16), 8, frames), true));
    vec![row("models agree: gaps and resets", format!("{} designs", designs.len()), tally)]
}

/// Irrelevant regions that show the means of blocks, on frames that end within a region.
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

/// Random frames of which every second repeats half of the one before.
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
