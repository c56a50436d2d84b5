// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of a raster core. Its streams depend on the frame store and on whether pixels
//! leave.

use crate::class_memory::class_streams;
use crate::interface::{BeatRegion, CoreInterface, CoreStream, StreamRole};
use crate::port::{decision_ports, sync_input, sync_output};
use crate::thresholds::threshold_ports;
use crate::{Design, Port, PortDirection, PortRole, RasterDesign};

/// Bits of `lost_count_o`, which stays at its largest value once it has reached it.
const LOST_COUNT_BITS: u32 = 16;

/// Modulus of the number of a frame since reset, a power of two. A receiver can tell frames apart
/// by their numbers if, while it stalls or while nothing changes, fewer frames than this pass.
pub const FRAME_NUMBERS: u32 = 256;

pub(super) fn interface(design: RasterDesign<'_>) -> CoreInterface {
    let word = design.pixels_per_clock() * design.pixel_bits();
    let mut streams = vec![pixel_stream(&design, word)];
    streams.extend(class_streams(&design));
    if design.has_external_store() {
        let kept = design.temporal().reference.bits_per_pixel(design.pixel_bits());
        let word = design.pixels_per_clock() * kept;
        streams.extend([reference_stream(word), store_stream(word)]);
    }
    streams.push(CoreStream {
        region: BeatRegion::Number(PortRole::Region),
        ..CoreStream::out_of_core(
            StreamRole::Decisions,
            "the decision of a region with its scores",
            output(PortRole::DecisionValid, 1, "the decision for region_o"),
            decision_and_score_ports(&design),
        )
    });
    if design.has_forwarding() {
        streams.extend([forward_stream(&design, word), loss_stream(&design)]);
    }
    CoreInterface::new(streams, threshold_ports(&design))
}

fn input(role: PortRole, width: u32, doc: &str) -> Port {
    Port::scalar(PortDirection::Input, role, width, doc)
}

fn output(role: PortRole, width: u32, doc: &str) -> Port {
    Port::scalar(PortDirection::Output, role, width, doc)
}

fn pixel_stream(design: &Design, word: u32) -> CoreStream {
    let doc = "word of pixels, the left one in the lowest bits";
    CoreStream {
        ready: Some(output(PortRole::Ready, 1, "a word would be taken at the next edge")),
        start: sync_input(design),
        status: sync_output(design).into_iter().collect(),
        ..CoreStream::into_core(
            StreamRole::Pixels,
            "a word of a row of the frame",
            input(PortRole::Valid, 1, "a word is taken at this edge, if ready_o"),
            vec![input(PortRole::Pixel, word, doc)],
        )
    }
}

/// Returns the stream of references from an external frame store.
fn reference_stream(word: u32) -> CoreStream {
    let ready = "reference_pixel_i is taken at the next edge";
    let underrun = "a reference has been missing at least once since reset";
    let pixels = "the word of the previous frame, if reference_ready_o";
    CoreStream {
        ready: Some(output(PortRole::ReferenceReady, 1, ready)),
        status: vec![output(PortRole::Underrun, 1, underrun)],
        ..CoreStream::into_core(
            StreamRole::References,
            "the word with which the next word is compared",
            input(PortRole::ReferenceValid, 1, "reference_pixel_i has a reference"),
            vec![input(PortRole::ReferencePixel, word, pixels)],
        )
    }
}

/// Returns the stream of words to an external frame store.
fn store_stream(word: u32) -> CoreStream {
    let with = |role, width, doc| Port::qualified_output(PortRole::StoreValid, role, width, doc);
    CoreStream {
        last: Some(PortRole::StoreLast),
        ..CoreStream::out_of_core(
            StreamRole::StoredWords,
            "a word that the store gives back in the next frame",
            output(PortRole::StoreValid, 1, "a word is to be stored"),
            vec![
                with(PortRole::StorePixel, word, "the word to store; only with store_valid_o"),
                with(PortRole::StoreLast, 1, "the last word of a row; only with store_valid_o"),
            ],
        )
    }
}

