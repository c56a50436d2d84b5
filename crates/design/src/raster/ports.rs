// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports of a raster core: which there are depends on where the frame store is, and on whether pixels leave.

use crate::port::{sync_input, sync_output, threshold_ports};
use crate::{Design, Direction, Port, PortRole, Qualifier, RasterDesign, Store};

/// Bits of `lost_count_o`, which stays at its largest value.
const LOST_COUNT_BITS: u32 = 16;

/// Frames since reset are counted modulo this, a power of two: a receiver tells frames apart by their numbers if it stalls,
/// or if nothing changes, for fewer of them.
pub const FRAME_NUMBERS: u32 = 256;

/// The ports of the core, inputs first.
pub(super) fn ports(design: RasterDesign<'_>) -> Vec<Port> {
    use Direction::{Input, Output};
    let single = Port::single;
    let word = design.pixels_per_clock() * design.pixel_bits();
    let is_outside = design.store() == Store::External;

    let mut list = vec![
        single(Input, PortRole::Clock, 1, "clock, rising edge"),
        single(Input, PortRole::Reset, 1, "synchronous reset, active high"),
        single(Input, PortRole::Valid, 1, "a word is taken at this edge, if ready_o"),
    ];
    list.extend(sync_input(&design));
    let doc = "word of pixels, the left one in the lowest bits";
    list.push(single(Input, PortRole::Pixel, word, doc));
    if is_outside {
        let doc = "a reference is on the port below";
        list.push(single(Input, PortRole::ReferenceValid, 1, doc));
        let doc = "the word of the frame before, if reference_ready_o";
        list.push(single(Input, PortRole::ReferencePixel, word, doc));
    }
    if design.forwards() {
        let doc = "what is on the forward ports is taken";
        list.push(single(Input, PortRole::ForwardReady, 1, doc));
    }
    list.extend(threshold_ports(&design));
    list.push(single(Output, PortRole::Ready, 1, "a word would be taken at the next edge"));
    list.extend(sync_output(&design));
    if is_outside {
        list.extend(store_outputs(word));
    }
    list.extend(decision_outputs(&design));
    if design.forwards() {
        list.extend(forward_outputs(&design, word));
    }
    list
}

/// An output that means something only while that of another role is 1.
fn with(valid: PortRole, role: PortRole, width: u32, doc: &str) -> Port {
    let port = Port::single(Direction::Output, role, width, doc);
    Port { qualifier: Qualifier::With(valid), ..port }
}

/// The streams to and from a frame store outside.
fn store_outputs(word: u32) -> [Port; 5] {
    let single = |role, doc| Port::single(Direction::Output, role, 1, doc);
    let stored = |role, width, doc| with(PortRole::StoreValid, role, width, doc);
    [
        single(PortRole::ReferenceReady, "reference_pixel_i is taken at the next edge"),
        single(PortRole::StoreValid, "a word is to be stored"),
        stored(PortRole::StorePixel, word, "that word; only with store_valid_o"),
        stored(PortRole::StoreLast, 1, "the last of a row; only with store_valid_o"),
        single(PortRole::Underrun, "a reference was missing since reset"),
    ]
}

fn decision_outputs(design: &Design) -> Vec<Port> {
    let single = |role, doc| Port::single(Direction::Output, role, 1, doc);
    let decided = |role, width, doc| with(PortRole::DecisionValid, role, width, doc);
    let doc = "the region that is decided; only with decision_valid_o";
    let mut list = vec![
        single(PortRole::DecisionValid, "the decision for region_o"),
        decided(PortRole::Region, design.region_bits(), doc),
        single(PortRole::Srs, "spatial relevance; 0 unless decision_valid_o"),
        single(PortRole::Trs, "temporal relevance; 0 unless decision_valid_o"),
        single(PortRole::Active, "SRS and TRS; 0 unless decision_valid_o"),
    ];
    for feature in design.features() {
        let doc = "score; only with decision_valid_o";
        list.push(decided(PortRole::Score(feature.kind()), feature.score_bits(), doc));
    }
    let doc = "changed pixels; only with decision_valid_o";
    list.push(decided(PortRole::TemporalCount, design.count_bits(), doc));
    list
}

fn forward_outputs(design: &Design, word: u32) -> [Port; 13] {
    let single = |role, width, doc| Port::single(Direction::Output, role, width, doc);
    let leaving = |role, width, doc| with(PortRole::ForwardValid, role, width, doc);
    let losing = |role, width, doc| with(PortRole::LostValid, role, width, doc);
    let (regions, frames) = (design.region_bits(), FRAME_NUMBERS.ilog2());
    let region = "its region; only with forward_valid_o";
    let position = "number in its region of its first pixel; only with forward_valid_o";
    let pixels = "that word, the left pixel in the lowest bits; only with forward_valid_o";
    let first = "the first word of its region; only with forward_valid_o";
    let last = "the last that comes of its region; only with forward_valid_o";
    let abort = "its region was lost in the middle: no more comes; only with forward_valid_o";
    let frame = "number of its frame since reset, modulo 256; only with forward_valid_o";
    let count = "regions lost since reset, at most 65,535";
    let lost_frame = "number of its frame since reset, modulo 256; only with lost_valid_o";
    [
        single(PortRole::ForwardValid, 1, "a word of an active region leaves"),
        leaving(PortRole::ForwardRegion, regions, region),
        leaving(PortRole::ForwardPosition, design.position_bits(), position),
        leaving(PortRole::ForwardPixel, word, pixels),
        leaving(PortRole::ForwardFirst, 1, first),
        leaving(PortRole::ForwardLast, 1, last),
        leaving(PortRole::ForwardAbort, 1, abort),
        leaving(PortRole::ForwardFrame, frames, frame),
        single(PortRole::Lost, 1, "a region was lost since reset"),
        single(PortRole::LostCount, LOST_COUNT_BITS, count),
        single(PortRole::LostValid, 1, "a region was lost at the edge before"),
        losing(PortRole::LostRegion, regions, "that region; only with lost_valid_o"),
        losing(PortRole::LostFrame, frames, lost_frame),
    ]
}
