// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the external frame store and of cores without forwarding, with every clock computed by
//! hand from `docs/raster.md`. The edge that takes the first word has number 1.

use std::collections::VecDeque;
use std::ops::RangeInclusive;

use foveate_design::{Design, DesignConfig};
use foveate_model::{CoreInput, RasterOutput, RasterRcm, ThresholdInputs};

/// Returns a design with one feature and regions of 4x4 pixels, all of which are relevant.
fn design(feature: &str, frame: (u32, u32), more: &[&str]) -> Design {
    let toml = format!(
        "[frame]\nwidth = {}\nheight = {}\n[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n\
         [[spatial]]\nfeature = \"{feature}\"\nmin_score = 0\n[temporal]\nlevel = 8\nmin_count = 1\n\
         [hardware]\norganization = \"raster\"\n",
        frame.0, frame.1
    );
    DesignConfig::from_toml_with(&toml, more).unwrap().validate().unwrap()
}

fn external_store_design(feature: &str, frame: (u32, u32), more: &[&str]) -> Design {
    design(feature, frame, &[more, &["hardware.store=external"]].concat())
}

/// A test bench of a core with an external store: a queue that can return a word as soon as it is
/// stored.
struct StoreBench {
    rcm: RasterRcm,
    thresholds: ThresholdInputs,
    width: u64,
    pixels: usize,
    queue: VecDeque<Vec<u16>>,
    /// The outputs after every edge.
    outputs: Vec<RasterOutput>,
}

impl StoreBench {
    fn new(design: &Design) -> Self {
        let rcm = RasterRcm::new(design.as_raster().unwrap());
        Self {
            thresholds: ThresholdInputs::from_camera(design),
            width: u64::from(design.width())
                .div_ceil(design.as_raster().unwrap().pixels_per_clock().into()),
            pixels: design.as_raster().unwrap().pixels_per_clock() as usize,
            queue: VecDeque::new(),
            outputs: vec![rcm.output().clone()],
            rcm,
        }
    }

    /// Applies edges up to `last`, at which frames come as fast as they are taken, without a word
    /// at the edges of `gaps`. The pixels of word x of a row are `picture(x)`. `fault` returns the
    /// fault of the memory at an edge.
    fn run(
        &mut self,
        last: usize,
        gaps: &[usize],
        picture: impl Fn(u64) -> u16,
        fault: impl Fn(usize) -> MemoryFault,
    ) {
        let mut taken = 0;
        for edge in self.outputs.len()..=last {
            let valid = !gaps.contains(&edge);
            let pixels = vec![picture(taken % self.width); self.pixels];
            let is_asked = self.rcm.output().reference_ready;
            let oldest = self.queue.front().cloned();
            let (reference_valid, reference) = match fault(edge) {
                MemoryFault::None => (oldest.is_some(), oldest.unwrap_or(vec![0; self.pixels])),
                MemoryFault::Late => (false, vec![0; self.pixels]),
                MemoryFault::Wrong(pixel) => (true, vec![pixel; self.pixels]),
            };
            if is_asked && reference_valid {
                self.queue.pop_front();
            }
            taken += u64::from(valid && self.rcm.output().ready);
            let input = CoreInput {
                reset: false,
                valid,
                sof: false,
                pixels: &pixels,
                reference_valid,
                reference_pixels: &reference,
                forward_ready: true,
                thresholds: &self.thresholds,
                border: 0,
                zones: None,
            };
            let shown = self.rcm.step(&input).clone();
            self.queue.extend(shown.store_valid.then(|| shown.store_pixels.clone()));
            self.outputs.push(shown);
        }
    }

    fn reset(&mut self) {
        let word = vec![0; self.pixels];
        let input = CoreInput {
            reset: true,
            valid: true,
            sof: false,
            pixels: &word,
            reference_valid: true,
            reference_pixels: &word,
            forward_ready: true,
            thresholds: &self.thresholds,
            border: 0,
            zones: None,
        };
        self.outputs = vec![self.rcm.step(&input).clone()];
        self.queue.clear();
    }

    fn edges(&self, which: impl Fn(&RasterOutput) -> bool) -> Vec<usize> {
        (0..self.outputs.len()).filter(|&edge| which(&self.outputs[edge])).collect()
    }

    fn reference_edges(&self) -> Vec<usize> {
        self.edges(|output| output.reference_ready)
    }

    fn store_edges(&self) -> Vec<usize> {
        self.edges(|output| output.store_valid)
    }

    /// Returns the temporal count of every region of the second frame.
    fn counts(&self, regions: usize) -> Vec<u32> {
        let decided = self.edges(|output| output.decision_valid);
        let second = decided[regions..2 * regions].iter();
        second.map(|&edge| self.outputs[edge].temporal_count).collect()
    }
}

/// The fault of the memory at an edge.
#[derive(Clone, Copy)]
enum MemoryFault {
    None,
    /// The memory has no word. The same word comes at the next edge.
    Late,
    /// The memory has a word of this pixel instead of the right one.
    Wrong(u16),
}