fn decision_and_score_ports(design: &Design) -> Vec<Port> {
    let with = |role, width, doc| Port::qualified_output(PortRole::DecisionValid, role, width, doc);
    let doc = "the region that is decided; only with decision_valid_o";
    let mut list = vec![with(PortRole::Region, design.region_bits(), doc)];
    list.extend(decision_ports(design, "its"));
    for feature in design.features() {
        let doc = "score; only with decision_valid_o";
        list.push(with(PortRole::Score(feature.kind()), feature.score_bits(), doc));
    }
    let doc = "changed pixels; only with decision_valid_o";
    list.push(with(PortRole::TemporalCount, design.count_bits(), doc));
    list
}

fn forward_stream(design: &Design, word: u32) -> CoreStream {
    let with = |role, width, doc| Port::qualified_output(PortRole::ForwardValid, role, width, doc);
    let (regions, frames) = (design.region_bits(), FRAME_NUMBERS.ilog2());
    let ready = "the sink takes the word on the forward ports";
    let region = "region of the word; only with forward_valid_o";
    let position = "number of its first pixel in the region; only with forward_valid_o";
    let pixels = "the word, its left pixel in the lowest bits; only with forward_valid_o";
    let first = "the first word of its region; only with forward_valid_o";
    let last = "the last word of its region that leaves; only with forward_valid_o";
    let abort = "its region was lost in the middle: no more comes; only with forward_valid_o";
    let frame = "number of the word's frame since reset, modulo 256; only with forward_valid_o";
    let count = "regions lost since reset, at most 65,535";
    let mut payload = vec![
        with(PortRole::ForwardRegion, regions, region),
        with(PortRole::ForwardPosition, design.position_bits(), position),
        with(PortRole::ForwardPixel, word, pixels),
        with(PortRole::ForwardFirst, 1, first),
        with(PortRole::ForwardLast, 1, last),
        with(PortRole::ForwardAbort, 1, abort),
        with(PortRole::ForwardFrame, frames, frame),
    ];
    let (beat, leaves) = match design.periphery() {
        None => ("a word of an active region", "a word of an active region leaves"),
        Some(_) => {
            let doc = "the word is the mean of a block; only with forward_valid_o";
            payload.push(with(PortRole::ForwardSummary, 1, doc));
            (
                "a word of an active region, or a mean of one that sends its summary",
                "a word of a region leaves",
            )
        }
    };
    CoreStream {
        ready: Some(input(PortRole::ForwardReady, 1, ready)),
        region: BeatRegion::Number(PortRole::ForwardRegion),
        last: Some(PortRole::ForwardLast),
        status: vec![
            output(PortRole::Lost, 1, "a region has been lost since reset"),
            output(PortRole::LostCount, LOST_COUNT_BITS, count),
        ],
        ..CoreStream::out_of_core(
            StreamRole::ForwardedPixels,
            beat,
            output(PortRole::ForwardValid, 1, leaves),
            payload,
        )
    }
}

fn loss_stream(design: &Design) -> CoreStream {
    let with = |role, width, doc| Port::qualified_output(PortRole::LostValid, role, width, doc);
    let frame = "number of the region's frame since reset, modulo 256; only with lost_valid_o";
    let region = "the region that was lost; only with lost_valid_o";
    CoreStream {
        region: BeatRegion::Number(PortRole::LostRegion),
        ..CoreStream::out_of_core(
            StreamRole::LostRegions,
            "a region that was lost",
            output(PortRole::LostValid, 1, "a region was lost at the previous edge"),
            vec![
                with(PortRole::LostRegion, design.region_bits(), region),
                with(PortRole::LostFrame, FRAME_NUMBERS.ilog2(), frame),
            ],
        )
    }
}
