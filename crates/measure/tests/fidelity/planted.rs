// SPDX-License-Identifier: MIT OR Apache-2.0
//! A candidate that equals the ideal, and then has one fault at a time: the figure for this fault
//! gets the value that follows from it.

use foveate_camera::{Camera, RegionAction};
use foveate_engine::FrameOutcome;
use foveate_ideal::IdealOutcome;
use foveate_measure::{Fidelity, FidelityFigures, FrameOrder};
use foveate_pixels::ByteFrame;

use crate::results::{
    blank_ideal, blank_outcome, config, frame_from_words, greys, pixels, shown_as_denoised,
};

struct PlantedResults {
    ideal: IdealOutcome,
    candidate: FrameOutcome,
    screen: Vec<u16>,
}

fn camera() -> Camera {
    config((32, 16), 8, 8).validate().unwrap()
}

/// Returns equal results of both cameras for a ramp; all eight regions are relevant, and the first
/// four are active.
fn equal_results() -> PlantedResults {
    let camera = camera();
    let screen: Vec<u16> = (0..512).map(|at| at % 200).collect();
    let mut ideal = blank_ideal(&camera);
    let mut candidate = blank_outcome(&camera);
    for region in 0..8 {
        let active = region < 4;
        (ideal.srs[region], candidate.srs[region]) = (true, true);
        (ideal.trs[region], candidate.trs[region]) = (active, active);
        let action = if active { RegionAction::Forward } else { RegionAction::Hold };
        (ideal.actions[region], candidate.actions[region]) = (action, action);
        (ideal.scores[0][region], candidate.scores[0][region]) = (10.0, 10);
        (ideal.changed[region], candidate.temporal_count[region]) = (7.0, 7);
    }
    ideal.denoised = greys(&screen);
    ideal.rendered = greys(&screen);
    PlantedResults { ideal, candidate, screen }
}

fn figures(fault: impl FnOnce(&mut PlantedResults)) -> FidelityFigures {
    let camera = camera();
    let mut results = equal_results();
    let input = frame_from_words(&camera, results.screen.clone());
    fault(&mut results);
    let PlantedResults { ideal, candidate, screen } = results;
    let mut fidelity = Fidelity::new(&camera, &camera).unwrap();
    let screen: ByteFrame = frame_from_words(&camera, screen);
    let mut denoised = Vec::new();
    let candidate = shown_as_denoised(&candidate, screen.borrowed_pixels(), &mut denoised);
    fidelity.add(&input, &ideal, candidate, FrameOrder::Later).unwrap();
    assert_eq!(pixels(&camera), 512);
    fidelity.tally().figures()
}

#[test]
fn equal_results_have_no_errors() {
    let observed = figures(|_| {});
    let flips = [
        observed.srs_flips,
        observed.trs_flips,
        observed.action_flips,
        observed.missed,
        observed.false_alarms,
    ];
    assert_eq!(flips, [0.0; 5]);
    assert_eq!([observed.active_iou, observed.active, observed.ideal_active], [1.0, 0.5, 0.5]);
    assert_eq!((observed.psnr_ideal, observed.psnr_input), (None, None));
    assert_eq!((observed.ssim_ideal, observed.ssim_input), (1.0, 1.0));
    let stale = &observed.staleness;
    assert_eq!((stale.max, stale.mean, stale.longest, stale.share), (0.0, 0.0, 0, 0.0));
    for score in &observed.scores {
        assert_eq!((score.max, score.mean, score.rms), (0.0, 0.0, 0.0), "{}", score.feature);
    }
}

/// Each fault is in one of eight regions.
#[test]
fn flipped_decisions_change_their_figures() {
    let base = figures(|_| {});
    let observed = figures(|results| results.candidate.srs[5] = false);
    assert_eq!(observed, FidelityFigures { srs_flips: 0.125, ..base.clone() });
    let observed = figures(|results| results.candidate.actions[5] = RegionAction::Blank);
    assert_eq!(observed, FidelityFigures { action_flips: 0.125, ..base.clone() });
    let observed = figures(|results| results.candidate.trs[5] = true);
    let expected = FidelityFigures {
        trs_flips: 0.125,
        false_alarms: 0.2,
        active_iou: 0.8,
        active: 0.625,
        ..base.clone()
    };
    assert_eq!(observed, expected);
    let observed = figures(|results| results.candidate.trs[0] = false);
    let expected =
        FidelityFigures { trs_flips: 0.125, missed: 0.25, active_iou: 0.75, active: 0.375, ..base };
    assert_eq!(observed, expected);
}

#[test]
fn errors_of_scores_change_their_figures() {
    let observed = figures(|results| results.candidate.scores[0][3] = 26);
    let [edge, temporal] = &observed.scores[..] else { panic!("two scores") };
    assert_eq!((edge.max, edge.mean, edge.rms), (0.25, 0.25 / 8.0, (0.0625_f64 / 8.0).sqrt()));
    assert_eq!(temporal.max, 0.0);
    let observed = figures(|results| results.candidate.temporal_count[3] = 3);
    let [edge, temporal] = &observed.scores[..] else { panic!("two scores") };
    assert_eq!((edge.max, temporal.max), (0.0, 4.0 / 64.0));
}

#[test]
fn errors_of_pixels_change_their_figures() {
    let observed = figures(|results| results.screen[100] += 20);
    let psnr = Some(10.0 * (255.0_f64 * 255.0 * 512.0 / 400.0).log10());
    assert_eq!((observed.psnr_ideal, observed.psnr_input), (psnr, psnr));
    assert!(observed.ssim_ideal < 1.0 && observed.ssim_ideal == observed.ssim_input);
    assert_eq!((observed.staleness.max, observed.staleness.mean), (20.0, 20.0 / 512.0));
    let observed = figures(|results| results.ideal.rendered[100] += 20.0);
    assert_eq!((observed.psnr_ideal, observed.psnr_input), (psnr, None));
    assert!(observed.ssim_ideal < 1.0 && observed.ssim_input == 1.0);
    assert_eq!(observed.staleness.max, 0.0);
    // Two pixels above the level of 8 are the minimum count.
    let observed = figures(|results| results.screen[100..102].fill(0));
    assert_eq!((observed.staleness.longest, observed.staleness.share), (1, 0.125));
}
