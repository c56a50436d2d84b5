// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of damaged streams through every organization. Decisions must be those of a camera that
//! takes the frames that `docs/sync.md` defines, with their references, and errors must come after
//! the edges that it names.

use super::array::{ArrayDecision, ArrayOutputs, beat_shape, frame_from_beats, has_ready};
use super::sync_oracle::{CutStream, StreamEdge, cut_stream};
use crate::frames::SeededRandom;
use foveate_design::{Design, DesignConfig};
use foveate_model::{CoreInput, FunctionalCamera, ThresholdInputs, rcm_model};

const BASE: &str = "frame.pixel_bits = 4\ntemporal = { level = 2, min_count = 3 }\nhardware.sync = true\n\
                    region.size = 4\nspatial = [{ feature = 'edge', level = 12, min_score = 6 }]\n";

/// The designs have frames of whole regions. Only a raster core, which makes the padding itself,
/// also has a ragged frame.
const DESIGNS: &[&[&str]] = &[
    &["frame.width=12", "frame.height=8"],
    &[
        "frame.width=12",
        "frame.height=8",
        "hardware.pipelining='deep'",
        "temporal.reference='last-sent'",
    ],
    &[
        "frame.width=8",
        "frame.height=8",
        "spatial=[{feature='mad',min_score=1}]",
        "temporal.reference='last-sent'",
    ],
    &["frame.width=12", "frame.height=8", "hardware={organization='serial',fold=2,sync=true}"],
    &[
        "frame.width=12",
        "frame.height=8",
        "hardware={organization='serial',fold=3,feed='raster',sync=true}",
    ],
    &[
        "frame.width=12",
        "frame.height=8",
        "region.neighborhood='shared'",
        "temporal.reference='last-sent'",
        "hardware={organization='serial',feed='raster',sync=true}",
    ],
    &["frame.width=16", "frame.height=12", "hardware={organization='raster',sync=true}"],
    &[
        "frame.width=29",
        "frame.height=7",
        "region.neighborhood='shared'",
        "hardware={organization='raster',pixels_per_clock=2,pipelining='deep',sync=true}",
    ],
    &[
        "frame.width=16",
        "frame.height=8",
        "temporal.reference='last-sent'",
        "spatial=[{feature='mad',min_score=1}]",
        "hardware={organization='raster',sync=true}",
    ],
    &[
        "frame.width=16",
        "frame.height=16",
        "temporal.reference='last-sent'",
        "hardware={organization='raster',sync=true}",
    ],
];

fn design(more: &[&str]) -> Design {
    DesignConfig::from_toml_with(BASE, more).unwrap().validate().unwrap()
}

/// Returns the marks of beats for about `frames` frames, of which half are damaged.
fn damaged_stream(random: &mut SeededRandom, beats: usize, frames: usize) -> Vec<bool> {
    let mut marks = vec![false; random.below(4) as usize];
    for _ in 0..frames {
        let any = |random: &mut SeededRandom| 1 + random.below(beats as i64 - 1) as usize;
        let (length, sof) = match random.below(14) {
            0 => (beats - 1, true),
            1 => (any(random), true),
            2 => (1, true),
            3 => (beats + 1, true),
            4 => (beats + any(random), true),
            5 => (beats, false),
            6 => (any(random), false),
            _ => (beats, true),
        };
        marks.extend((0..length).map(|at| sof && at == 0));
    }
    // The last frames are complete, so that decisions follow every damage.
    for _ in 0..3 {
        marks.extend((0..beats).map(|at| at == 0));
    }
    marks
}

struct PlayedStream {
    edges: Vec<StreamEdge>,
    errors: Vec<usize>,
    decided: Vec<ArrayDecision>,
    left: usize,
}

