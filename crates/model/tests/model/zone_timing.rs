// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of each rule of `docs/zones.md` at its edge, for both organizations with a memory of
//! classes. Frames are black, so that only `always` regions have SRS = 1. Every clock is computed
//! by hand from `docs/serial.md` and `docs/raster.md`.

use std::collections::BTreeMap;

use foveate_design::{Design, DesignConfig, PortRole};
use foveate_model::{ClassMapInputs, CoreInput, CycleModel, rcm_model};

use crate::port_thresholds::PortThresholds;

/// A word whose regions are all `always`.
const ALL_ALWAYS: u32 = u32::MAX;

/// A core with regions of 4x4 pixels in one row.
struct ZonedCore {
    design: Design,
    /// The number of edges at which a frame is taken.
    taken: i64,
    /// The number of edges after T0 that a frame occupies.
    work: i64,
    /// The number of edges from T0 to the first edge that can take the next frame.
    next: i64,
}

impl ZonedCore {
    /// Makes a serial array of isolated regions without a filter: J = L + 3 n + L + 14 n + L + n.
    fn serial(regions: i64, zones: &str) -> Self {
        let hardware = "organization = \"serial\"\n";
        let design = design((4 * regions, 4), "feature = \"edge\"\nlevel = 0\n", hardware, zones);
        let work = 3 * regions + 18 * 16;
        Self { design, taken: 16, work, next: work + 2 }
    }

    /// Makes a raster core without windows. A frame has three rows of pixels, and the core adds a
    /// fourth one, so Z = L. With `range`, D is 7.
    fn raster(regions: i64, zones: &str) -> Self {
        let hardware = "organization = \"raster\"\n";
        let design = design((4 * regions, 3), "feature = \"range\"\n", hardware, zones);
        let row = 4 * regions;
        Self { design, taken: 3 * row, work: row, next: row + 7 + 1 }
    }

    /// Returns one core of each organization, with few regions, all of them normal.
    fn both() -> [Self; 2] {
        [Self::serial(2, ""), Self::raster(4, "")]
    }

    /// Returns the last edge that a frame occupies whose first edge is `first`.
    fn last_edge(&self, first: i64) -> i64 {
        first + self.taken - 1 + self.work
    }

    /// Returns the first edge that can take the frame after a frame whose first edge is `first`.
    fn edge_of_next(&self, first: i64) -> i64 {
        first + self.taken - 1 + self.next
    }

    /// Plays frames with these first edges and the inputs of the memory at these edges.
    fn play(&self, frames: &[i64], inputs: &[(i64, ClassMapInputs)]) -> ZoneTrace {
        let inputs: BTreeMap<_, _> = inputs.iter().copied().collect();
        let mut model = rcm_model(&self.design);
        let thresholds = PortThresholds::of_camera(&self.design);
        let port = if self.design.as_serial().is_some() { self.design.regions() } else { 1 };
        let black = vec![0; port as usize];
        let mut trace = ZoneTrace::default();
        let end = frames.iter().map(|&first| self.edge_of_next(first) + 20).max().unwrap();
        for edge in 1..=end {
            let map = inputs.get(&edge).copied().unwrap_or_default();
            let valid = frames.iter().any(|&first| (first..first + self.taken).contains(&edge));
            assert!(!valid || model.is_ready(), "edge {edge}");
            let zones = Some(thresholds.zone_inputs(map));
            let idle = CoreInput::idle(&black, &thresholds.own);
            model.clock(&CoreInput { valid, zones, ..idle });
            trace.record(edge, &*model);
        }
        trace
    }
}

fn design((width, height): (i64, i64), feature: &str, hardware: &str, zones: &str) -> Design {
    let toml = format!(
        "[frame]\nwidth = {width}\nheight = {height}\n[region]\nsize = 4\n\
         [denoise]\nfilter = \"none\"\n[[spatial]]\n{feature}min_score = 1\n\
         [temporal]\nlevel = 0\nmin_count = 0\n[zones]\n{zones}[hardware]\n{hardware}"
    );
    DesignConfig::from_toml(&toml).unwrap().validate().unwrap()
}

