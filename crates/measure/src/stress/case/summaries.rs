// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cases of means of blocks: those that irrelevant regions show are rounded correctly
//! ([`halves`]) and stay near the scene ([`fade`]), and scores are right for means that end in
//! exactly one half, or one pixel below or above it ([`halves_of_means`]).

use crate::stress::designs::{RandomNumbers, config, design, frame_from_fn};
use crate::stress::{CaseRow, RunDepth};
use foveate_camera::{Decimal, DenoiseFilter, FeatureKind, IrrelevantRendering, SUMMARY_BLOCKS};
use foveate_design::DesignConfig;
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;

/// Returns a configuration in which regions whose pixels differ by one level are irrelevant, and
/// show the means of blocks.
fn config_with_means(
    size: (u32, u32),
    side: u32,
    bits: u32,
    blocks: u32,
    level: u32,
) -> DesignConfig {
    let mut config = config(size, side, bits, &[FeatureKind::Edge]);
    config.camera.denoise.filter = DenoiseFilter::None;
    config.camera.render.irrelevant = IrrelevantRendering::Mean;
    config.camera.periphery.blocks = Some(blocks);
    config.camera.periphery.level = Some(level);
    config
}

/// Tests that for every sum around a half, at both ends of the range of pixels, the screen shows
/// the mean rounded up at one half. In exact rational arithmetic it is `floor((2 sum + n) / (2 n))`
/// for the n pixels of a block.
pub(crate) fn halves(_: RunDepth) -> Vec<CaseRow> {
    let sides = [(2, 1), (3, 1), (6, 2), (8, 4), (20, 4), (64, 1)];
    let depths = [8, 16];
    let mut errors = PixelErrors::default();
    for (sides, bits) in sides.iter().flat_map(|&sides| depths.map(|bits| (sides, bits))) {
        compare_around_halves(sides, bits, &mut errors);
    }
    let designs = "6 pairs of N and blocks, P 8 and 16";
    vec![errors.row("means of blocks on one half", designs, "pixels wrong")]
}

/// The errors of pixels on the screen.
#[derive(Default)]
struct PixelErrors {
    wrong: u64,
    tried: u64,
    worst: u32,
}

impl PixelErrors {
    /// Compares a screen with the value of all its pixels, which may be off by some levels.
    fn compare(&mut self, screen: &Frame, value: u32, allowed: u32) {
        for &shown in screen.pixels() {
            let error = u32::from(shown).abs_diff(value);
            self.wrong += u64::from(error > allowed);
            self.tried += 1;
            self.worst = self.worst.max(error);
        }
    }

    fn row(&self, case: &'static str, designs: &str, what: &str) -> CaseRow {
        CaseRow::for_no_errors(case, designs, what, (self.wrong, self.tried), self.worst)
    }
}

fn compare_around_halves((side, blocks): (u32, u32), bits: u32, errors: &mut PixelErrors) {
    let design = design(&config_with_means((side, side), side, bits, blocks, 0));
    let (block, max) = (side / blocks, (1 << bits) - 1);
    let n = block * block;
    for base in [0, 1, max / 2, max - 1] {
        for above in (n / 2).saturating_sub(2)..=(n / 2 + 2).min(n) {
            // In every block `above` pixels are one level higher, so its mean is base + above / n.
            let place = |x, y| (y % block) * block + x % block;
            let region =
                frame_from_fn((side, side), bits, |x, y| base + u32::from(place(x, y) < above));
            let mean = base + u32::from(2 * above >= n);
            let mut camera = FunctionalCamera::new(&design);
            let outcome = camera.step(&region).expect("the region is a frame of the design");
            errors.compare(&outcome.rendered, mean, 0);
        }
    }
}

