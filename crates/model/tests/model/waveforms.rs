// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests against waveforms that are written by hand from `docs/timing.md`. The first is the example
//! of that page.

use foveate_design::{Design, DesignConfig};
use foveate_model::{PipelinedRpu, RpuInput, RpuOutput, ThresholdInputs};

fn tiny_design(toml: &str) -> Design {
    let head = "[frame]\nwidth = 2\nheight = 2\n[region]\nsize = 2\n[denoise]\nfilter = \"none\"\n";
    DesignConfig::from_toml(&format!("{head}{toml}")).unwrap().validate().unwrap()
}

/// Returns the outputs after every edge. Each edge has a pixel or none.
fn run(design: &Design, pixels: &[Option<u16>]) -> Vec<RpuOutput> {
    let mut rpu = PipelinedRpu::new(design.as_pipelined().unwrap());
    let thresholds = ThresholdInputs::from_camera(design);
    let input = |pixel: Option<u16>| RpuInput {
        valid: pixel.is_some(),
        pixel: pixel.unwrap_or(99),
        ..RpuInput::default()
    };
    pixels.iter().map(|&pixel| rpu.step(&input(pixel), &thresholds)).collect()
}

fn column<T>(outputs: &[RpuOutput], port: impl Fn(&RpuOutput) -> T) -> Vec<T> {
    outputs.iter().map(port).collect()
}

/// A configuration in which every pixel is an edge at level 0, one hit is enough to vote, and any
/// frame passes the temporal score.
const EDGES: &str = "[[spatial]]\nfeature = \"edge\"\nlevel = 0\nmin_score = 1\n\
                     [temporal]\nlevel = 0\nmin_count = 0\n";

#[test]
fn two_frames_back_to_back_then_silence() {
    let pixels = [10, 20, 40, 80, 90, 70, 50, 11].map(Some);
    let all: Vec<_> = pixels.into_iter().chain([None; 4]).collect();
    let shown = run(&tiny_design(EDGES), &all);
    assert_eq!(column(&shown, |o| o.scores[0]), [0, 0, 0, 1, 2, 3, 4, 1, 2, 3, 4, 0]);
    let decided = [0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0].map(|bit| bit == 1);
    assert_eq!(column(&shown, |o| o.decision_valid), decided);
    assert_eq!(column(&shown, |o| o.active), decided);
    let forwards = [0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 0].map(|bit| bit == 1);
    assert_eq!(column(&shown, |o| o.forward_valid), forwards);
    assert_eq!(column(&shown, |o| o.forward_pixel), [0, 0, 0, 0, 0, 0, 0, 10, 20, 40, 80, 0]);
}

/// The waveform of the first stream:
///
/// ```text
/// edge           0  1  2  3  4  5  6  7  8  9 10 11 12
/// pixel         a0 a1 a2 a3  -  - b0  -  - b1 b2 b3  -
/// center         -  -  - a0 a1 a2 a3  -  -  -  - b0 b1
/// ```
#[test]
fn a_new_frame_ends_the_flush_and_its_own_centers_wait() {
    let (a, b) = ([10, 20, 40, 80], [90, 70, 50, 11]);
    let mut all: Vec<_> = a.map(Some).to_vec();
    all.extend([None, None, Some(b[0]), None, None]);
    all.extend([Some(b[1]), Some(b[2]), Some(b[3]), None]);
    let shown = run(&tiny_design(EDGES), &all);
    assert_eq!(column(&shown, |o| o.scores[0]), [0, 0, 0, 1, 2, 3, 4, 0, 0, 0, 0, 1, 2]);

    // With one clock of silence less, the last old center waits for the next pixel of the new
    // frame.
    let mut all: Vec<_> = a.map(Some).to_vec();
    all.extend([None, Some(b[0]), None, None, Some(b[1]), Some(b[2]), None, Some(b[3]), None]);
    let shown = run(&tiny_design(EDGES), &all);
    assert_eq!(column(&shown, |o| o.scores[0]), [0, 0, 0, 1, 2, 3, 3, 3, 4, 0, 0, 1, 2]);
    assert_eq!(column(&shown, |o| o.forward_pixel), [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10, 20]);
}

/// Tail steps are one edge behind the pixels. Frame a is decided when frame b is done.
#[test]
fn the_second_pass_of_mad_runs_during_the_next_frame() {
    let design = tiny_design(
        "[[spatial]]\nfeature = \"mad\"\nmean_fraction_bits = 2\nmin_score = 1.0\n\
         [temporal]\nlevel = 1\nmin_count = 3\n",
    );
    // The means are 2.5 and 0.5, which are 10 and 2 in quarters.
    let (a, b) = ([1, 2, 3, 4], [0, 0, 0, 2]);
    let all: Vec<_> = [a, b, b].concat().into_iter().map(Some).chain([None; 3]).collect();
    let shown = run(&design, &all);
    assert_eq!(column(&shown, |o| o.scores[0]), [0, 0, 0, 0, 0, 6, 8, 10, 16, 2, 4, 6, 12, 0, 0]);
    assert_eq!(column(&shown, |o| o.temporal_count), [0, 0, 0, 0, 0, 4, 4, 4, 4, 3, 3, 3, 3, 0, 0]);
    let bits = |edges: &[usize]| (0..shown.len()).map(|e| edges.contains(&e)).collect::<Vec<_>>();
    assert_eq!(column(&shown, |o| o.decision_valid), bits(&[8, 12]));
    assert_eq!(column(&shown, |o| o.trs), bits(&[8, 12]));
    assert_eq!(column(&shown, |o| o.srs), bits(&[8]), "MAD of b is 0.75");
    assert_eq!(column(&shown, |o| o.forward_valid), bits(&[9, 10, 11, 12]));
    assert_eq!(column(&shown, |o| o.forward_pixel), [0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 0, 0]);
}

#[test]
fn the_score_of_variance_stands_until_the_next() {
    let design = tiny_design(
        "[[spatial]]\nfeature = \"variance\"\nmin_score = 0\n[temporal]\nlevel = 0\nmin_count = 0\n",
    );
    let all: Vec<_> = [1, 2, 3, 4].map(Some).into_iter().chain([None; 4]).collect();
    let shown = run(&design, &all);
    assert_eq!(column(&shown, |o| o.scores[0]), [0, 0, 0, 0, 20, 20, 20, 20]);
    assert_eq!(column(&shown, |o| o.temporal_count), [0, 1, 2, 3, 4, 0, 0, 0]);
    // A minimum of 0 always votes, but SRS is 0 while no decision is valid.
    let valid = [0, 0, 0, 0, 1, 0, 0, 0].map(|bit| bit == 1);
    assert_eq!(column(&shown, |o| o.srs), valid);
    assert_eq!(column(&shown, |o| o.decision_valid), valid);
}