fn no_fault(_: usize) -> MemoryFault {
    MemoryFault::None
}

fn edge_list(ranges: &[RangeInclusive<usize>]) -> Vec<usize> {
    ranges.iter().cloned().flatten().collect()
}

/// The frame has 16x8 pixels and one window. Word i of a frame that begins at edge b + 1 comes to
/// the tail at edge b + i + 18. S is 3, so the word is stored after edge b + i + 21. Its reference
/// is taken at edge b + i + 20, so `reference_ready_o` is 1 after the edge before. The second frame
/// begins at edge 153, so b is 152.
#[test]
fn words_are_stored_and_references_taken_in_plain_pipelining() {
    let mut bench = StoreBench::new(&external_store_design("edge", (16, 8), &[]));
    bench.run(320, &[], |_| 1, no_fault);
    assert_eq!(bench.store_edges(), edge_list(&[21..=148, 173..=300]));
    assert_eq!(bench.reference_edges(), edge_list(&[171..=298]));
    let rows = |first: usize| (0..8).map(move |row| first + 15 + 16 * row);
    let last = bench.edges(|output| output.store_valid && output.store_last);
    assert_eq!(last, rows(21).chain(rows(173)).collect::<Vec<_>>());
    assert!(bench.edges(|output| output.underrun).is_empty());
    assert_eq!(bench.counts(8), [0; 8]);
    // The 128 words of the first frame were taken, and those of the second frame wait.
    assert_eq!(bench.queue.len(), 128);
}

/// The frame is that of the test before, without a word at two edges of the second frame. Word 10
/// comes at edge 164 instead of 163. No word is in the tail yet, so the whole frame is one clock
/// later. Word 39 comes at edge 194 instead of 193, and with it word 22 of the tail. That word and
/// all later ones are another clock later.
#[test]
fn a_gap_delays_references_and_stores_of_the_tail() {
    let mut bench = StoreBench::new(&external_store_design("edge", (16, 8), &[]));
    bench.run(320, &[163, 193], |_| 1, no_fault);
    assert_eq!(bench.reference_edges(), edge_list(&[172..=193, 195..=300]));
    assert_eq!(bench.store_edges(), edge_list(&[21..=148, 174..=195, 197..=302]));
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
    ];
    let mut bench = StoreBench::new(&external_store_design("variance", (29, 7), &more));
    bench.run(340, &[], |x| if x < 15 { 7 } else { 9 }, no_fault);
    let decided = bench.edges(|output| output.decision_valid);
    assert_eq!(decided[..4], [155, 159, 163, 167]);
    // A row has 16 words. The core makes one of them, and one whole row.
    assert_eq!(bench.store_edges(), edge_list(&[31..=158, 198..=325]));
    assert_eq!(bench.reference_edges(), edge_list(&[195..=322]));
    let last = bench.edges(|output| output.store_valid && output.store_last);
    assert_eq!(last[..8], [46, 62, 78, 94, 110, 126, 142, 158]);
    assert!(bench.outputs[31..=158].iter().all(|output| output.store_pixels == [7, 7]));
}

/// There is no window. Word i comes to the tail at edge b + i + 1 and is stored after b + i + 3,
/// with the smallest possible S. Its reference is taken at the edge after that of the tail. D is 6,
/// and the second frame begins at edge 135.
#[test]
fn the_least_latency_takes_references_at_the_next_edge() {
    let mut bench = StoreBench::new(&external_store_design("mad", (16, 8), &[]));
    // The third frame begins at edge 269, before the last decision of the second frame at 327.
    bench.run(330, &[], |_| 1, no_fault);
    assert_eq!(bench.reference_edges(), edge_list(&[135..=262, 269..=330]));
    assert_eq!(bench.store_edges(), edge_list(&[3..=130, 137..=264, 271..=330]));
    assert_eq!(bench.counts(8), [0; 8]);
}

/// Word 5 of the second frame is in region 1. Its reference is taken at edge 177.
#[test]
fn decisions_use_the_references_of_the_external_store() {
    let design = external_store_design("edge", (16, 8), &[]);
    let counts = |fault: &dyn Fn(usize) -> MemoryFault| {
        let mut bench = StoreBench::new(&design);
        bench.run(320, &[], |_| 1, fault);
        (bench.counts(8), bench.edges(|output| output.underrun))
    };
    let wrong =
        counts(&|edge| if edge == 177 { MemoryFault::Wrong(200) } else { MemoryFault::None });
    assert_eq!(wrong, (vec![0, 1, 0, 0, 0, 0, 0, 0], vec![]));
    // The level is 8, so a reference of 9 is no change from 1. At edges 171 and 300 the core takes
    // no reference.
    for (edge, pixel) in [(177, 9), (171, 200), (300, 200)] {
        let same =
            counts(&|at| if at == edge { MemoryFault::Wrong(pixel) } else { MemoryFault::None });
        assert_eq!(same, (vec![0; 8], vec![]), "{edge}");
    }
}

