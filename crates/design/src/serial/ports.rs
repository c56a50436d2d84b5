// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of a serial array.

use crate::class_memory::class_streams;
use crate::interface::{BeatRegion, CoreInterface, CoreStream, StreamRole};
use crate::port::{decision_ports, sync_input, sync_output};
use crate::thresholds::threshold_ports;
use crate::{PixelFeed, Port, PortDirection, PortRole, SerialDesign};

/// Returns the interface of the array.
pub(crate) fn interface(design: SerialDesign<'_>) -> CoreInterface {
    let input = |role, width, doc| Port::scalar(PortDirection::Input, role, width, doc);
    let output = |role, width, doc| Port::scalar(PortDirection::Output, role, width, doc);

    let pixel = input(PortRole::Pixel, design.pixel_bits(), "pixel, row by row");
    let pixels = CoreStream {
        ready: Some(output(PortRole::Ready, 1, "a pixel would be taken at the next edge")),
        start: sync_input(&design),
        status: sync_output(&design).into_iter().collect(),
        ..CoreStream::into_core(
            StreamRole::Pixels,
            match design.feed() {
                PixelFeed::Parallel => "a pixel of a region of every lane",
                PixelFeed::Raster => "a pixel of the frame",
            },
            input(PortRole::Valid, 1, "a pixel is taken at this edge, if ready_o"),
            vec![with_feed_lanes(design, pixel)],
        )
    };
    let score = |role, width, doc| Port::qualified_output(PortRole::ScoreValid, role, width, doc);
    let which =
        "number of the score: 0 the temporal count, 1.. the features; only with score_valid_o";
    let displacement = design.flow_search().map(|search| {
        let coordinate = |role, doc| score(role, search.coordinate_bits(), doc);
        [
            coordinate(PortRole::DisplacementX, "dx of the region with the score of flow, else 0"),
            coordinate(PortRole::DisplacementY, "dy of the region with the score of flow, else 0"),
        ]
    });
    let region = BeatRegion::Number(PortRole::Region);
    let scores = CoreStream::out_of_core(
        StreamRole::Scores,
        "a score of a region",
        output(PortRole::ScoreValid, 1, "a score of one region"),
        vec![
            score(PortRole::ScoreIndex, design.score_index_bits(), which),
            score(
                PortRole::Region,
                design.region_bits(),
                "region of the score; only with score_valid_o",
            ),
            score(
                PortRole::AnyScore,
                design.max_score_bits(),
                "the score; only with score_valid_o",
            ),
        ]
        .into_iter()
        .chain(displacement.into_iter().flatten())
        .collect(),
    );
    let decisions = CoreStream::out_of_core(
        StreamRole::Decisions,
        "the decision of the region of the score",
        output(PortRole::DecisionValid, 1, "the decision for region_o; comes with its last score"),
        decision_ports(&design, "the region's"),
    );
    let (beat, leaves) = forward_beat_docs(design);
    let forwarded = CoreStream::out_of_core(
        StreamRole::ForwardedPixels,
        beat,
        with_feed_lanes(design, output(PortRole::ForwardValid, 1, leaves)),
        forward_ports(design),
    );
    let (scores, decisions) = (CoreStream { region, ..scores }, CoreStream { region, ..decisions });
    let region = match (design.feed(), design.fold()) {
        (PixelFeed::Parallel, 1) => BeatRegion::Lane,
        (PixelFeed::Parallel, _) => BeatRegion::Slot(PortRole::ForwardSlot),
        (PixelFeed::Raster, _) => BeatRegion::Number(PortRole::ForwardRegion),
    };
    let forwarded = CoreStream { region, ..forwarded };
    let mut streams = vec![pixels];
    streams.extend(class_streams(&design));
    streams.extend([scores, decisions, forwarded]);
    CoreInterface::new(streams, threshold_ports(&design))
}

/// Returns the meaning of a beat of the forward stream, and the documentation of its `valid` port.
fn forward_beat_docs(design: SerialDesign<'_>) -> (&'static str, &'static str) {
    let pixel = "a pixel of an active region leaves";
    let either = "a pixel of an active region leaves, or a mean";
    match (design.feed(), design.periphery()) {
        (PixelFeed::Parallel, None) => ("a pixel of the active regions of one slot", pixel),
        (PixelFeed::Raster, None) => ("a pixel of an active region", pixel),
        (PixelFeed::Parallel, Some(_)) => {
            ("a pixel of the active regions of one slot, or a mean of its summaries", either)
        }
        (PixelFeed::Raster, Some(_)) => {
            ("a pixel of an active region, or a mean of a summary", either)
        }
    }
}

/// Returns the ports that carry a pixel that leaves.
fn forward_ports(design: SerialDesign<'_>) -> Vec<Port> {
    let with = |role, width, doc| Port::qualified_output(PortRole::ForwardValid, role, width, doc);
    let position = "number of the pixel in its region; only with forward_valid_o";
    let pixel = "the pixel; only with forward_valid_o";
    let mut list = vec![
        with_feed_lanes(design, with(PortRole::ForwardPixel, design.pixel_bits(), pixel)),
        with(PortRole::ForwardPosition, design.position_bits(), position),
    ];
    match design.feed() {
        PixelFeed::Parallel if design.fold() > 1 => {
            let doc = "slot of the pixel's region in its lane; only with forward_valid_o";
            list.push(with(PortRole::ForwardSlot, design.slot_bits(), doc));
        }
        PixelFeed::Parallel => {}
        PixelFeed::Raster => {
            let doc = "region of the pixel; only with forward_valid_o";
            list.push(with(PortRole::ForwardRegion, design.region_bits(), doc));
        }
    }
    list
}

/// Gives the port one value per lane with parallel feed, and one value in all with raster feed.
fn with_feed_lanes(design: SerialDesign<'_>, mut port: Port) -> Port {
    match design.feed() {
        PixelFeed::Raster => port,
        PixelFeed::Parallel => {
            port.lanes = design.lanes();
            port.per_lane = true;
            port.doc.push_str("; element i is lane i");
            port
        }
    }
}
