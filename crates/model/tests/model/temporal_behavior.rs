// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the two references over time, which the contract states as consequences: drift, and
//! regions that were blanked.

use foveate_design::{Design, DesignConfig};
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use foveate_pixels::Frame;

use crate::frames::SeededRandom;

const WIDTH: u32 = 32;
const HEIGHT: u32 = 20;

fn design(toml: &str) -> Design {
    let size = format!("[frame]\nwidth = {WIDTH}\nheight = {HEIGHT}\n");
    DesignConfig::from_toml(&format!("{size}{toml}")).unwrap().validate().unwrap()
}

/// Returns a textured frame, which is shifted to the left by `shift`.
fn textured_frame(shift: u32, offset: i64, mut noise: impl FnMut() -> i64) -> Frame {
    Frame::from_fn(WIDTH, HEIGHT, 8, |x, y| {
        let texture = i64::from((x + shift) / 3 % 2 * 90 + y / 5 % 2 * 40);
        (40 + texture + offset + noise()).clamp(0, 255) as u16
    })
    .unwrap()
}

#[test]
fn only_last_sent_notices_a_slow_fade() {
    let fade = |reference: &str| {
        let toml =
            format!("[temporal]\nreference = \"{reference}\"\n[render]\nirrelevant = \"hold\"\n");
        let mut camera = FunctionalCamera::new(&design(&toml));
        let mut worst = 0;
        for step in 0..80 {
            let outcome = camera.step(&textured_frame(0, step, || 0)).unwrap();
            let (scored, shown) = (outcome.denoised.get(16, 8), outcome.rendered.get(16, 8));
            worst = worst.max(scored.abs_diff(shown));
        }
        worst
    };
    assert_eq!(fade("previous"), 79);
    assert_eq!(fade("last-sent"), 8);
}

/// Returns the number of regions with SRS = 1 in which min_count or more pixels of the screen
/// differ from the frame, and the number of inactive regions with SRS = 1.
fn stale_and_held_regions(design: &Design, outcome: &FunctionalOutcome) -> (usize, usize) {
    let level = design.temporal().level;
    let (mut stale, mut held) = (0, 0);
    for region in 0..design.regions() {
        let at = region as usize;
        if !outcome.srs[at] {
            continue;
        }
        held += usize::from(!outcome.trs[at]);
        let (left, top) = (region % design.columns() * 8, region / design.columns() * 8);
        let differs = |x: u32, y: u32| {
            u32::from(outcome.rendered.get(x, y).abs_diff(outcome.denoised.get(x, y))) > level
        };
        let different = (top..(top + 8).min(HEIGHT))
            .flat_map(|y| (left..left + 8).map(move |x| (x, y)))
            .filter(|&(x, y)| differs(x, y))
            .count();
        stale += usize::from(different >= design.temporal().min_count as usize);
    }
    (stale, held)
}

#[test]
fn last_sent_never_drifts() {
    let mut random = SeededRandom(3);
    let mut rain = move || if random.below(30) == 0 { 150 } else { random.below(13) - 6 };
    let cases: Vec<(&str, Vec<Frame>)> = vec![
        ("fade", (0..60).map(|t| textured_frame(0, t, || 0)).collect()),
        ("flicker", (0..60).map(|t| textured_frame(0, t % 2, || 0)).collect()),
        ("light step", (0..60).map(|t| textured_frame(0, t / 15 * 30, || 0)).collect()),
        ("shake", (0..60).map(|t| textured_frame(t * 7 % 3, 0, || 0)).collect()),
        ("rain", (0..60).map(|_| textured_frame(0, 0, &mut rain)).collect()),
        ("a moving pixel", (0..60).map(moving_pixel).collect()),
        ("texture comes and goes", (0..60).map(coming_and_going).collect()),
    ];
    for filter in ["none", "median3x3"] {
        for irrelevant in ["zero", "hold"] {
            let rendering = |reference: &str| {
                design(&format!(
                    "[denoise]\nfilter = \"{filter}\"\n[temporal]\nreference = \"{reference}\"\n\
                     [render]\nirrelevant = \"{irrelevant}\"\n"
                ))
            };
            let mut drifted = 0;
            for (name, frames) in &cases {
                let design = rendering("last-sent");
                let mut camera = FunctionalCamera::new(&design);
                let mut all_held = 0;
                for (index, frame) in frames.iter().enumerate() {
                    let (stale, held) =
                        stale_and_held_regions(&design, camera.step(frame).unwrap());
                    assert_eq!(stale, 0, "{name} {filter} {irrelevant}, frame {index}");
                    all_held += held;
                }
                assert!(all_held > 0 || *name == "shake", "{name}: nothing was ever held");
                // The same clips make the reference `previous` drift.
                let design = rendering("previous");
                let mut camera = FunctionalCamera::new(&design);
                for frame in frames {
                    drifted += stale_and_held_regions(&design, camera.step(frame).unwrap()).0;
                }
            }
            assert!(drifted > 0);
        }
    }
}

/// Returns a frame with one bright pixel that moves through the texture.
fn moving_pixel(t: u32) -> Frame {
    let scene = textured_frame(0, 0, || 0);
    let bright = |x, y| (x, y) == (t % WIDTH, 3 + t / 8);
    Frame::from_fn(WIDTH, HEIGHT, 8, |x, y| if bright(x, y) { 255 } else { scene.get(x, y) })
        .unwrap()
}

/// Returns a frame whose contrast falls below the edge level and rises again, while most pixels
/// change slowly.
fn coming_and_going(t: u32) -> Frame {
    let contrast = [60, 30, 12, 6, 12, 30][(t / 2 % 6) as usize];
    Frame::from_fn(WIDTH, HEIGHT, 8, |x, _| (100 + x / 4 % 2 * contrast) as u16).unwrap()
}

/// A flat region has one bright pixel that disappears and comes back. SRS falls and returns, while
/// one changed pixel is too few for TRS.
#[test]
fn a_static_region_that_was_blanked_once() {
    let bright =
        Frame::from_fn(WIDTH, HEIGHT, 8, |x, y| 90 + 160 * u16::from(x % 8 == 4 && y % 8 == 4));
    let (bright, flat) = (bright.unwrap(), Frame::filled(WIDTH, HEIGHT, 8, 90).unwrap());
    let results_of = |reference: &str, irrelevant: &str| {
        let mut camera = FunctionalCamera::new(&design(&format!(
            "[denoise]\nfilter = \"none\"\n[temporal]\nreference = \"{reference}\"\n\
             [render]\nirrelevant = \"{irrelevant}\"\n"
        )));
        [&bright, &flat, &bright, &bright].map(|frame| {
            let outcome = camera.step(frame).unwrap();
            (outcome.srs[0], outcome.trs[0], outcome.rendered.get(0, 0))
        })
    };
    let first = (true, true, 90);
    assert_eq!(
        results_of("previous", "zero"),
        [first, (false, false, 0), (true, false, 0), (true, false, 0)],
        "stays black"
    );
    assert_eq!(
        results_of("last-sent", "zero"),
        [first, (false, false, 0), (true, true, 90), (true, false, 90)],
        "is sent again"
    );
    for reference in ["previous", "last-sent"] {
        assert_eq!(
            results_of(reference, "hold"),
            [first, (false, false, 90), (true, false, 90), (true, false, 90)]
        );
    }
}
