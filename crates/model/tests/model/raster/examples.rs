// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of small frames with every clock computed by hand from `docs/raster.md`. The edge that
//! takes the first word has number 1.

use std::collections::VecDeque;
use std::ops::RangeInclusive;

use foveate_design::{Design, DesignConfig, RasterTiming};
use foveate_model::{CoreInput, RasterOutput, RasterRcm, ThresholdInputs};

/// Returns a design with one feature, in which all regions are active in every frame.
pub(super) fn design(feature: &str, frame: (u32, u32), more: &[&str]) -> Design {
    let toml = format!(
        "[frame]\nwidth = {}\nheight = {}\n[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n\
         [[spatial]]\nfeature = \"{feature}\"\nmin_score = 0\n[temporal]\nmin_count = 0\n\
         [hardware]\norganization = \"raster\"\n",
        frame.0, frame.1
    );
    DesignConfig::from_toml_with(&toml, more).unwrap().validate().unwrap()
}

/// Returns the outputs after every edge up to `last` while frames of ones are applied as fast as
/// they are taken. `sink` returns true for edges at which the sink is ready. An external memory can
/// return a word as soon as it is stored.
pub(super) fn simulate(
    design: &Design,
    frames: u64,
    last: usize,
    sink: impl Fn(usize) -> bool,
) -> Vec<RasterOutput> {
    let mut rcm = RasterRcm::new(design.as_raster().unwrap());
    let ones = vec![1; design.as_raster().unwrap().pixels_per_clock() as usize];
    let thresholds = ThresholdInputs::from_camera(design);
    let mut left = frames * design.timing().pixels_per_frame();
    let mut memory: VecDeque<Vec<u16>> = VecDeque::new();
    let mut outputs = vec![rcm.output().clone()];
    for edge in 1..=last {
        let valid = left > 0;
        left -= u64::from(valid && rcm.output().ready);
        let reference = if rcm.output().reference_ready { memory.pop_front() } else { None };
        let input = CoreInput {
            valid,
            reference_valid: reference.is_some(),
            reference_pixels: reference.as_ref().unwrap_or(&ones),
            forward_ready: sink(edge),
            ..CoreInput::idle(&ones, &thresholds)
        };
        let shown = rcm.step(&input).clone();
        memory.extend(shown.store_valid.then(|| shown.store_pixels.clone()));
        outputs.push(shown);
    }
    assert_eq!(left, 0, "the frames were taken");
    outputs
}

pub(super) fn edges(outputs: &[RasterOutput], which: impl Fn(&RasterOutput) -> bool) -> Vec<usize> {
    (0..outputs.len()).filter(|&edge| which(&outputs[edge])).collect()
}

pub(super) fn edge_list(edges: RangeInclusive<usize>) -> Vec<usize> {
    edges.collect()
}

/// Returns the edges and the regions of decisions.
pub(super) fn decisions(outputs: &[RasterOutput]) -> Vec<(usize, u32)> {
    let edges = edges(outputs, |output| output.decision_valid);
    edges.into_iter().map(|edge| (edge, outputs[edge].region)).collect()
}

/// Returns the edges at which regions were lost.
fn losses(outputs: &[RasterOutput]) -> Vec<usize> {
    let rises = |edge: &usize| outputs[*edge].lost_count > outputs[edge - 1].lost_count;
    (1..outputs.len()).filter(rises).collect()
}

/// The frame has 16x8 pixels in 4x2 regions, rows of 16 words, and one window. Word i comes to the
/// tail at edge i + 18, S is 3 and D is 7. The last words of the regions are 51, 55, 59, 63, then
/// 115 and so on.
#[test]
fn a_frame_with_one_window() {
    let design = design("edge", (16, 8), &[]);
    let outputs = simulate(&design, 1, 240, |_| true);
    // T0 is 128 and Z is 17.
    assert_eq!(edges(&outputs, |output| !output.ready), edge_list(128..=151));
    let expected = [(76, 0), (80, 1), (84, 2), (88, 3), (140, 4), (144, 5), (148, 6), (152, 7)];
    assert_eq!(decisions(&outputs), expected);
    // Region 0 enters the queue at edge 77, is held at 79 and fetched from 80 on. From then on the
    // words follow each other without a gap.
    assert_eq!(edges(&outputs, |output| output.forward_valid), edge_list(81..=208));
    for (word, output) in outputs[81..=208].iter().enumerate() {
        let (region, position) = (word / 16, word % 16);
        assert_eq!(
            (output.forward_region, output.forward_position),
            (region as u32, position as u32)
        );
    }
    assert!(!outputs[240].lost);
    let departure = design.timing().departure();
    assert_eq!((departure.take_clocks, departure.decision_clocks), (128, 152 - 128));
    assert_eq!(departure.forward_clocks, 208 - 128);
}

