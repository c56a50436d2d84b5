// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports of a serial array.

use crate::port::{sync_input, sync_output, threshold_ports};
use crate::{Direction, Feed, Port, PortRole, Qualifier, SerialDesign};

/// The ports of the array, inputs first.
pub(crate) fn ports(design: SerialDesign<'_>) -> Vec<Port> {
    use Direction::{Input, Output};
    let pixel = design.pixel_bits();
    // What there is one of per lane with parallel feed, and one of with raster feed.
    let fed = |mut port: Port| match design.feed() {
        Feed::Raster => port,
        Feed::Parallel => {
            port.lanes = design.lanes();
            port.per_lane = true;
            port.doc.push_str("; element i is lane i");
            port
        }
    };
    let with = |role, mut port: Port| {
        port.qualifier = Qualifier::With(role);
        port
    };
    let single = Port::single;

    let mut list = vec![
        single(Input, PortRole::Clock, 1, "clock, rising edge"),
        single(Input, PortRole::Reset, 1, "synchronous reset, active high"),
        single(Input, PortRole::Valid, 1, "a pixel is taken at this edge, if ready_o"),
    ];
    list.extend(sync_input(&design));
    list.push(fed(single(Input, PortRole::Pixel, pixel, "pixel, row by row")));
    list.extend(threshold_ports(&design));
    list.push(single(Output, PortRole::Ready, 1, "a pixel would be taken at the next edge"));
    list.extend(sync_output(&design));

    let score = |role, width, doc| with(PortRole::ScoreValid, single(Output, role, width, doc));
    list.push(single(Output, PortRole::ScoreValid, 1, "a score of one region"));
    let doc = "which: 0 the temporal count, 1.. the features; only with score_valid_o";
    list.push(score(PortRole::ScoreIndex, design.score_index_bits(), doc));
    list.push(score(PortRole::Region, design.region_bits(), "its region; only with score_valid_o"));
    list.push(score(PortRole::AnyScore, design.any_score_bits(), "it; only with score_valid_o"));
    let doc = "the decision for region_o; comes with its last score";
    list.push(single(Output, PortRole::DecisionValid, 1, doc));
    let doc = "spatial relevance; 0 unless decision_valid_o";
    list.push(single(Output, PortRole::Srs, 1, doc));
    let doc = "temporal relevance; 0 unless decision_valid_o";
    list.push(single(Output, PortRole::Trs, 1, doc));
    list.push(single(Output, PortRole::Active, 1, "SRS and TRS; 0 unless decision_valid_o"));

    let leaving = |role, width, doc| with(PortRole::ForwardValid, single(Output, role, width, doc));
    let doc = "a pixel of an active region leaves";
    list.push(fed(single(Output, PortRole::ForwardValid, 1, doc)));
    let doc = "that pixel; only with forward_valid_o";
    list.push(fed(leaving(PortRole::ForwardPixel, pixel, doc)));
    let doc = "its number in its region; only with forward_valid_o";
    list.push(leaving(PortRole::ForwardPosition, design.position_bits(), doc));
    match design.feed() {
        Feed::Parallel => {
            if design.fold() > 1 {
                let doc = "slot of its region in its lane; only with forward_valid_o";
                list.push(leaving(PortRole::ForwardSlot, design.slot_bits(), doc));
            }
        }
        Feed::Raster => {
            let doc = "its region; only with forward_valid_o";
            list.push(leaving(PortRole::ForwardRegion, design.region_bits(), doc));
        }
    }
    list
}
