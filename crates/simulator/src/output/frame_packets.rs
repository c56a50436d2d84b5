// SPDX-License-Identifier: MIT OR Apache-2.0
//! The packets of a frame, in an order in which a core can send them: of the frame that an engine
//! computed last, or of a frame whose values were kept; and the file `packets.bin` of a run.

use super::PacketContent;
use super::sink::{FrameSink, SinkFrame};
use crate::SimulatorError;
use foveate_camera::RegionAction;
use foveate_design::Design;
use foveate_engine::{Engine, FrameOutcome};
use foveate_packets::{
    EndPacket, PacketError, PacketLayout, RegionDecision, RegionFlags, packet_encoding,
};
use foveate_pixels::ByteFrame;
use foveate_tools::GrowingFile;
use std::path::Path;

/// The clock of the packets: a tick is a microsecond.
const TICKS_PER_SECOND: u32 = 1_000_000;

/// Returns the layout of the packets of a simulation, whose times are microseconds.
///
/// # Errors
/// Fails if a size of the design does not fit into its field.
pub fn packet_layout(
    design: &Design,
    content: PacketContent,
) -> Result<PacketLayout, SimulatorError> {
    let has_scores = match content {
        PacketContent::Plain => false,
        PacketContent::WithScores => true,
    };
    Ok(PacketLayout::new(design, has_scores, TICKS_PER_SECOND)?)
}

/// Returns the number of a frame in its packets. The 32-bit numbers of frames wrap around.
#[must_use]
pub fn wrapped_number(number: u64) -> u32 {
    u32::try_from(number & u64::from(u32::MAX)).unwrap_or_default()
}

/// The values that the regions of a frame send, one region after the other. With them the packets
/// of the frame can be made after the engine has taken another frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SentValues(Vec<u16>);

impl SentValues {
    /// Copies the values of the frame that an engine computed last.
    #[must_use]
    pub fn of_engine(engine: &Engine) -> Self {
        let mut values = Vec::new();
        for region in 0..engine.camera().regions() {
            // The screen shows the raw pixels of an active region if they are what it sends.
            engine.sent_values(engine.rendered(), region, &mut values);
        }
        values.shrink_to_fit();
        Self(values)
    }
}

/// The beginning of a frame, as its FRAME packet has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameStart {
    /// The number of the frame.
    pub number: u32,
    /// The time in ticks.
    pub time: u64,
    /// True if the frame is the first one after a reset.
    pub is_first: bool,
    /// The version of the map of classes, which is 0 in a design without zones.
    pub map_version: u16,
}

/// Returns the number of bytes of the packets of a frame with these actions.
#[must_use]
pub fn packet_bytes(layout: &PacketLayout, actions: &[RegionAction]) -> u64 {
    let scores = if layout.info().has_scores { layout.scores_bytes() } else { 0 };
    let flow = if layout.has_flow() { layout.flow_bytes() } else { 0 };
    let row = (layout.row_bytes() + scores + flow) as u64;
    let regions = actions.iter().filter_map(|&action| is_summary(action));
    let regions: u64 = regions.map(|is_summary| layout.region_bytes(is_summary) as u64).sum();
    let frame = (layout.frame_bytes() + layout.end_bytes()) as u64;
    frame + u64::from(layout.rows()) * row + regions
}

/// Appends the packets of the frame that an engine computed last. `source` has the raw pixels of
/// that frame, and `number` is its number. `time` is its time in ticks. `is_first` is true if it is
/// the first frame after a reset.
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
    let start = FrameStart { number, time, is_first, map_version: 0 };
    write_frame(out, layout, engine.outcome(), start, &mut |region, values| {
        engine.sent_values(source.borrowed_pixels(), region, values);
    })
}

/// Appends the packets of a frame whose outcome and values were kept.
///
/// # Errors
/// Fails if the layout belongs to another design.
pub fn write_kept_packets(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    outcome: &FrameOutcome,
    values: &SentValues,
    start: FrameStart,
) -> Result<(), PacketError> {
    let mut rest = values.0.as_slice();
    write_frame(out, layout, outcome, start, &mut |region, sent| {
        let Some(is_summary) = is_summary(outcome.actions[region as usize]) else { return };
        let (own, others) = rest.split_at(layout.value_count(is_summary).min(rest.len()));
        sent.extend_from_slice(own);
        rest = others;
    })
}

/// Appends the values that a region sends. It is asked in the order of the regions.
type ValuesOfRegion<'a> = dyn FnMut(u32, &mut Vec<u16>) + 'a;

/// Appends the packets of a frame.
fn write_frame(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    outcome: &FrameOutcome,
    start: FrameStart,
    values: &mut ValuesOfRegion<'_>,
) -> Result<(), PacketError> {
    let FrameStart { number, time, is_first, map_version } = start;
    packet_encoding::append_frame_of_map(out, layout, number, (time, is_first), map_version)?;
    let mut regions_sent = 0;
    for row in 0..layout.rows() {
        regions_sent += write_row(out, layout, outcome, (number, row), values)?;
    }
    packet_encoding::append_end(out, number, EndPacket { regions_sent, ..EndPacket::default() })
}

/// Appends the packets of a row of regions of a frame. Returns the number of REGION packets among
/// them.
fn write_row(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    outcome: &FrameOutcome,
    (number, row): (u32, u32),
    values_of: &mut ValuesOfRegion<'_>,
) -> Result<u32, PacketError> {
    let start = row * layout.columns();
    let regions = start..start + layout.columns();
    let places = start as usize..regions.end as usize;
    let decisions: Vec<RegionDecision> =
        regions.clone().map(|region| region_decision(outcome, region as usize)).collect();
    packet_encoding::append_row(out, layout, number, row, &decisions)?;
    if layout.info().has_scores {
        let scores = regions.clone().map(|region| region_scores(outcome, region as usize));
        packet_encoding::append_scores(out, layout, number, row, scores)?;
    }
    if layout.has_flow() {
        let displacements = &outcome.displacements[places];
        packet_encoding::append_flow(out, layout, number, row, displacements)?;
    }
    let (mut sent, mut values) = (0, Vec::new());
    for region in regions {
        let Some(summary) = is_summary(outcome.actions[region as usize]) else { continue };
        values.clear();
        values_of(region, &mut values);
        let flags = RegionFlags { raw: layout.info().raw, summary };
        let place = (row, region - start);
        packet_encoding::append_region(out, layout, number, place, (flags, &values))?;
        sent += 1;
    }
    Ok(sent)
}

/// Returns whether a region sends means, or `None` if it sends nothing.
fn is_summary(action: RegionAction) -> Option<bool> {
    match action {
        RegionAction::Forward => Some(false),
        RegionAction::Summarize => Some(true),
        RegionAction::Hold | RegionAction::Blank => None,
    }
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
        let file = GrowingFile::create(&folder.join("packets.bin"))?;
        Ok(Self { file, layout: packet_layout(design, packets)? })
    }
}

impl FrameSink for PacketFileSink {
    fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        // Only the frames of a recording have no engine, and a recording refuses this output.
        let Some(engine) = sink_frame.engine else { return Ok(()) };
        let number = wrapped_number(sink_frame.number);
        let time = (sink_frame.source.time_us, sink_frame.is_first);
        let source = &sink_frame.source.frame;
        Ok(write_packets(self.file.pending_mut(), &self.layout, engine, source, number, time)?)
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        Ok(self.file.write_pending()?)
    }

    fn finish(mut self: Box<Self>) -> Result<(), SimulatorError> {
        Ok(self.file.write_all()?)
    }
}
