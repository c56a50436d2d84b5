// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of small frames with every clock computed by hand from `docs/serial.md`. The edge that
//! takes the first pixel has number 1.

use std::ops::RangeInclusive;

use foveate_design::{Design, DesignConfig};
use foveate_model::{CoreInput, SerialOutput, SerialRcm, ThresholdInputs};

fn design(toml: &str) -> Design {
    DesignConfig::from_toml(toml).unwrap().validate().unwrap()
}

/// Applies a frame of ones as fast as it is taken. Returns the outputs after every edge from 1 to
/// the one after which the array is ready again, and the edges that took a pixel.
fn simulate(design: &Design, pixels: usize) -> (Vec<SerialOutput>, Vec<usize>) {
    let mut rcm = SerialRcm::new(design.as_serial().unwrap());
    let ones = vec![1; rcm.output().forward_valid.len()];
    let thresholds = ThresholdInputs::from_camera(design);
    let (mut outputs, mut taken) = (vec![rcm.output().clone()], Vec::new());
    while taken.len() < pixels || !rcm.output().ready {
        if rcm.output().ready {
            taken.push(outputs.len());
        }
        // The pixel is valid even when the array is not ready.
        let input = CoreInput { valid: true, ..CoreInput::idle(&ones, &thresholds) };
        outputs.push(rcm.step(&input).clone());
    }
    (outputs, taken)
}

/// Returns the edge, the number and the region of each score.
fn scores(outputs: &[SerialOutput]) -> Vec<(usize, u32, u32)> {
    let valid = outputs.iter().enumerate().filter(|(_, output)| output.score_valid);
    valid.map(|(edge, output)| (edge, output.score_index, output.region)).collect()
}

/// Returns the edge and the region of each decision.
fn decisions(outputs: &[SerialOutput]) -> Vec<(usize, u32)> {
    let valid = outputs.iter().enumerate().filter(|(_, output)| output.decision_valid);
    valid.map(|(edge, output)| (edge, output.region)).collect()
}

fn forwarding_edges(outputs: &[SerialOutput]) -> Vec<usize> {
    let any = |edge: &usize| outputs[*edge].forward_valid.contains(&true);
    (0..outputs.len()).filter(any).collect()
}

/// Returns the edges in `edges` after which `ready_o` is 0.
fn busy_edges(outputs: &[SerialOutput], edges: RangeInclusive<usize>) -> Vec<usize> {
    edges.filter(|&edge| !outputs[edge].ready).collect()
}

/// The array takes 64 pixels, then 64 * 83 steps to denoise, 784 for the count, 14 * 64 for edges,
/// 784 for their score, and 64 to unload. Step j is seen after edge 64 + 1 + j.
#[test]
fn the_papers_frame() {
    let always = "[temporal]\nmin_count = 0\n[[spatial]]\nfeature = \"edge\"\nmin_score = 0\n";
    let design = design(&format!("{always}[hardware]\norganization = \"serial\"\n"));
    let (outputs, taken) = simulate(&design, 64);
    assert_eq!(taken, (1..=64).collect::<Vec<_>>());
    let rotation = |first: usize, number| (0..784).map(move |at| (first + at, number, at as u32));
    let expected: Vec<_> = rotation(65 + 5312, 0).chain(rotation(65 + 6992, 1)).collect();
    assert_eq!(scores(&outputs), expected);
    assert_eq!(
        decisions(&outputs),
        (0..784).map(|at| (65 + 6992 + at, at as u32)).collect::<Vec<_>>()
    );
    assert_eq!(forwarding_edges(&outputs), (65 + 7776..65 + 7840).collect::<Vec<_>>());
    assert!(outputs[65 + 7776].forward_valid.iter().all(|&valid| valid));
    assert_eq!(busy_edges(&outputs, 0..=7905), (64..=7904).collect::<Vec<_>>());
    assert_eq!(outputs.len() - 1, 7905, "the next frame's first pixel is taken at edge 7906");
}

