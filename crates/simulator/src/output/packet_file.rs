// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file `packets.bin`: the packets of the camera in the format of `docs/packets.md`.

use std::path::Path;

use foveate_camera::Camera;
use foveate_design::Design;
use foveate_packets::PacketLayout;
use foveate_tools::GrowingFile;

use super::PacketContent;
use super::frame_packets::{packet_layout, wrapped_number, write_packets};
use super::sink::{FrameSink, SinkFrame};
use crate::SimulatorError;

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
