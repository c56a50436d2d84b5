// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports of a raster core.

use crate::port::threshold_ports;
use crate::{Design, Direction, Port, PortRole, Qualifier};

/// Bits of `lost_count_o`, which stays at its largest value.
const LOST_COUNT_BITS: u32 = 16;

/// The ports of the core, inputs first.
pub(super) fn ports(design: &Design) -> Vec<Port> {
    use Direction::{Input, Output};
    let single = Port::single;
    let word = design.pixels_per_clock() * design.pixel_bits();
    let with = |role, mut port: Port| {
        port.qualifier = Qualifier::With(role);
        port
    };

    let mut list = vec![
        single(Input, PortRole::Clock, 1, "clock, rising edge"),
        single(Input, PortRole::Reset, 1, "synchronous reset, active high"),
        single(Input, PortRole::Valid, 1, "a word is taken at this edge, if ready_o"),
        single(Input, PortRole::Pixel, word, "word of pixels, the left one in the lowest bits"),
        single(Input, PortRole::ForwardReady, 1, "what is on the forward ports is taken"),
    ];
    list.extend(threshold_ports(design));
    list.push(single(Output, PortRole::Ready, 1, "a word would be taken at the next edge"));

    list.push(single(Output, PortRole::DecisionValid, 1, "the decision for region_o"));
    let decided =
        |role, width, doc| with(PortRole::DecisionValid, single(Output, role, width, doc));
    let doc = "the region that is decided; only with decision_valid_o";
    list.push(decided(PortRole::Region, design.region_bits(), doc));
    let doc = "spatial relevance; 0 unless decision_valid_o";
    list.push(single(Output, PortRole::Srs, 1, doc));
    let doc = "temporal relevance; 0 unless decision_valid_o";
    list.push(single(Output, PortRole::Trs, 1, doc));
    list.push(single(Output, PortRole::Active, 1, "SRS and TRS; 0 unless decision_valid_o"));
    for feature in design.features() {
        let doc = "score; only with decision_valid_o";
        list.push(decided(PortRole::Score(feature.kind()), feature.score_bits(), doc));
    }
    let doc = "changed pixels; only with decision_valid_o";
    list.push(decided(PortRole::TemporalCount, design.count_bits(), doc));

    let leaving = |role, width, doc| with(PortRole::ForwardValid, single(Output, role, width, doc));
    list.push(single(Output, PortRole::ForwardValid, 1, "a word of an active region leaves"));
    let doc = "its region; only with forward_valid_o";
    list.push(leaving(PortRole::ForwardRegion, design.region_bits(), doc));
    let doc = "number in its region of its first pixel; only with forward_valid_o";
    list.push(leaving(PortRole::ForwardPosition, design.position_bits(), doc));
    let doc = "that word, the left pixel in the lowest bits; only with forward_valid_o";
    list.push(leaving(PortRole::ForwardPixel, word, doc));
    list.push(single(Output, PortRole::Lost, 1, "a region was lost since reset"));
    let doc = "regions lost since reset, at most 65,535";
    list.push(single(Output, PortRole::LostCount, LOST_COUNT_BITS, doc));
    list
}