/// Column 3 has the value 200, and all others have 1. One reference is late, that of word 0. From
/// there on every word is compared with the word on its left, so columns 3 and 4 have changed in
/// every row. (The value 0 instead of 1 is no change.)
#[test]
fn a_reference_that_is_late_shifts_all_that_follow() {
    let mut bench = StoreBench::new(&external_store_design("edge", (16, 8), &[]));
    let picture = |x| if x == 3 { 200 } else { 1 };
    bench.run(
        320,
        &[],
        picture,
        |edge| if edge == 172 { MemoryFault::Late } else { MemoryFault::None },
    );
    assert_eq!(bench.counts(8), [4, 4, 0, 0, 4, 4, 0, 0]);
    // `underrun_o` is 1 from the edge on that took the missing reference.
    assert_eq!(bench.edges(|output| output.underrun), edge_list(&[172..=320]));
    assert_eq!(bench.queue.len(), 129, "one is left");
    // At an edge that takes no reference there is no underrun. The last reference is taken at edge
    // 299.
    for (late, first) in [(171, None), (299, Some(299)), (300, None)] {
        let mut bench = StoreBench::new(&external_store_design("edge", (16, 8), &[]));
        bench.run(320, &[], picture, |edge| {
            if edge == late { MemoryFault::Late } else { MemoryFault::None }
        });
        assert_eq!(bench.edges(|output| output.underrun).first().copied(), first, "{late}");
    }
}

#[test]
fn a_reset_in_the_middle_of_a_frame_forgets_the_store() {
    let mut bench = StoreBench::new(&external_store_design("edge", (16, 8), &[]));
    bench.run(
        200,
        &[],
        |_| 1,
        |edge| if edge == 180 { MemoryFault::Late } else { MemoryFault::None },
    );
    let shown = &bench.outputs[200];
    assert!(shown.reference_ready && shown.store_valid && shown.underrun);
    bench.reset();
    let fresh = RasterRcm::new(external_store_design("edge", (16, 8), &[]).as_raster().unwrap())
        .output()
        .clone();
    assert_eq!(bench.outputs[0], fresh);
    assert!(!fresh.reference_ready && !fresh.store_valid && !fresh.underrun);
    // The frame after the reset is a first frame.
    bench.run(320, &[], |_| 1, no_fault);
    assert_eq!(bench.store_edges(), edge_list(&[21..=148, 173..=300]));
    assert_eq!(bench.reference_edges(), edge_list(&[171..=298]));
    let decided = bench.edges(|output| output.decision_valid);
    assert!(decided[..8].iter().all(|&edge| bench.outputs[edge].temporal_count == 16));
    assert_eq!(bench.counts(8), [0; 8]);
}

/// Without external streams, the kind of store inside of the core makes no difference at the ports.
#[test]
fn a_store_inside_has_no_streams() {
    let outputs = |store: &str| {
        let key = format!("hardware.store={store}");
        let mut bench = StoreBench::new(&design("edge", (16, 8), &[&key]));
        bench.run(320, &[], |x| (x * 17) as u16, no_fault);
        assert!(bench.store_edges().is_empty() && bench.reference_edges().is_empty());
        bench.outputs
    };
    let block = outputs("block");
    assert_eq!((outputs("ultra") == block, outputs("single-port") == block), (true, true));
}

/// Decisions and `ready_o` are the same as with forwarding, at the edges of
/// `a_frame_with_one_window`. All regions are active in the first frame, and nothing of them leaves
/// or is pending.
#[test]
fn without_forwarding_only_decisions_leave() {
    for feature in ["edge", "mad"] {
        let bench = |more: &[&str]| {
            let mut bench = StoreBench::new(&design(feature, (16, 8), more));
            bench.run(320, &[], |_| 1, no_fault);
            bench
        };
        let (without_forwarding, with_forwarding) =
            (bench(&["hardware.forward=false"]), bench(&[]));
        assert!(with_forwarding.edges(|output| output.forward_valid).len() == 128);
        assert!(without_forwarding.edges(|output| output.forward_valid || output.lost).is_empty());
        for (without_forwarding, with_forwarding) in
            without_forwarding.outputs.iter().zip(&with_forwarding.outputs)
        {
            let compared_ports = |output: &RasterOutput| {
                let RasterOutput { ready, decision_valid, region, srs, trs, active, .. } = *output;
                let counts = (output.scores, output.temporal_count);
                (ready, decision_valid, region, srs, trs, active, counts)
            };
            assert_eq!(compared_ports(without_forwarding), compared_ports(with_forwarding));
        }
        assert_eq!(without_forwarding.edges(|output| output.active).len(), 8);
    }
    let mut bench = StoreBench::new(&design("edge", (16, 8), &["hardware.forward=false"]));
    bench.run(152, &[], |_| 1, no_fault);
    // The last decision of the frame is on the ports, and its region is active.
    assert!(bench.outputs[152].active && !bench.rcm.is_pending());
    let mut bench = StoreBench::new(&design("edge", (16, 8), &[]));
    bench.run(152, &[], |_| 1, no_fault);
    assert!(bench.rcm.is_pending());
}
