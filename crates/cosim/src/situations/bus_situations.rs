// SPDX-License-Identifier: MIT OR Apache-2.0
//! Situations of a core on AXI.

use super::occurrence::Occurrences;
use foveate_design::{RasterDesign, RasterTiming};
use std::collections::BTreeMap;

/// The events of `docs/axi.md`, in the order of their bits.
pub(crate) const EVENTS: [&str; 8] = [
    "eol_early",
    "eol_late",
    "sof_early",
    "sof_late",
    "frame_skipped",
    "region_dropped",
    "row_dropped",
    "frame_done",
];

/// The number of regions for whose packets a core has room; one more may be on its way to the sink.
const PACKET_REGIONS: u32 = 4;

/// The counts from the buses of a core, over all its sessions.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct BusSituationCounts {
    /// The number of times that `events` was read with the bit of an event, by event.
    pub(crate) event_reads: BTreeMap<&'static str, u64>,
    /// The number of times that an event rose at the edge at which a write that clears it was
    /// taken, by event.
    pub(crate) met_clears: BTreeMap<&'static str, u64>,
    /// The number of frames that would have been decided otherwise with the earlier value of a
    /// threshold, by the register of the threshold.
    pub(crate) taken_over: BTreeMap<String, u64>,
    /// The number of packets with pixels; `means` counts those with means.
    pub(crate) pixels: u64,
    pub(crate) means: u64,
    /// The number of compared decisions of regions that were lost in the frame before.
    pub(crate) behind_loss: u64,
    /// The number of first frames after a restart, without those after a reset.
    pub(crate) restarted: u64,
    /// The number of frames that came while the core was not enabled.
    pub(crate) left_out: u64,
    /// The number of packets that a reset has cut off.
    pub(crate) cut: u64,
    /// The number of frames whose decisions were compared behind a skipped frame.
    pub(crate) behind_skipped: u64,
    /// The number of frames whose map of classes was written.
    pub(crate) maps: u64,
    /// The number of frames with another map than the frame before, while the core commits all the
    /// time.
    pub(crate) maps_by_turns: u64,
    /// The number of FRAME packets that left after a version behind theirs was read.
    pub(crate) frames_behind_commit: u64,
    /// The number of resets before which a commit was taken that had not been read.
    pub(crate) commits_before_reset: u64,
}

/// A situation of a core on AXI.
struct BusSituation {
    name: &'static str,
    is_possible: fn(RasterDesign<'_>) -> bool,
    count: fn(&BusSituationCounts) -> u64,
}

const fn always(_: RasterDesign<'_>) -> bool {
    true
}

/// The situations that do not depend on an event or a threshold register.
const SITUATIONS: &[BusSituation] = &[
    BusSituation {
        name: "pixels of a region leave",
        is_possible: always,
        count: |facts| facts.pixels,
    },
    BusSituation {
        name: "means of a region leave",
        is_possible: |design| design.periphery().is_some(),
        count: |facts| facts.means,
    },
    BusSituation {
        name: "a region is decided behind its loss",
        is_possible: can_drop_regions,
        count: |facts| facts.behind_loss,
    },
    BusSituation {
        name: "a frame is decided behind a skipped one",
        is_possible: always,
        count: |facts| facts.behind_skipped,
    },
    BusSituation { name: "a restart", is_possible: always, count: |facts| facts.restarted },
    BusSituation {
        name: "a frame comes while the core is not enabled",
        is_possible: always,
        count: |facts| facts.left_out,
    },
    BusSituation {
        name: "a reset comes within a packet",
        is_possible: always,
        count: |facts| facts.cut,
    },
    BusSituation {
        name: "a frame uses a map of classes that was written",
        is_possible: |design| design.zones().is_some(),
        count: |facts| facts.maps,
    },
    BusSituation {
        name: "a map of classes is committed at the end of each frame",
        is_possible: |design| design.zones().is_some(),
        count: |facts| facts.maps_by_turns,
    },
    BusSituation {
        name: "a FRAME packet leaves behind the next commit",
        is_possible: |design| design.zones().is_some(),
        count: |facts| facts.frames_behind_commit,
    },
    BusSituation {
        name: "a commit waits for the end of a reset",
        is_possible: |design| design.zones().is_some(),
        count: |facts| facts.commits_before_reset,
    },
];

impl BusSituationCounts {
    /// Returns the count of each situation that the design can have. `thresholds` are the registers
    /// of the thresholds that were written.
    pub(crate) fn occurrences(
        &self,
        design: RasterDesign<'_>,
        thresholds: &[String],
    ) -> Occurrences {
        let mut all = Occurrences::default();
        for situation in SITUATIONS.iter().filter(|own| (own.is_possible)(design)) {
            all.add(situation.name, (situation.count)(self));
        }
        let count = |of: &BTreeMap<&str, u64>, event| of.get(event).copied().unwrap_or_default();
        for event in EVENTS.into_iter().filter(|event| can_event_happen(design, event)) {
            all.add(&format!("{event} is read"), count(&self.event_reads, event));
            all.add(&format!("{event} and its clear at one clock"), count(&self.met_clears, event));
        }
        for register in thresholds {
            let count = self.taken_over.get(register).copied().unwrap_or_default();
            all.add(&format!("{register} is written, kept and decides"), count);
        }
        all
    }
}

fn can_event_happen(design: RasterDesign<'_>, event: &str) -> bool {
    match event {
        "region_dropped" => can_drop_regions(design),
        "row_dropped" => can_drop_rows(design),
        _ => true,
    }
}

/// Returns true if a sink that stops loses regions: two frames may be under way, and the buffer of
/// the array and the places for packets together hold less.
pub(crate) fn can_drop_regions(design: RasterDesign<'_>) -> bool {
    let can_lose = design.timing().departure().buffered_rows.is_some();
    let buffered = RasterTiming::from_design(design).buffer_rows;
    let overwritten = (2 * design.rows()).saturating_sub(buffered) * design.columns();
    can_lose && overwritten > PACKET_REGIONS + 1
}

/// Returns true if a sink that stops loses rows. Two rows wait. So a third row of the same frame is
/// lost, or a row of the next frame, which begins only if the array loses regions instead of
/// waiting for the sink.
pub(crate) fn can_drop_rows(design: RasterDesign<'_>) -> bool {
    let loses_regions = design.timing().departure().buffered_rows.is_some();
    design.rows() > if loses_regions { 1 } else { 2 }
}