/// Three regions are in two lanes of two slots, and slot 1 of lane 1 is empty. A slot takes 3 * 16
/// steps to compare, 2, 14 * 16 for edges, 2, and 16 to unload: 292. The last of 2 * 16 pixels is
/// taken at edge 32.
#[test]
fn two_slots_one_of_them_empty() {
    let design = design(
        "[frame]\nwidth = 12\nheight = 4\npixel_bits = 1\n[region]\nsize = 4\n\
         [denoise]\nfilter = \"none\"\n[temporal]\nlevel = 0\nmin_count = 0\n\
         [[spatial]]\nfeature = \"edge\"\nlevel = 1\nmin_score = 0\n\
         [hardware]\norganization = \"serial\"\nfold = 2\n",
    );
    let (outputs, taken) = simulate(&design, 32);
    assert_eq!(taken, (1..=32).collect::<Vec<_>>());
    assert_eq!(
        scores(&outputs),
        [(81, 0, 0), (82, 0, 2), (307, 1, 0), (308, 1, 2), (373, 0, 1), (599, 1, 1)]
    );
    assert_eq!(decisions(&outputs), [(307, 0), (308, 2), (599, 1)]);
    assert_eq!(forwarding_edges(&outputs), (309..=324).chain(601..=616).collect::<Vec<_>>());
    let (slot_0, slot_1) = (&outputs[320], &outputs[602]);
    assert_eq!((&slot_0.forward_valid[..], slot_0.forward_position), (&[true, true][..], 11));
    assert_eq!((&slot_1.forward_valid[..], slot_1.forward_slot), (&[true, false][..], 1));
    assert_eq!((&slot_1.forward_pixel[..], slot_1.forward_position), (&[1, 0][..], 1));
    assert_eq!(busy_edges(&outputs, 0..=617), (32..=616).collect::<Vec<_>>());
    assert_eq!(outputs.len() - 1, 32 + 584 + 1);
}

/// The frame is that of the test before, and irrelevant regions have four blocks. The means take
/// 4 * (4 + 2 + 2) steps after the count. With parallel feed, 4 * (2 + 2) steps unload them after
/// the 16 steps of pixels, all lanes together in every fourth step. With raster feed, 4 * 3 steps
/// unload them after 48, one by one.
#[test]
fn means_leave_where_pixels_have_left() {
    let toml = "[frame]\nwidth = 12\nheight = 4\npixel_bits = 1\n[region]\nsize = 4\n\
         [denoise]\nfilter = \"none\"\n[temporal]\nlevel = 0\nmin_count = 0\n\
         [render]\nirrelevant = \"mean\"\n[periphery]\nblocks = 2\n\
         [[spatial]]\nfeature = \"edge\"\nlevel = 1\nmin_score = 1\n\
         [hardware]\norganization = \"serial\"\nfold = 2\n";
    let (outputs, _) = simulate(&design(toml), 32);
    assert_eq!(
        scores(&outputs),
        [(81, 0, 0), (82, 0, 2), (339, 1, 0), (340, 1, 2), (421, 0, 1), (679, 1, 1)]
    );
    assert_eq!(decisions(&outputs), [(339, 0), (340, 2), (679, 1)]);
    assert!([339, 340, 679].iter().all(|&edge| outputs[edge].summary && !outputs[edge].active));
    let leaving = [360, 364, 368, 372, 700, 704, 708, 712];
    assert_eq!(forwarding_edges(&outputs), leaving);
    assert_eq!(leaving.map(|edge| outputs[edge].forward_position), [5, 7, 13, 15, 5, 7, 13, 15]);
    let (slot_0, slot_1) = (&outputs[360], &outputs[700]);
    assert_eq!((&slot_0.forward_pixel[..], slot_0.forward_slot), (&[1, 1][..], 0));
    assert_eq!((&slot_1.forward_valid[..], slot_1.forward_slot), (&[true, false][..], 1));
    assert_eq!(outputs.len() - 1, 32 + 2 * 340 + 1);

    let (outputs, _) = simulate(&design(&format!("{toml}feed = \"raster\"\n")), 48);
    let leaving = [406, 407, 409, 410, 412, 413, 415, 416, 774, 777, 780, 783];
    assert_eq!(forwarding_edges(&outputs), leaving);
    let place = |edge: usize| (outputs[edge].forward_region, outputs[edge].forward_position);
    assert_eq!([406, 407, 416, 774].map(place), [(0, 5), (2, 5), (2, 15), (1, 5)]);
    assert_eq!(outputs.len() - 1, 48 + 2 * 368 + 1);
}