/// Offers the beats to the array, with gaps, until all outputs have come. To an array without
/// `ready_o`, beats come in any case. While the array is not ready, `fill` is on the pixel port.
fn simulate(
    design: &Design,
    marks: &[bool],
    random: &mut SeededRandom,
    fill: &[u16],
) -> PlayedStream {
    let (mut array, thresholds) = (rcm_model(design), ThresholdInputs::from_camera(design));
    let mut played = PlayedStream { edges: vec![], errors: vec![], decided: vec![], left: 0 };
    let with_gaps = random.below(2) == 0;
    let max = i64::from(design.pixel_max()) + 1;
    let mut step = |reset, valid, sof, pixels: &[u16]| {
        let reference_pixels = &vec![0; pixels.len()][..];
        let idle = CoreInput { reference_pixels, ..CoreInput::idle(pixels, &thresholds) };
        ArrayOutputs::of_step(&mut *array, &CoreInput { reset, valid, sof, ..idle })
    };
    let mut ready = step(true, true, true, fill).ready;
    assert!(ready);
    let (mut next, mut silence, mut clock) = (0, 0, 0);
    // Pixels change little, so that some regions are held.
    let mut beats: Vec<Vec<u16>> = vec![fill.to_vec(); beat_shape(design).0];
    while silence < design.timing().clocks_per_frame() + 200 {
        let valid = next < marks.len() && !(with_gaps && random.below(4) == 0);
        let sof = if valid { marks[next] } else { random.below(2) == 0 };
        let pixels = if ready || !has_ready(design) {
            let places = beats.len();
            let beat = &mut beats[next % places];
            for pixel in beat.iter_mut() {
                if random.below(6) == 0 {
                    *pixel = random.below(max) as u16;
                }
            }
            beat.clone()
        } else {
            fill.to_vec()
        };
        if ready {
            played.edges.push(StreamEdge { clock, valid, sof, pixels: pixels.clone() });
            next += usize::from(valid);
        }
        let outputs = step(false, valid, sof, &pixels);
        played.errors.extend(outputs.sync_error.then_some(clock));
        silence = if next < marks.len() || !outputs.decided.is_empty() || outputs.sent_pixels > 0 {
            0
        } else {
            silence + 1
        };
        played.decided.extend(outputs.decided);
        played.left += outputs.sent_pixels;
        ready = outputs.ready;
        clock += 1;
    }
    played
}

#[test]
fn decisions_of_a_damaged_stream_are_those_of_the_frames_that_the_page_defines() {
    let (mut errors, mut completed, mut held) = (0, 0, 0);
    for more in DESIGNS {
        let design = design(more);
        let (beats, width) = beat_shape(&design);
        for seed in 0..12 {
            let random = &mut SeededRandom(seed * 7 + 1);
            let marks = damaged_stream(random, beats, 9);
            let fill = vec![random.below(i64::from(design.pixel_max()) + 1) as u16; width];
            let played = simulate(&design, &marks, random, &fill);
            let has_ready = has_ready(&design);
            let found: CutStream = cut_stream(&played.edges, beats, has_ready.then_some(&fill[..]));
            assert_eq!(played.errors, found.errors, "{more:?} {seed}");
            (errors, completed) = (errors + found.errors.len(), completed + found.completed);

            let mut camera = FunctionalCamera::new(&design);
            let regions = design.regions() as usize;
            let late = design.timing().departure().decision_frames as usize;
            let frames = found.frames.len();
            assert_eq!(played.decided.len(), (frames - late) * regions, "{more:?} {seed}");
            let mut left = 0;
            for (number, frame) in found.frames.iter().enumerate() {
                let outcome = camera.step(&frame_from_beats(&design, frame)).unwrap();
                left += outcome.active.iter().filter(|active| **active).count();
                for decided in played.decided.iter().skip(number * regions).take(regions) {
                    let at = decided.region as usize;
                    let expected = (outcome.srs[at], outcome.trs[at], outcome.active[at]);
                    let got = (decided.srs, decided.trs, decided.active);
                    assert_eq!(got, expected, "{more:?} {seed}: frame {number}, region {at}");
                    held += usize::from(outcome.srs[at] && !outcome.trs[at]);
                }
            }
            if has_ready {
                let pixels = left * design.region_pixels() as usize;
                assert_eq!(played.left, pixels, "{more:?} {seed}");
            }
        }
    }
    assert!(errors > 300 && completed > 120 && held > 100, "{errors} {completed} {held}");
}

/// Without the marks a lost beat is never noticed, and all later decisions are those of other
/// frames.
#[test]
fn without_sync_a_lost_beat_leaves_the_array_out_of_step() {
    for more in DESIGNS {
        let with_sync = design(more);
        let mut config = with_sync.config();
        config.hardware.sync = false;
        let without_sync = config.validate().unwrap();
        let (beats, width) = beat_shape(&with_sync);
        let mut marks: Vec<bool> = (0..4 * beats).map(|at| at % beats == 0).collect();
        marks.remove(beats / 2);
        let fill = vec![0; width];
        let late = with_sync.timing().departure().decision_frames as usize;
        let frames = |design: &Design| {
            let played = simulate(design, &marks, &mut SeededRandom(3), &fill);
            (played.decided.len() / design.regions() as usize + late, played.errors.len())
        };
        // The first frame is completed, the second is dropped, and the others are whole.
        assert_eq!(frames(&with_sync), (3, 1), "{more:?}");
        assert_eq!(frames(&without_sync), (3, 0), "{more:?}");
    }
}
