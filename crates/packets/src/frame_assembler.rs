// SPDX-License-Identifier: MIT OR Apache-2.0
//! Assembles frames from packets. A frame ends with its END, or with the first packet of a later
//! frame.
//!
//! A packet of a frame that has ended is late, and is ignored. If two late FRAMEs in a row have
//! consecutive numbers, the sender has restarted its count, and the second one begins a frame.
//! Without this rule, a single FRAME with a wrong, high number would make all later frames late.

use crate::{FrameInfo, Packet, PacketError, PacketLayout, ReceivedFrame, StreamLoss};

/// Assembles frames from packets, and lists the losses.
#[derive(Debug)]
pub struct FrameAssembler {
    layout: PacketLayout,
    open: Option<ReceivedFrame>,
    /// The number of the frame that began last.
    last: Option<u32>,
    late: Option<u32>,
    losses: Vec<StreamLoss>,
}

impl FrameAssembler {
    /// Makes an assembler that has received nothing.
    #[must_use]
    pub fn new(layout: PacketLayout) -> Self {
        Self { layout, open: None, last: None, late: None, losses: Vec::new() }
    }

    /// Returns the layout of the packets that are expected.
    #[must_use]
    pub fn layout(&self) -> &PacketLayout {
        &self.layout
    }

    /// Takes a packet of frame `number`. Returns the frames that are complete now: the frame
    /// before, if this packet ended it, and the frame of this packet, if the packet is its END. A
    /// REGISTER belongs to no frame and changes nothing.
    ///
    /// # Errors
    /// Fails if a FRAME has another version of the format or belongs to another design.
    pub fn push(
        &mut self,
        number: u32,
        packet: Packet,
    ) -> Result<[Option<ReceivedFrame>; 2], PacketError> {
        let info = match &packet {
            Packet::Register(_) => return Ok([None, None]),
            Packet::Frame(info) => {
                self.check(number, info)?;
                Some(info.clone())
            }
            _ => None,
        };
        let is_open = self.open.as_ref().is_some_and(|open| open.number == number);
        let is_first = info.as_ref().is_some_and(|info| info.first);
        // The comparison is modulo 2^32, because frame numbers wrap around.
        let is_late =
            self.last.is_some_and(|last| number.wrapping_sub(last).wrapping_sub(1) >= 1 << 31);
        let is_recount = info.is_some()
            && is_late
            && !is_open
            && self.late.is_some_and(|late| number == late.wrapping_add(1));
        if info.is_some() {
            self.late = Some(number).filter(|_| is_late && !is_open && !is_first && !is_recount);
        }
        let is_restart = is_first || is_recount;
        // A frame begins with its FRAME; packets that came before it do not belong to it.
        let is_begun = self.open.as_ref().is_some_and(|open| open.info.is_some());
        if is_open && !is_begun && info.is_some() && !is_first {
            self.losses.push(StreamLoss::Misplaced { frame: number, count: 1 });
            self.open = Some(ReceivedFrame::new(number, info, &self.layout));
            return Ok([None, None]);
        }
        if !is_restart && ((is_late && !is_open) || (is_open && info.is_some())) {
            self.losses.push(StreamLoss::Misplaced { frame: number, count: 1 });
            return Ok([None, None]);
        }
        if is_recount {
            self.last = None;
        }
        let mut ended = None;
        if !is_open || is_restart {
            ended = self.end_frame();
            self.begin(number, info);
        }
        let columns = self.layout.columns();
        let mut is_last = false;
        if let Some(open) = &mut self.open {
            match packet {
                Packet::Frame(_) | Packet::Register(_) => {}
                Packet::Row(row) => open.take_row(row),
                Packet::Scores(scores) => open.take_scores(scores),
                Packet::Flow(flow) => open.take_flow(flow),
                Packet::Region(region) => open.take_region(region, columns),
                Packet::End(end) => {
                    open.take_end(end);
                    is_last = true;
                }
            }
        }
        let last = if is_last { self.end_frame() } else { None };
        Ok([ended, last])
    }

    /// Ends the frame that is open, as at the end of the stream.
    pub fn end_frame(&mut self) -> Option<ReceivedFrame> {
        let mut open = self.open.take()?;
        self.losses.extend(open.compare_with_decisions(&self.layout));
        Some(open)
    }

    /// Records a loss that was found elsewhere.
    pub fn add_loss(&mut self, loss: StreamLoss) {
        self.losses.push(loss);
    }

    /// Returns the losses since the last call.
    pub fn take_losses(&mut self) -> Vec<StreamLoss> {
        std::mem::take(&mut self.losses)
    }

    fn begin(&mut self, number: u32, info: Option<FrameInfo>) {
        let restarts = info.as_ref().is_some_and(|info| info.first);
        match self.last {
            None if !restarts => self.losses.push(StreamLoss::Start { frame: number }),
            Some(last) if !restarts && number != last.wrapping_add(1) => {
                let frame = last.wrapping_add(1);
                self.losses.push(StreamLoss::Frames { frame, count: number.wrapping_sub(frame) });
            }
            _ => {}
        }
        self.last = Some(number);
        self.open = Some(ReceivedFrame::new(number, info, &self.layout));
    }

    /// Checks that a FRAME belongs to this design and format.
    ///
    /// # Errors
    /// Fails if the version, the fingerprint or another field differs.
    pub fn check(&self, frame: u32, info: &FrameInfo) -> Result<(), PacketError> {
        let expected = self.layout.info();
        if info.version != expected.version {
            return Err(PacketError::UnsupportedVersion { frame, version: info.version });
        }
        let stream = info.fingerprint;
        if stream != expected.fingerprint {
            let (given, width, height) = (expected.fingerprint, info.width, info.height);
            return Err(PacketError::DesignMismatch { frame, stream, given, width, height });
        }
        let pairs = [
            ("frame size", (info.width, info.height) == (expected.width, expected.height)),
            (
                "grid of regions",
                (info.columns, info.rows, info.side)
                    == (expected.columns, expected.rows, expected.side),
            ),
            ("bits of a pixel", info.pixel_bits == expected.pixel_bits),
            ("summaries", (info.blocks, info.irrelevant) == (expected.blocks, expected.irrelevant)),
            ("payload", info.raw == expected.raw),
            ("presence of scores", info.has_scores == expected.has_scores),
            ("unit of time", info.ticks_per_second == expected.ticks_per_second),
            ("version of the map", self.layout.has_possible_map(info)),
        ];
        match pairs.into_iter().find(|(_, same)| !same) {
            None => Ok(()),
            Some((what, _)) => Err(PacketError::FieldMismatch { frame, stream, what }),
        }
    }
}