/// Tests a fade of one level per frame, up and down, and jumps. In every frame, the value that a
/// block shows is within the level of its mean.
pub(crate) fn fade(depth: RunDepth) -> Vec<CaseRow> {
    let frames = depth.choose(600, 10_000);
    let slow_fade = |t: u32| if (t / 250).is_multiple_of(2) { t % 250 } else { 250 - t % 250 };
    let mut jumps = RandomNumbers::new(5);
    let jumps: Vec<u32> =
        (0..frames).map(|_| u32::try_from(jumps.below(256)).expect("a pixel has 8 bits")).collect();
    let lights = [("one level per frame", (0..frames).map(slow_fade).collect()), ("jumps", jumps)];
    let row = |(name, lights): (&str, Vec<u32>)| {
        let mut errors = PixelErrors::default();
        for (blocks, level) in
            SUMMARY_BLOCKS.iter().flat_map(|blocks| [0, 4, 254].map(|level| (*blocks, level)))
        {
            compare_with_light(&lights, (blocks, level), &mut errors);
        }
        let designs = format!("{name}, all blocks, levels 0, 4 and 254, {frames} frames");
        errors.row("means follow the scene", &designs, "pixels off by more")
    };
    lights.map(row).into()
}

/// Compares the screen with a flat scene.
fn compare_with_light(lights: &[u32], (blocks, level): (u32, u32), errors: &mut PixelErrors) {
    const SIZE: (u32, u32) = (13, 11);
    let mut camera = FunctionalCamera::new(&design(&config_with_means(SIZE, 8, 8, blocks, level)));
    for &light in lights {
        let flat: Frame = frame_from_fn(SIZE, 8, |_, _| light);
        let outcome = camera.step(&flat).expect("it is a frame of the design");
        errors.compare(&outcome.rendered, light, level);
    }
}

/// Tests that for every sum around a half, the scores are those of the mean rounded up at one half.
/// In exact rational arithmetic the mean is `floor((2 sum + n) / (2 n))`.
pub(crate) fn halves_of_means(_: RunDepth) -> Vec<CaseRow> {
    [2, 3, 5, 8, 16].map(around_halves).into()
}

fn around_halves(side: u32) -> CaseRow {
    let mut config = config((side, side), side, 8, &[FeatureKind::Mad, FeatureKind::Segment]);
    config.camera.denoise.filter = DenoiseFilter::None;
    for spatial in &mut config.camera.spatial {
        spatial.mean_fraction_bits = Some(0);
    }
    config.camera.spatial[1].level = Some(0);
    config.camera.spatial[1].min_score = Some(Decimal::from_whole(0));
    let design = design(&config);
    let n = design.region_pixels();
    let (mut wrong, mut tried, mut worst) = (0, 0, 0);
    for base in [0, 1, 127, 253] {
        for above in (n / 2).saturating_sub(2)..=(n / 2 + 2).min(n) {
            // `above` pixels are one level higher, so the mean is base + above / n.
            let region =
                frame_from_fn((side, side), 8, |x, y| base + u32::from(y * side + x < above));
            let mean = base + u32::from(2 * above >= n);
            let pixels = || region.pixels().iter().map(|&pixel| u32::from(pixel));
            let deviations: u64 = pixels().map(|pixel| u64::from(pixel.abs_diff(mean))).sum();
            let [higher, lower] =
                [pixels().filter(|&x| x > mean).count(), pixels().filter(|&x| x < mean).count()];
            let expected = [deviations, higher.min(lower) as u64];
            let mut camera = FunctionalCamera::new(&design);
            let outcome = camera.step(&region).expect("the region is a frame of the design");
            for (scores, expected) in outcome.scores.iter().zip(expected) {
                let error = scores[0].abs_diff(expected);
                (wrong, tried, worst) = (wrong + u64::from(error > 0), tried + 1, worst.max(error));
            }
        }
    }
    CaseRow::for_no_errors(
        "means on one half",
        format!("mad and segment, N {side}, f 0"),
        "scores wrong",
        (wrong, tried),
        worst,
    )
}