/// The frame has 29x7 pixels in words of two, and regions of 8x8. A row has 16 words, of which 15
/// are taken, and the core adds a row below. There is one median. Word i comes to the tail at edge
/// i + 18, S is 6, and D with variance is 13.
#[test]
fn a_ragged_frame_waits_for_its_pixels_with_last_sent() {
    let more = ["region.size=8", "denoise.filter=median3x3", "hardware.pixels_per_clock=2"];
    let previous = design("variance", (29, 7), &more);
    let outputs = simulate(&previous, 1, 300, |_| true);
    // `ready_o` is 0 after the last word of each of the first six rows. T0 is 111 and Z is 1 + 16 +
    // 17.
    let closed = [vec![15, 31, 47, 63, 79, 95], edge_list(111..=157)].concat();
    assert_eq!(edges(&outputs, |output| !output.ready), closed);
    assert_eq!(decisions(&outputs), [(146, 0), (150, 1), (154, 2), (158, 3)]);
    // Region 0 is held at edge 149. Four regions of 32 words leave.
    assert_eq!(edges(&outputs, |output| output.forward_valid), edge_list(151..=278));
    let positions: Vec<u32> = (151..=182).map(|edge| outputs[edge].forward_position).collect();
    assert_eq!(positions, (0..32).map(|word| 2 * word).collect::<Vec<u32>>());

    let more = [&more[..], &["temporal.reference=last-sent"]].concat();
    let last_sent = design("variance", (29, 7), &more);
    let outputs = simulate(&last_sent, 1, 300, |_| true);
    // The last word is on the ports after edge 278 and is taken at 279.
    let closed = [vec![15, 31, 47, 63, 79, 95], edge_list(111..=278)].concat();
    assert_eq!(edges(&outputs, |output| !output.ready), closed);
    let most = |design| RasterTiming::from_design(design).max_clocks_per_frame();
    assert_eq!(
        (most(previous.as_raster().unwrap()), most(last_sent.as_raster().unwrap())),
        (158, 279)
    );
}

/// The first word of row of regions g is stored at edge 64 g + 21. The sink is not ready before
/// edge 400. The regions of rows 0 and 1 are lost. Those of rows 2 and 3 are not lost, because no
/// frame follows.
#[test]
fn a_sink_that_stalls_loses_two_rows_of_regions() {
    let outputs = simulate(&design("edge", (16, 16), &[]), 1, 540, |edge| edge >= 400);
    // One region is held when its row becomes stale. The others are lost instead of being held, two
    // edges apart.
    let expected = [149, 150, 152, 154, 213, 214, 216, 218];
    assert_eq!(losses(&outputs), expected);
    assert_eq!(edges(&outputs, |output| output.lost), edge_list(149..=540));
    assert_eq!(outputs[540].lost_count, 8);
    // Two words of region 0 had been fetched. Region 8 is held from edge 220 on.
    assert_eq!(edges(&outputs, |output| output.forward_valid), edge_list(81..=528));
    let word = |edge: usize| (outputs[edge].forward_region, outputs[edge].forward_position);
    assert!((81..400).all(|edge| word(edge) == (0, 0)));
    assert_eq!([400, 401, 402, 416, 417].map(word), [(0, 1), (8, 0), (8, 1), (8, 15), (9, 0)]);
    assert_eq!(word(528), (15, 15));
    // The tuples are first, last and abort. Two words of region 0 leave, and all words of the
    // regions that are not lost. The word of region 0 that was fetched is its last one.
    let ends = |edge: usize| {
        let output = &outputs[edge];
        (output.forward_first, output.forward_last, output.forward_abort)
    };
    assert!((81..400).all(|edge| ends(edge) == (true, false, false)));
    assert_eq!(ends(400), (false, true, true));
    for edge in 401..=528 {
        assert_eq!(ends(edge), ((edge - 401) % 16 == 0, (edge - 401) % 16 == 15, false), "{edge}");
    }
    let lost = expected.map(|edge| (outputs[edge].lost_valid, outputs[edge].lost_region));
    assert_eq!(lost, [0, 1, 2, 3, 4, 5, 6, 7].map(|region| (true, region)));
    assert_eq!(edges(&outputs, |output| output.lost_valid), expected);
}

