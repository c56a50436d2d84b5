// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of a serial array.

use crate::interface::{BeatRegion, Interface, Stream, StreamRole};
use crate::port::{decided_ports, sync_input, sync_output, threshold_ports};
use crate::{Direction, Feed, Port, PortRole, SerialDesign};

/// Returns the interface of the array.
pub(crate) fn interface(design: SerialDesign<'_>) -> Interface {
    let input = |role, width, doc| Port::single(Direction::Input, role, width, doc);
    let output = |role, width, doc| Port::single(Direction::Output, role, width, doc);

    let pixel = input(PortRole::Pixel, design.pixel_bits(), "pixel, row by row");
    let pixels = Stream {
        ready: Some(output(PortRole::Ready, 1, "a pixel would be taken at the next edge")),
        start: sync_input(&design),
        status: sync_output(&design).into_iter().collect(),
        ..Stream::into_core(
            StreamRole::Pixels,
            match design.feed() {
                Feed::Parallel => "a pixel of a region of every lane",
                Feed::Raster => "a pixel of the frame",
            },
            input(PortRole::Valid, 1, "a pixel is taken at this edge, if ready_o"),
            vec![fed(design, pixel)],
        )
    };
    let score = |role, width, doc| Port::with(PortRole::ScoreValid, role, width, doc);
    let which = "which: 0 the temporal count, 1.. the features; only with score_valid_o";
    let region = BeatRegion::Number(PortRole::Region);
    let scores = Stream::out_of_core(
        StreamRole::Scores,
        "a score of a region",
        output(PortRole::ScoreValid, 1, "a score of one region"),
        vec![
            score(PortRole::ScoreIndex, design.score_index_bits(), which),
            score(PortRole::Region, design.region_bits(), "its region; only with score_valid_o"),
            score(PortRole::AnyScore, design.any_score_bits(), "it; only with score_valid_o"),
        ],
    );
    let decisions = Stream::out_of_core(
        StreamRole::Decisions,
        "the decision of the region of the score",
        output(PortRole::DecisionValid, 1, "the decision for region_o; comes with its last score"),
        decided_ports(&design, "the region's"),
    );
    let (beat, leaves) = beats(design);
    let forwarded = Stream::out_of_core(
        StreamRole::Forwarded,
        beat,
        fed(design, output(PortRole::ForwardValid, 1, leaves)),
        leaving(design),
    );
    let (scores, decisions) = (Stream { region, ..scores }, Stream { region, ..decisions });
    let region = match (design.feed(), design.fold()) {
        (Feed::Parallel, 1) => BeatRegion::Lane,
        (Feed::Parallel, _) => BeatRegion::Slot(PortRole::ForwardSlot),
        (Feed::Raster, _) => BeatRegion::Number(PortRole::ForwardRegion),
    };
    let forwarded = Stream { region, ..forwarded };
    Interface::new(vec![pixels, scores, decisions, forwarded], threshold_ports(&design))
}

/// Returns the meaning of a beat of the forward stream, and the documentation of its `valid` port.
fn beats(design: SerialDesign<'_>) -> (&'static str, &'static str) {
    let pixel = "a pixel of an active region leaves";
    let either = "a pixel of an active region leaves, or a mean";
    match (design.feed(), design.periphery()) {
        (Feed::Parallel, None) => ("a pixel of the active regions of one slot", pixel),
        (Feed::Raster, None) => ("a pixel of an active region", pixel),
        (Feed::Parallel, Some(_)) => {
            ("a pixel of the active regions of one slot, or a mean of its summaries", either)
        }
        (Feed::Raster, Some(_)) => ("a pixel of an active region, or a mean of a summary", either),
    }
}

/// Returns the ports that carry a pixel that leaves.
fn leaving(design: SerialDesign<'_>) -> Vec<Port> {
    let with = |role, width, doc| Port::with(PortRole::ForwardValid, role, width, doc);
    let position = "its number in its region; only with forward_valid_o";
    let pixel = "that pixel; only with forward_valid_o";
    let mut list = vec![
        fed(design, with(PortRole::ForwardPixel, design.pixel_bits(), pixel)),
        with(PortRole::ForwardPosition, design.position_bits(), position),
    ];
    match design.feed() {
        Feed::Parallel if design.fold() > 1 => {
            let doc = "slot of its region in its lane; only with forward_valid_o";
            list.push(with(PortRole::ForwardSlot, design.slot_bits(), doc));
        }
        Feed::Parallel => {}
        Feed::Raster => {
            let doc = "its region; only with forward_valid_o";
            list.push(with(PortRole::ForwardRegion, design.region_bits(), doc));
        }
    }
    list
}

/// Gives the port one value per lane with parallel feed, and one value in all with raster feed.
fn fed(design: SerialDesign<'_>, mut port: Port) -> Port {
    match design.feed() {
        Feed::Raster => port,
        Feed::Parallel => {
            port.lanes = design.lanes();
            port.per_lane = true;
            port.doc.push_str("; element i is lane i");
            port
        }
    }
}
