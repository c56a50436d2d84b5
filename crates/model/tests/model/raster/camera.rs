// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of whole clips against the functional camera: scores, decisions and the rendered frame.
//! The designs are a matrix in which every value of every choice meets every other.

use foveate_camera::{Payload, RegionAction};
use foveate_design::{Design, FrameStoreKind};
use foveate_model::{FunctionalCamera, FunctionalOutcome, RasterOutput};
use foveate_pixels::Frame;

use super::driver::{RasterDriver, RasterStimulus, RasterTrace, RasterTraffic};
use super::raster_parameters::{PlantedMisreading, RasterParameters};
use crate::hard_cases::hard_frames;
use crate::parameters::{DesignParameters, FeatureParameters, PeripheryParameters};
use crate::port_thresholds::PortThresholds;
use crate::screen::ReceiverScreen;

/// Checks that the decision on the ports is that of the camera.
fn compare(shown: &RasterOutput, outcome: &FunctionalOutcome) {
    let at = shown.region as usize;
    let summary = outcome.actions[at] == RegionAction::Summarize;
    let expected_bits = (outcome.srs[at], outcome.trs[at], outcome.active[at], summary);
    let shown_bits = (shown.srs, shown.trs, shown.active, shown.summary);
    assert_eq!(shown_bits, expected_bits, "decision of region {at}");
    assert_eq!(shown.temporal_count, outcome.temporal_count[at], "region {at}");
    let scores = outcome.scores.iter().map(|scores| scores[at]);
    assert!(scores.eq(shown.scores.into_iter().take(outcome.scores.len())), "region {at}");
}

/// Checks that the last decision comes at the clock of `DepartureTiming`. If all regions are
/// active, the last word leaves at its clock, too; otherwise it leaves no later.
fn check_departure(design: &Design, outcome: &FunctionalOutcome, trace: &RasterTrace) {
    let departure = design.timing().departure();
    let last = |which: fn(&RasterOutput) -> bool| trace.shown.iter().rposition(which);
    let decided = (departure.take_clocks + departure.decision_clocks) as usize;
    assert_eq!(last(|shown| shown.decision_valid), Some(decided));
    let left = (departure.take_clocks + departure.forward_clocks) as usize;
    match last(|shown| shown.forward_valid) {
        found if !design.has_forwarding() => assert_eq!(found, None),
        found if outcome.active.iter().all(|&active| active) => assert_eq!(found, Some(left)),
        found => assert!(found <= Some(left)),
    }
}

/// Writes the pixels of an active region to the screen for a core without forwarding. A receiver
/// gets them from its own copy of the frame, raw or as it is scored.
fn show_active_region(
    screen: &mut ReceiverScreen,
    driver: &RasterDriver,
    frame: &Frame,
    region: u32,
) {
    let scored = driver.rcm.reference(region).unwrap();
    let width = screen.design.columns() * screen.design.region_size();
    for (position, &pixel) in (0..).zip(scored) {
        let place = screen.pixel_index(region, position);
        let (x, y) = (place as u32 % width, place as u32 / width);
        screen.pixels[place] = match screen.design.payload() {
            Payload::Denoised => pixel,
            Payload::Raw => frame.get_clamped(x.into(), y.into()),
        };
    }
}

