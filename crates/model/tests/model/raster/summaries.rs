// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of means that leave, with every clock computed by hand from `docs/raster.md`. The edge
//! that takes the first word has number 1.

use super::examples::{decisions, design, edge_list, edges, simulate};

/// A feature for which no region of a flat frame is relevant.
const IRRELEVANT: &str = "spatial=[{feature=\"edge\",min_score=1}]";

/// The frame is that of [`super::examples`] with one window. Irrelevant regions have four blocks,
/// so their words are four means, one after the other.
#[test]
fn means_leave_as_pixels_do() {
    let more = [IRRELEVANT, "render.irrelevant=mean", "periphery.blocks=2"];
    let outputs = simulate(&design("edge", (16, 8), &more), 240, |_| true);
    let due = [(76, 0), (80, 1), (84, 2), (88, 3), (140, 4), (144, 5), (148, 6), (152, 7)];
    assert_eq!(decisions(&outputs), due);
    assert!(due.iter().all(|&(edge, _)| outputs[edge].summary && !outputs[edge].active));
    assert_eq!(edges(&outputs, |output| output.summary).len(), 8);
    let leaving = [edge_list(81..=96), edge_list(145..=160)].concat();
    assert_eq!(edges(&outputs, |output| output.forward_valid), leaving);
    for (word, edge) in leaving.into_iter().enumerate() {
        let (output, block) = (&outputs[edge], word % 4);
        assert_eq!(
            (output.forward_region as usize, &output.forward_pixels[..]),
            (word / 4, &[1][..])
        );
        assert_eq!(output.forward_position, [0, 2, 8, 10][block]);
        let flags = (output.forward_first, output.forward_last, output.forward_summary);
        assert_eq!(flags, (block == 0, block == 3, true));
    }
}

/// The frame has 64x8 pixels in words of four. Regions are decided at every clock, from edge 73 on.
/// A region of one mean is held for one edge, and the next region is held two edges later.
#[test]
fn regions_of_one_mean_leave_at_every_other_clock() {
    let more =
        [IRRELEVANT, "render.irrelevant=mean", "periphery.blocks=1", "hardware.pixels_per_clock=4"];
    let outputs = simulate(&design("edge", (64, 8), &more), 240, |_| true);
    assert_eq!(decisions(&outputs)[..3], [(73, 0), (74, 1), (75, 2)]);
    let row = |first: usize| (0..16).map(move |at| first + 2 * at);
    let leaving: Vec<usize> = row(78).chain(row(142)).collect();
    assert_eq!(edges(&outputs, |output| output.forward_valid), leaving);
    assert!(leaving.iter().all(|&edge| outputs[edge].forward_pixels == [1; 4]));
    let ends = |edge: &usize| outputs[*edge].forward_first && outputs[*edge].forward_last;
    assert!(leaving.iter().all(ends));
}