fn write(address: u32, word: u32) -> ClassMapInputs {
    ClassMapInputs { write: true, address, word, commit: false }
}

fn write_and_commit(address: u32, word: u32) -> ClassMapInputs {
    ClassMapInputs { commit: true, ..write(address, word) }
}

/// The outputs of a core with zones.
#[derive(Debug, Default, PartialEq, Eq)]
struct ZoneTrace {
    /// The edges after which `zone_pending_o` is 1.
    pending: Vec<i64>,
    /// The regions with SRS = 1 of every frame that is decided.
    relevant: Vec<Vec<u64>>,
}

impl ZoneTrace {
    fn record(&mut self, edge: i64, model: &dyn CycleModel) {
        self.pending.extend(model.is_high(PortRole::ClassPending).then_some(edge));
        if model.is_high(PortRole::DecisionValid) {
            let mut region = Vec::new();
            model.append_output(PortRole::Region, &mut region);
            if region == [0] {
                self.relevant.push(Vec::new());
            }
            if model.is_high(PortRole::Srs) {
                self.relevant.last_mut().unwrap().extend(region);
            }
        }
    }

    /// Returns true for each frame in which all regions of the core have SRS = 1, and false if none
    /// has.
    fn always_frames(&self, core: &ZonedCore) -> Vec<bool> {
        let all: Vec<u64> = (0..core.design.regions().into()).collect();
        let is_always = |regions: &Vec<u64>| {
            assert!(regions.is_empty() || *regions == all, "{regions:?}");
            !regions.is_empty()
        };
        self.relevant.iter().map(is_always).collect()
    }
}

/// The map also has the word that is written at the edge of the commit.
#[test]
fn a_frame_uses_the_map_that_is_committed_two_edges_before_it() {
    for core in ZonedCore::both() {
        let first = 10;
        let (last, second) = (core.last_edge(first), core.edge_of_next(first));
        for (commit, frames, pending) in [
            (first - 3, [true, true], first - 3..=first - 3),
            (first - 2, [true, true], first - 2..=first - 2),
            (first - 1, [false, true], first - 1..=last),
            (first, [false, true], first..=last),
            (first + 1, [false, true], first + 1..=last),
            (last - 1, [false, true], last - 1..=last),
            (last, [false, true], last..=last),
            (second - 2, [false, true], second - 2..=second - 2),
            (second - 1, [false, false], second - 1..=core.last_edge(second)),
        ] {
            let trace = core.play(&[first, second], &[(commit, write_and_commit(0, ALL_ALWAYS))]);
            assert_eq!(trace.pending, pending.collect::<Vec<_>>(), "{commit}");
            assert_eq!(trace.always_frames(&core), frames, "{commit}");
        }
    }
}

/// Both banks begin with the map of the configuration, and each keeps the words that are not
/// written.
#[test]
fn a_commit_exchanges_the_banks() {
    let zones = "areas = [{ class = \"always\", rectangle = [0, 0, 4, 3] }]\n";
    for core in [ZonedCore::serial(17, zones), ZonedCore::raster(17, zones)] {
        let mut frames = vec![10];
        for _ in 0..4 {
            frames.push(core.edge_of_next(*frames.last().unwrap()) + 9);
        }
        let before = |frame: usize| frames[frame] - 5;
        // Word 1 has region 16 alone. Its other bits have no effect.
        let inputs = [
            (before(1), write_and_commit(1, ALL_ALWAYS)),
            (before(2), write_and_commit(0, 3 << 2)),
            (before(3), ClassMapInputs { commit: true, ..ClassMapInputs::default() }),
            (before(4), write(1, 0xffff_fff0)),
            (before(4) + 1, write_and_commit(0, 0xc000_0000)),
        ];
        let trace = core.play(&frames, &inputs);
        assert_eq!(trace.relevant, [vec![0], vec![0, 16], vec![1], vec![0, 16], vec![15]]);
    }
}
