// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the external frame store, with every clock computed by hand from `docs/raster.md`. The
//! edge that takes the first word has number 1.

use super::examples::{design, edge_list, edges, simulate};

/// The frame has 16x8 pixels and one window. Word i of a frame that begins at edge b + 1 comes to
/// the tail at edge b + i + 18. S is 3, so the word is stored after edge b + i + 21. Its reference
/// is taken at edge b + i + 20, so `reference_ready_o` is 1 after the edge before. The second frame
/// begins at edge 153, so b is 152.
#[test]
fn words_are_stored_and_references_taken_in_plain_pipelining() {
    let outputs =
        simulate(&design("edge", (16, 8), &["hardware.store=external"]), 2, 320, |_| true);
    let stored = [edge_list(21..=148), edge_list(173..=300)].concat();
    assert_eq!(edges(&outputs, |output| output.store_valid), stored);
    assert_eq!(edges(&outputs, |output| output.reference_ready), edge_list(171..=298));
    let rows = |first: usize| (0..8).map(move |row| first + 15 + 16 * row);
    let last = edges(&outputs, |output| output.store_valid && output.store_last);
    assert_eq!(last, rows(21).chain(rows(173)).collect::<Vec<_>>());
    assert!(!outputs[320].underrun);
}

/// The frame has 29x7 pixels in words of two, regions of 8x8, one median, and deep pipelining. Word
/// i comes to the tail at edge b + i + 18, S is 13, references are taken 11 clocks later, and D is
/// 22. T0 is 111 and Z is 34, so the second frame begins at edge 168, and b is 167.
#[test]
fn references_are_taken_a_clock_earlier_in_deep_pipelining() {
    let more = [
        "region.size=8",
        "denoise.filter=median3x3",
        "hardware.pixels_per_clock=2",
        "hardware.pipelining=deep",
        "hardware.store=external",
    ];
    let outputs = simulate(&design("variance", (29, 7), &more), 2, 340, |_| true);
    let decided = edges(&outputs, |output| output.decision_valid);
    assert_eq!(decided[..4], [155, 159, 163, 167]);
    // A row has 16 words. The core makes one of them, and one whole row.
    let stored = [edge_list(31..=158), edge_list(198..=325)].concat();
    assert_eq!(edges(&outputs, |output| output.store_valid), stored);
    assert_eq!(edges(&outputs, |output| output.reference_ready), edge_list(195..=322));
    let last = edges(&outputs, |output| output.store_valid && output.store_last);
    assert_eq!(last[..8], [46, 62, 78, 94, 110, 126, 142, 158]);
}
