// SPDX-License-Identifier: MIT OR Apache-2.0
//! A candidate that equals the ideal, and then has one fault at a time: the figure for this fault
//! gets the value that follows from it.

use foveate_camera::Action;
use foveate_camera::Camera;
use foveate_engine::FrameOutcome;
use foveate_fidelity::{Fidelity, Figures};
use foveate_frame::Raster;
use foveate_ideal::IdealOutcome;

use crate::made::{blank, blank_ideal, config, greys, pixels, raster};

struct Results {
    ideal: IdealOutcome,
    candidate: FrameOutcome,
    screen: Vec<u16>,
}

fn camera() -> Camera {
    config((32, 16), 8, 8).validate().unwrap()
}

/// Returns equal results of both cameras for a ramp; all eight regions are relevant, and the first
/// four are active.
fn alike() -> Results {
    let camera = camera();
    let screen: Vec<u16> = (0..512).map(|at| at % 200).collect();
    let mut ideal = blank_ideal(&camera);
    let mut candidate = blank(&camera);
    for region in 0..8 {
        let active = region < 4;
        (ideal.srs[region], candidate.srs[region]) = (true, true);
        (ideal.trs[region], candidate.trs[region]) = (active, active);
        let action = if active { Action::Forward } else { Action::Hold };
        (ideal.actions[region], candidate.actions[region]) = (action, action);
        (ideal.scores[0][region], candidate.scores[0][region]) = (10.0, 10);
        (ideal.changed[region], candidate.temporal_count[region]) = (7.0, 7);
    }
    ideal.denoised = greys(&screen);
    ideal.rendered = greys(&screen);
    Results { ideal, candidate, screen }
}

fn figures(fault: impl FnOnce(&mut Results)) -> Figures {
    let camera = camera();
    let mut results = alike();
    let input = raster(&camera, results.screen.clone());
    fault(&mut results);
    let Results { ideal, candidate, screen } = results;
    let mut fidelity = Fidelity::new(&camera, &camera).unwrap();
    let screen: Raster = raster(&camera, screen);
    fidelity.add(&input, &ideal, &candidate, screen.plane()).unwrap();
    assert_eq!(pixels(&camera), 512);
    fidelity.tally().figures()
}

#[test]
fn nothing_is_seen_where_nothing_is_wrong() {
    let seen = figures(|_| {});
    let flips = [seen.srs_flips, seen.trs_flips, seen.action_flips, seen.missed, seen.false_alarms];
    assert_eq!(flips, [0.0; 5]);
    assert_eq!([seen.active_iou, seen.active, seen.ideal_active], [1.0, 0.5, 0.5]);
    assert_eq!((seen.psnr_ideal, seen.psnr_input), (None, None));
    assert_eq!((seen.ssim_ideal, seen.ssim_input), (1.0, 1.0));
    let stale = &seen.staleness;
    assert_eq!((stale.max, stale.mean, stale.longest, stale.share), (0.0, 0.0, 0, 0.0));
    for score in &seen.scores {
        assert_eq!((score.max, score.mean, score.rms), (0.0, 0.0, 0.0), "{}", score.feature);
    }
}

/// Each fault is in one of eight regions.
#[test]
fn decisions() {
    let base = figures(|_| {});
    let seen = figures(|results| results.candidate.srs[5] = false);
    assert_eq!(seen, Figures { srs_flips: 0.125, ..base.clone() });
    let seen = figures(|results| results.candidate.actions[5] = Action::Blank);
    assert_eq!(seen, Figures { action_flips: 0.125, ..base.clone() });
    let seen = figures(|results| results.candidate.trs[5] = true);
    let expected = Figures {
        trs_flips: 0.125,
        false_alarms: 0.2,
        active_iou: 0.8,
        active: 0.625,
        ..base.clone()
    };
    assert_eq!(seen, expected);
    let seen = figures(|results| results.candidate.trs[0] = false);
    let expected =
        Figures { trs_flips: 0.125, missed: 0.25, active_iou: 0.75, active: 0.375, ..base };
    assert_eq!(seen, expected);
}

#[test]
fn scores() {
    let seen = figures(|results| results.candidate.scores[0][3] = 26);
    let [edge, temporal] = &seen.scores[..] else { panic!("two scores") };
    assert_eq!((edge.max, edge.mean, edge.rms), (0.25, 0.25 / 8.0, (0.0625_f64 / 8.0).sqrt()));
    assert_eq!(temporal.max, 0.0);
    let seen = figures(|results| results.candidate.temporal_count[3] = 3);
    let [edge, temporal] = &seen.scores[..] else { panic!("two scores") };
    assert_eq!((edge.max, temporal.max), (0.0, 4.0 / 64.0));
}

#[test]
fn pictures() {
    let seen = figures(|results| results.screen[100] += 20);
    let psnr = Some(10.0 * (255.0_f64 * 255.0 * 512.0 / 400.0).log10());
    assert_eq!((seen.psnr_ideal, seen.psnr_input), (psnr, psnr));
    assert!(seen.ssim_ideal < 1.0 && seen.ssim_ideal == seen.ssim_input);
    assert_eq!((seen.staleness.max, seen.staleness.mean), (20.0, 20.0 / 512.0));
    let seen = figures(|results| results.ideal.rendered[100] += 20.0);
    assert_eq!((seen.psnr_ideal, seen.psnr_input), (psnr, None));
    assert!(seen.ssim_ideal < 1.0 && seen.ssim_input == 1.0);
    assert_eq!(seen.staleness.max, 0.0);
    // Two pixels above the level of 8 are the minimum count.
    let seen = figures(|results| results.screen[100..102].fill(0));
    assert_eq!((seen.staleness.longest, seen.staleness.share), (1, 0.125));
}
