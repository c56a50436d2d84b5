// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random streams, and the frames that are read from them.

use std::ops::Range;

use fastrand::Rng;
use foveate_camera::Displacement;
use foveate_design::{Design, DesignConfig};
use foveate_packets::{
    EndPacket, FrameAssembler, PacketLayout, PacketSplitter, ReceivedFrame, RegionDecision,
    RegionFlags, StreamItem, StreamLoss, packet_encoding,
};

pub(crate) fn design(toml: &str) -> Design {
    DesignConfig::from_toml(toml).unwrap().validate().unwrap()
}

/// A stream, and the byte range of each of its frames.
pub(crate) struct TestStream {
    pub(crate) layout: PacketLayout,
    pub(crate) bytes: Vec<u8>,
    pub(crate) frames: Vec<Range<usize>>,
}

/// Makes a stream of `count` frames with random decisions and pixels. Half of all streams have
/// displacements, and half have versions of a map of classes. REGION packets come before or after
/// their ROW.
pub(crate) fn random_stream(rng: &mut Rng, count: u32) -> TestStream {
    let (width, height, size) = (rng.u32(4..40), rng.u32(4..30), rng.u32(2..9));
    let (bits, mean) = (rng.u32(1..=16), rng.bool());
    let irrelevant = if mean { "mean" } else { "zero" };
    let radius = rng.bool().then(|| rng.u32(1..=3));
    let (flow, organization) = match radius {
        Some(radius) => (format!(",{{feature='flow',radius={radius}}}"), "serial"),
        None => (String::new(), "pipelined"),
    };
    let zones = if rng.bool() { "zones={}\n" } else { "" };
    // The lanes of a serial array have regions of at least 4x4 pixels.
    let size = if radius.is_some() { size.max(4) } else { size };
    let design = design(&format!(
        "frame={{width={width},height={height},pixel_bits={bits}}}\nregion.size={size}\ntemporal.min_count=1\n\
         spatial=[{{feature='mad',min_score=0}}{flow}]\nrender.irrelevant='{irrelevant}'\n\
         hardware.organization='{organization}'\n{zones}"
    ));
    let numbers = design.features().len() + 1;
    let layout = PacketLayout::new(&design, rng.bool(), 1_000_000).unwrap();
    let (mut bytes, mut frames) = (Vec::new(), Vec::new());
    for number in 0..count {
        let start = bytes.len();
        let start_of_frame = (u64::from(number) * 40_000, number == 0);
        let map_version = if layout.has_zones() { rng.u16(..) } else { 0 };
        packet_encoding::append_frame_of_map(
            &mut bytes,
            &layout,
            number,
            start_of_frame,
            map_version,
        )
        .unwrap();
        let mut regions_sent = 0;
        for row in 0..layout.rows() {
            let decision = |_| {
                let (srs, trs) = (rng.bool(), rng.bool());
                RegionDecision { srs, trs, summary: mean && !srs && rng.bool() }
            };
            let decisions: Vec<RegionDecision> = (0..layout.columns()).map(decision).collect();
            let early = rng.bool();
            if !early {
                packet_encoding::append_row(&mut bytes, &layout, number, row, &decisions).unwrap();
            }
            for (column, decision) in (0..).zip(&decisions) {
                if decision.summary || (decision.srs && decision.trs) {
                    let summary = decision.summary;
                    let values: Vec<u16> = (0..layout.value_count(summary))
                        .map(|_| rng.u16(..) >> (16 - bits))
                        .collect();
                    let flags = RegionFlags { raw: false, summary };
                    packet_encoding::append_region(
                        &mut bytes,
                        &layout,
                        number,
                        (row, column),
                        (flags, &values),
                    )
                    .unwrap();
                    regions_sent += 1;
                }
            }
            if early {
                packet_encoding::append_row(&mut bytes, &layout, number, row, &decisions).unwrap();
            }
            if layout.info().has_scores {
                let scores = (0..layout.columns())
                    .map(|_| (0..numbers).map(|_| rng.u64(0..3)).collect::<Vec<_>>());
                packet_encoding::append_scores(&mut bytes, &layout, number, row, scores).unwrap();
            }
            if let Some(radius) = radius {
                let all = Displacement::search_order(radius);
                let displacements: Vec<_> =
                    (0..layout.columns()).map(|_| *rng.choice(&all).unwrap()).collect();
                packet_encoding::append_flow(&mut bytes, &layout, number, row, &displacements)
                    .unwrap();
            }
        }
        packet_encoding::append_end(
            &mut bytes,
            number,
            EndPacket { regions_sent, ..EndPacket::default() },
        )
        .unwrap();
        frames.push(start..bytes.len());
    }
    TestStream { layout, bytes, frames }
}

/// Reads all frames of a stream, in pieces of random length, and the losses.
pub(crate) fn read_stream(
    rng: &mut Rng,
    layout: &PacketLayout,
    bytes: &[u8],
) -> (Vec<ReceivedFrame>, Vec<StreamLoss>) {
    let (mut splitter, mut assembler) =
        (PacketSplitter::default(), FrameAssembler::new(layout.clone()));
    let (mut frames, mut rest) = (Vec::new(), bytes);
    loop {
        let (piece, after) = rest.split_at(rng.usize(0..=rest.len().min(700)));
        rest = after;
        splitter.feed(piece);
        if rest.is_empty() {
            splitter.mark_complete();
        }
        loop {
            match splitter.next(Some(layout)) {
                StreamItem::Pending => break,
                StreamItem::Skipped { offset, bytes } => {
                    assembler.add_loss(StreamLoss::Bytes { offset, bytes });
                }
                StreamItem::Packet { frame, packet } => {
                    let ended = assembler.push(frame, packet).unwrap();
                    frames.extend(ended.into_iter().flatten());
                }
            }
        }
        if rest.is_empty() {
            frames.extend(assembler.end_frame());
            return (frames, assembler.take_losses());
        }
    }
}