/// Plays one frame after the other. Each frame leaves completely before the next, so that the
/// screen can be compared.
fn check(recipe: &RasterParameters, clip: &[Frame]) {
    let design = recipe.design();
    let thresholds = PortThresholds::of_camera(&design);
    let (mut camera, mut driver) =
        (FunctionalCamera::new(&design), RasterDriver::new(recipe, RasterTraffic::DENSE));
    let mut screen = ReceiverScreen::black(&design);
    let rest = 2 * recipe.words() + 100;
    for frame in clip {
        let outcome = camera.step(frame).unwrap();
        let trace =
            driver.run(&[RasterStimulus { frame: frame.clone(), thresholds }], rest, i64::MAX);
        driver.restart_trace();
        let mut decisions = 0;
        for shown in &trace.shown[1..] {
            if shown.decision_valid {
                compare(shown, outcome);
                screen.apply_decision(shown.region, (shown.srs, shown.trs, shown.summary));
                decisions += 1;
            }
            if shown.active && !recipe.forward {
                show_active_region(&mut screen, &driver, frame, shown.region);
            }
            if shown.forward_valid {
                let region = shown.forward_region;
                assert_eq!(shown.forward_summary, screen.summaries[region as usize]);
                for (position, &pixel) in (shown.forward_position..).zip(&shown.forward_pixels) {
                    screen.show_value(region, position, pixel);
                }
            }
        }
        assert_eq!(decisions, design.regions());
        check_departure(&design, outcome, &trace);
        assert!(!driver.rcm.is_pending() && !driver.rcm.output().lost);
        for y in 0..frame.height() {
            let row = &screen.pixels[(y * design.columns() * design.region_size()) as usize..];
            let shown = &row[..frame.width() as usize];
            assert_eq!(shown, outcome.rendered.row(y), "row {y}, {recipe:?}");
        }
        for region in 0..design.regions() {
            let reference = driver.rcm.reference(region).map(<[u16]>::to_vec);
            assert_eq!(reference, camera.reference(region), "reference of region {region}");
            let summary = driver.rcm.summary(region);
            assert_eq!(summary, camera.summary(region), "summary of region {region}");
        }
    }
}

/// Returns the recipe of a number. Its choices change at different rates with the number.
fn recipe(number: usize) -> RasterParameters {
    let on = |speed: usize| number / speed % 2 == 1;
    let feature = |name, level, min_milli| FeatureParameters {
        name,
        level,
        min_milli,
        fraction_bits: 2,
        radius: 1,
    };
    let all = [
        feature("edge", 120, 3000),
        feature("mad", 0, 9000),
        feature("corner", 12, 2000),
        feature("variance", 0, 300_000),
        feature("range", 0, 60_000),
        feature("surface", 0, 20_000),
        feature("segment", 16, 2000),
    ];
    let count = 1 + number % 5;
    let features = (0..count).map(|turn| all[(number / 5 + turn) % all.len()].clone()).collect();
    let (side, pixels) = [(4, 4), (4, 1), (5, 1), (6, 2), (8, 4), (3, 1), (2, 2)][number % 7];
    let columns = 4.max((16 * pixels + side - 1) / side);
    let periphery = PeripheryParameters::from_number(number / 3, side, 255)
        .filter(|periphery| side / periphery.blocks % pixels == 0);
    RasterParameters {
        base: DesignParameters {
            width: columns * side - number as i64 % side,
            height: [2, 3, 4][number % 3] * side - number as i64 / 2 % side,
            bits: 8,
            side,
            shared: on(1),
            filter: ["none", "median3x3", "switching3x3", "binomial3x3"][number / 2 % 4],
            features,
            all_must_vote: on(8),
            temporal_level: 9,
            temporal_min: side,
            last_sent: on(4),
            blank_irrelevant: on(3),
            periphery,
            raw_payload: on(6),
            constant: on(5),
            deep: false,
            zones: None,
            forced_srs: None,
        },
        word_pixels: pixels,
        deep: on(7),
        store: FrameStoreKind::Block,
        forward: true,
        misread: PlantedMisreading::default(),
    }
}

#[test]
fn every_kind_of_core_shows_what_the_camera_shows() {
    for number in 0..56 {
        let recipe = recipe(number);
        let clip = hard_frames(&recipe.base);
        check(&recipe, &clip);
    }
}

/// The test uses single-port and external stores, in cores with and without forwarding.
#[test]
fn a_core_with_any_store_shows_what_the_camera_shows() {
    for number in 0..56 {
        let mut recipe = recipe(number);
        recipe.base.last_sent = false;
        recipe.store =
            [FrameStoreKind::External, FrameStoreKind::SinglePort, FrameStoreKind::External]
                [number % 3];
        recipe.forward = number % 5 > 1 || recipe.base.periphery.is_some();
        let clip = hard_frames(&recipe.base);
        check(&recipe, &clip);
    }
}