/// The frame has two regions of 4x4 pixels with a halo of 1. The columns are shown 2 1 1 2 2 1 1 2
/// times, and the rows 2 1 1 2 times. So the first row takes 24 clocks, the next two take 12 each,
/// and the last takes 24, and T0 is edge 72.
#[test]
fn a_raster_frame_with_halos() {
    let design = design(
        "[frame]\nwidth = 8\nheight = 4\n[region]\nsize = 4\nneighborhood = \"shared\"\n\
         [denoise]\nfilter = \"none\"\n[temporal]\nmin_count = 0\n\
         [[spatial]]\nfeature = \"edge\"\nmin_score = 0\n\
         [hardware]\norganization = \"serial\"\nfeed = \"raster\"\n",
    );
    let (outputs, taken) = simulate(&design, 32);
    assert_eq!(taken[..9], [1, 5, 7, 9, 13, 17, 19, 21, 25]);
    assert_eq!((taken[16], taken[24], taken[31]), (37, 49, 69));
    assert_eq!(busy_edges(&outputs, 0..=12), [1, 2, 3, 5, 7, 9, 10, 11]);
    // The phases take 48 steps to compare, 2, 224, 2, then 16 rounds of 3.
    assert_eq!(scores(&outputs), [(121, 0, 0), (122, 0, 1), (347, 1, 0), (348, 1, 1)]);
    assert_eq!(decisions(&outputs), [(347, 0), (348, 1)]);
    let rounds = (0..16).flat_map(|round| [350 + 3 * round, 351 + 3 * round]);
    assert_eq!(forwarding_edges(&outputs), rounds.collect::<Vec<_>>());
    let place = |edge: usize| (outputs[edge].forward_region, outputs[edge].forward_position);
    assert_eq!([350, 351, 353, 396].map(place), [(0, 0), (1, 0), (0, 1), (1, 15)]);
    assert_eq!(busy_edges(&outputs, 70..=397), (70..=396).collect::<Vec<_>>());
    assert_eq!(outputs.len() - 1, 72 + 324 + 1);
}

/// The memory of 3 * 256 words of 16 bits has a depth of 1024. It would take 256 LUTs, so it is
/// block memory, and all outputs are one clock later. The last pixel leaves in the clock in which
/// the array is ready again.
#[test]
fn block_memory_is_a_clock_late() {
    let design = design(
        "[frame]\nwidth = 16\nheight = 16\npixel_bits = 16\n[region]\nsize = 16\n\
         [temporal]\nmin_count = 0\nreference = \"last-sent\"\n\
         [[spatial]]\nfeature = \"mad\"\nmin_score = 0\n[hardware]\norganization = \"serial\"\n",
    );
    let (outputs, _) = simulate(&design, 256);
    // The phases take 256 * 165 steps to denoise, 1, 2 * 256 + 16 + 3 for the deviation, 1, 3 * 256
    // to copy, and 256.
    assert_eq!(scores(&outputs), [(258 + 42_240, 0, 0), (258 + 42_240 + 1 + 531, 1, 0)]);
    assert_eq!(decisions(&outputs), [(43_030, 0)]);
    assert_eq!(forwarding_edges(&outputs), (43_799..=44_054).collect::<Vec<_>>());
    assert_eq!(busy_edges(&outputs, 256..=44_054), (256..=44_053).collect::<Vec<_>>());
    assert_eq!(outputs.len() - 1, 256 + 43_797 + 1);
}