/// There is no window. Word i comes to the tail at edge i + 1, S is 2 and D is 6. The first pass
/// begins at edge 52 + 2 + 8. Four passes of 16 edges take as long as a row of regions takes to
/// come in.
#[test]
fn the_second_pass_decides_one_region_after_the_other() {
    let design = design("mad", (16, 8), &[]);
    let outputs = simulate(&design, 1, 300, |_| true);
    let expected = [(81, 0), (97, 1), (113, 2), (129, 3), (145, 4), (161, 5), (177, 6), (193, 7)];
    assert_eq!(decisions(&outputs), expected);
    assert_eq!(edges(&outputs, |output| !output.ready), edge_list(128..=133));
    assert_eq!(edges(&outputs, |output| output.forward_valid), edge_list(86..=213));
    let departure = design.timing().departure();
    assert_eq!((departure.decision_clocks, departure.forward_clocks), (193 - 128, 213 - 128));
}

/// The bounds are the clocks for which a sink may stall after the first word has come, while all
/// regions are active and words come at every clock: L - N/K - (D - S) - 3, or (N+1) L - (n+N)/K -
/// 14 with a second pass. There `deep` adds 4 clocks and `variance` adds 3.
#[test]
fn nothing_is_lost_while_the_sink_stalls_for_less_than_a_row() {
    const BOTH: &str = "spatial=[{feature=\"variance\",min_score=0},{feature=\"mad\",min_score=0}]";
    for (feature, more, first, stall) in [
        ("edge", &[][..], 81, 16 - 4 - 4 - 3),
        ("variance", &[], 66, 16 - 4 - 7 - 3),
        ("edge", &["hardware.pipelining=deep"], 88, 16 - 4 - 6 - 4),
        ("surface", &["hardware.pipelining=deep"], 90, 16 - 4 - 8 - 4),
        // Two rows in the buffer would lose regions without a stall; it has three.
        ("variance", &["hardware.pipelining=deep"], 71, 4 * 16 + 16 - 4 - 9 - 4),
        ("mad", &[], 86, 5 * 16 - 20 - 14),
        ("mad", &["hardware.pipelining=deep"], 92, 5 * 16 - 20 - 18),
        ("mad", &[BOTH], 89, 5 * 16 - 20 - 17),
    ] {
        let design = design(feature, (16, 64), more);
        let outputs = simulate(&design, 1, 1300, |_| true);
        assert_eq!(edges(&outputs, |output| output.forward_valid)[0], first, "{feature}");
        for (clocks, lost) in [(stall, false), (stall + 1, true)] {
            let outputs = simulate(&design, 1, 1300, |edge| edge <= first || edge > first + clocks);
            assert_eq!(outputs[1300].lost, lost, "{feature}, {clocks} clocks");
        }
    }
}

/// Frames are counted modulo 256 from a reset on, whether their regions leave or are lost. A frame
/// has one row of regions. The sink takes nothing during every fifth group of three frames.
#[test]
fn frames_have_numbers() {
    let design = design("edge", (16, 4), &[]);
    let mut rcm = RasterRcm::new(design.as_raster().unwrap());
    let thresholds = ThresholdInputs::from_camera(&design);
    let (mut whole, mut lost, mut taken, mut decided) = (Vec::new(), Vec::new(), 0, 0);
    while taken < 600 * 64 {
        let before = rcm.output().clone();
        let forward_ready = taken / 192 % 5 > 0;
        if before.forward_valid && before.forward_last && !before.forward_abort && forward_ready {
            whole.push((before.forward_frame, before.forward_region));
        }
        taken += u32::from(before.ready);
        let idle = CoreInput::idle(&[1], &thresholds);
        let input = CoreInput { valid: true, forward_ready, ..idle };
        let output = rcm.step(&input);
        decided += usize::from(output.decision_valid);
        lost.extend(output.lost_valid.then_some((output.lost_frame, output.lost_region)));
    }
    assert!(whole.len() > 1_000 && lost.len() > 300, "{} {}", whole.len(), lost.len());
    assert!(whole.len() + lost.len() + 12 >= decided && decided > 4 * 590);
    // Every region of every frame is in one of the two lists, in order.
    let (mut whole, mut lost) = (whole.iter().peekable(), lost.iter().peekable());
    for region in 0..4 * 590 {
        let expected = (region / 4 % 256, region % 4);
        let found = whole.next_if_eq(&&expected).or_else(|| lost.next_if_eq(&&expected));
        assert_eq!(found, Some(&expected), "frame {}", region / 4);
    }
}
