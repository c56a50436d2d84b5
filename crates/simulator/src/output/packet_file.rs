// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file `packets.bin`: the packets of the camera in the format of `docs/packets.md`, in an
//! order in which a core can send them.

use std::path::Path;

use foveate_camera::{Camera, RegionAction};
use foveate_design::Design;
use foveate_engine::{Engine, FrameOutcome};
use foveate_frame::ByteFrame;
use foveate_packets::{
    EndPacket, PacketError, PacketLayout, RegionDecision, RegionFlags, packet_writer,
};
use foveate_staging::GrowingFile;

use super::PacketContent;
use super::sink::{FrameSink, SinkFrame};
use crate::SimulatorError;

/// The clock of the packets: a tick is a microsecond.
const TICKS_PER_SECOND: u32 = 1_000_000;

/// The open file.
pub(super) struct PacketFileSink {
    file: GrowingFile,
    layout: PacketLayout,
}

impl PacketFileSink {
    pub(super) fn create(
        folder: &Path,
        design: &Design,
        packets: PacketContent,
    ) -> Result<Self, SimulatorError> {
        let has_scores = packets == PacketContent::WithScores;
        Ok(Self {
            file: GrowingFile::create(&folder.join("packets.bin"))?,
            layout: PacketLayout::new(design, has_scores, TICKS_PER_SECOND)?,
        })
    }
}

/// Appends the packets of the frame that an engine computed last, in an order in which a core can
/// send them. `source` has the raw pixels of that frame, and `number` is its number. `time` is its
/// time in ticks. `is_first` is true if it is the first frame after a reset.
///
/// # Errors
/// Fails if the layout belongs to another design.
pub fn write_packets(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    engine: &Engine,
    source: &ByteFrame,
    number: u32,
    (time, is_first): (u64, bool),
) -> Result<(), PacketError> {
    packet_writer::append_frame(out, layout, number, (time, is_first));
    let mut regions_sent = 0;
    for row in 0..engine.camera().rows() {
        regions_sent += write_row(out, layout, engine, source, (number, row))?;
    }
    packet_writer::append_end(out, number, EndPacket { regions_sent, ..EndPacket::default() })
}

/// Appends the packets of a row of regions of a frame. Returns the number of REGION packets among
/// them.
fn write_row(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    engine: &Engine,
    source: &ByteFrame,
    (number, row): (u32, u32),
) -> Result<u32, PacketError> {
    let (camera, outcome) = (engine.camera(), engine.outcome());
    let start = row * camera.columns();
    let regions = start..start + camera.columns();
    let places = start as usize..regions.end as usize;
    let decisions: Vec<RegionDecision> =
        regions.clone().map(|region| region_decision(outcome, region as usize)).collect();
    packet_writer::append_row(out, layout, number, row, &decisions)?;
    if layout.info().has_scores {
        let scores = regions.clone().map(|region| region_scores(outcome, region as usize));
        packet_writer::append_scores(out, layout, number, row, scores)?;
    }
    if layout.has_flow() {
        let displacements = &outcome.displacements[places];
        packet_writer::append_flow(out, layout, number, row, displacements)?;
    }
    let (mut sent, mut values) = (0, Vec::new());
    for region in regions {
        let is_summary = match outcome.actions[region as usize] {
            RegionAction::Forward => false,
            RegionAction::Summarize => true,
            RegionAction::Hold | RegionAction::Blank => continue,
        };
        values.clear();
        engine.sent_values(source.borrowed_pixels(), region, &mut values);
        let flags = RegionFlags { raw: layout.info().raw, summary: is_summary };
        let place = (row, region - start);
        packet_writer::append_region(out, layout, number, place, (flags, &values))?;
        sent += 1;
    }
    Ok(sent)
}

/// Returns the decision of a region, as a ROW packet holds it.
fn region_decision(outcome: &FrameOutcome, region: usize) -> RegionDecision {
    RegionDecision {
        srs: outcome.srs[region],
        trs: outcome.trs[region],
        summary: outcome.actions[region] == RegionAction::Summarize,
    }
}

/// Returns the temporal count and the scores of a region.
fn region_scores(outcome: &FrameOutcome, region: usize) -> impl Iterator<Item = u64> {
    let scores = outcome.scores.iter().map(move |scores| scores[region]);
    std::iter::once(outcome.temporal_count[region].into()).chain(scores)
}

impl FrameSink for PacketFileSink {
    fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        // Only the frames of a recording have no engine, and a recording refuses this output.
        let Some(engine) = sink_frame.engine else { return Ok(()) };
        // The 32-bit numbers of frames wrap around.
        let number = u32::try_from(sink_frame.number & u64::from(u32::MAX)).unwrap_or_default();
        let time = (sink_frame.source.time_us, sink_frame.is_first);
        let source = &sink_frame.source.frame;
        Ok(write_packets(self.file.pending_mut(), &self.layout, engine, source, number, time)?)
    }

    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        Ok(self.file.write_pending(all)?)
    }

    fn max_bytes_owed(&self, camera: &Camera) -> u64 {
        // These are the ROW, SCORES, FLOW and REGION packets of a frame whose regions all send pixels.
        // The buffers have room for its FRAME and END.
        let flow = if self.layout.has_flow() { self.layout.flow_bytes() } else { 0 };
        let rows = self.layout.row_bytes() + self.layout.scores_bytes() + flow;
        let regions = u64::from(camera.regions()) * self.layout.region_bytes(false) as u64;
        regions + u64::from(camera.rows()) * rows as u64
    }

    fn finish(mut self: Box<Self>) -> Result<(), SimulatorError> {
        Ok(self.file.write_pending(true)?)
    }
}