/// With block memory and `mad`, a deep array needs three clocks from an address to the accumulator.
/// So the last pixel leaves two clocks after the array is ready again, while the next frame enters.
#[test]
fn the_last_pixels_of_a_deep_array_leave_while_the_next_frame_enters() {
    let design = design(
        "[frame]\nwidth = 4\nheight = 4\n[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n\
         [temporal]\nmin_count = 0\n[[spatial]]\nfeature = \"mad\"\nmin_score = 0\n\
         [hardware]\norganization = \"serial\"\nmemory = \"block\"\npipelining = \"deep\"\n",
    );
    // With n = 16 the phases take 16 * 6 steps to compare, 1 + 1, 32 + 8 + 3 for the deviation, 1 +
    // 1, and 16 for the pixels.
    let steps = 96 + 2 + 43 + 2 + 16;
    let ready = 16 + 1 + steps;
    let mut rcm = SerialRcm::new(design.as_serial().unwrap());
    let thresholds = ThresholdInputs::from_camera(&design);
    let mut leaves = Vec::new();
    for edge in 1..=2 * ready {
        let pixels = [if edge < ready { 100 } else { 7 }];
        let input = CoreInput { valid: true, ..CoreInput::idle(&pixels, &thresholds) };
        let output = rcm.step(&input);
        assert_eq!(
            output.ready,
            edge < 16 || (ready..ready + 16).contains(&edge) || edge == 2 * ready
        );
        if output.forward_valid[0] {
            leaves.push((edge, output.forward_position, output.forward_pixel[0]));
        }
    }
    let first = 16 + 1 + 3 + steps - 16;
    let expected: Vec<_> = (0..16).map(|position| (first + position, position, 100)).collect();
    assert_eq!(leaves[..16], expected);
    assert_eq!(expected[15].0, ready + 2);
}

/// The core of one RPU with three slots is a row of three regions, whose borders are those of the
/// frame.
#[test]
fn one_lane_is_a_row_of_its_slots() {
    let design = design(
        "[frame]\nwidth = 40\nheight = 16\n[region]\nneighborhood = \"shared\"\n\
         [hardware]\norganization = \"serial\"\nfold = 3\n",
    );
    let (outputs, taken) = simulate(&design.as_serial().unwrap().single_lane_design(), 3 * 144);
    assert_eq!((outputs[0].forward_valid.len(), taken.len()), (1, 432));
    let regions: Vec<u32> = decisions(&outputs).into_iter().map(|(_, region)| region).collect();
    assert_eq!(regions, [0, 1, 2]);
    assert_eq!(
        outputs.len() as u64 - 1,
        design.as_serial().unwrap().single_lane_design().timing().clocks_per_frame()
    );
}

/// The array shows the decisions and pixels of every slot at the clocks of `Departure`.
#[test]
fn decisions_and_pixels_leave_when_the_design_says() {
    let always = "[temporal]\nmin_count = 0\n[[spatial]]\nfeature = \"edge\"\nmin_score = 0\n";
    let frame = "[frame]\nwidth = 16\nheight = 24\n";
    for hardware in [
        "fold = 1",
        "fold = 2",
        "fold = 3\nfeed = \"raster\"",
        "fold = 2\n[denoise]\nfilter = \"none\"",
        "fold = 6\n[region]\nneighborhood = \"shared\"",
    ] {
        let toml = format!("{always}{frame}[hardware]\norganization = \"serial\"\n{hardware}\n");
        let design = design(&toml);
        let timing = design.timing();
        let departure = timing.departure();
        let (outputs, taken) = simulate(&design, timing.pixels_per_frame() as usize);
        let since = |edge: usize| (edge - taken.last().unwrap()) as u64;
        for slot in 0..design.slots() {
            let wait = u64::from(slot) * departure.slot_clocks;
            let mut decided = decisions(&outputs).into_iter();
            let last = decided.rfind(|(_, region)| region % design.slots() == slot);
            let decided = since(last.unwrap().0);
            assert_eq!(decided, departure.decision_clocks + wait, "{hardware}, slot {slot}");
            let end = departure.forward_clocks + wait;
            let left =
                forwarding_edges(&outputs).into_iter().map(since).filter(|&edge| edge <= end);
            assert_eq!(left.max(), Some(end), "{hardware}, slot {slot}");
        }
        let after =
            departure.forward_clocks + u64::from(design.slots() - 1) * departure.slot_clocks;
        assert_eq!(
            forwarding_edges(&outputs).into_iter().map(since).max(),
            Some(after),
            "{hardware}"
        );
    }
}
