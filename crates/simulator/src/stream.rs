// SPDX-License-Identifier: MIT OR Apache-2.0
//! A stream of packets, decoded step by step: frames as the receiver's screen shows them, losses,
//! and answers of a board. It writes nothing and does not wait, so it serves for recordings and for
//! live streams.

use std::collections::VecDeque;

use foveate_design::{Design, DesignConfig};
use foveate_engine::{FrameOutcome, Receiver};
use foveate_packets::{
    FrameAssembler, FrameClock, FrameInfo, Packet, PacketError, PacketLayout, PacketSplitter,
    ReceivedFrame, RegionContent, RegisterPacket, StreamLoss,
};
use foveate_pixels::{ByteFrame, FramePixels};

use crate::SimulatorError;

/// The largest number of pixels of a frame whose size is known only from the stream: slightly more
/// than 8K video. The sender of a stream must not decide how much memory is used.
pub const MAX_CLAIMED_PIXELS: u32 = 1 << 25;

/// The next item of a stream.
#[derive(Clone, Debug)]
pub enum StreamItem {
    /// A frame has ended, and is on the screen.
    Frame(Box<ShownFrame>),
    /// Data is missing.
    Loss(StreamLoss),
    /// A board has answered.
    Register(RegisterPacket),
}

/// A frame that is on the screen.
#[derive(Clone, Debug)]
pub struct ShownFrame {
    /// The number of the frame in the stream.
    pub number: u32,
    /// The time when the frame began, in microseconds since the first frame, or `None` if its FRAME
    /// packet is missing. Times never decrease.
    pub time_us: Option<u64>,
    /// The version of the map of classes that the frame used, modulo 65,536. It is `None` in a
    /// design without zones, or if the FRAME packet is missing.
    pub map_version: Option<u16>,
    /// The screen after the frame.
    pub screen: ByteFrame,
    /// The decisions and actions of all regions. Unknown values are 0.
    pub outcome: FrameOutcome,
}

/// A stream and the state of its decoding.
#[derive(Debug)]
pub struct PacketStream {
    config: DesignConfig,
    splitter: PacketSplitter,
    decoder: Option<StreamDecoder>,
    items: VecDeque<StreamItem>,
    /// The last FRAME packet did not belong to this camera.
    is_refused: bool,
    is_complete: bool,
}

impl PacketStream {
    /// Makes a stream of a camera with this configuration, which may leave the frame size open.
    #[must_use]
    pub fn new(config: &DesignConfig) -> Self {
        Self {
            config: config.clone(),
            splitter: PacketSplitter::default(),
            decoder: None,
            items: VecDeque::new(),
            is_refused: false,
            is_complete: false,
        }
    }

    /// Takes the next bytes.
    pub fn feed(&mut self, bytes: &[u8]) {
        self.splitter.feed(bytes);
    }

    /// Marks the end of the bytes.
    pub fn complete(&mut self) {
        self.splitter.mark_complete();
        self.is_complete = true;
    }

    /// Returns the number of bytes that have been processed.
    #[must_use]
    pub fn position(&self) -> u64 {
        self.splitter.consumed_bytes()
    }

    /// Returns the design, once a FRAME packet has given the frame size.
    #[must_use]
    pub fn design(&self) -> Option<&Design> {
        self.decoder.as_ref().map(|run| &run.design)
    }

    /// Returns true if the stream has scores, and false before the first FRAME packet.
    #[must_use]
    pub fn has_scores(&self) -> bool {
        self.decoder.as_ref().is_some_and(|run| run.assembler.layout().info().has_scores)
    }

    /// Returns the next item as [`PacketStream::receive`] does. A FRAME packet of another camera
    /// among frames of this one is a loss.
    ///
    /// # Errors
    /// Fails if a FRAME packet does not belong to this camera, and no other did before.
    pub fn receive_past_foreign(&mut self) -> Result<Option<StreamItem>, SimulatorError> {
        match self.receive() {
            Err(SimulatorError::Packets(error)) if self.design().is_some() => {
                let frame = error.frame().unwrap_or_default();
                Ok(Some(StreamItem::Loss(StreamLoss::Foreign { frame })))
            }
            received => received,
        }
    }

    /// Returns the next item, or `None` if more bytes are needed.
    ///
    /// # Errors
    /// Fails if a FRAME packet does not belong to this camera. The next call continues with the
    /// next FRAME packet that does. Damage is not an error.
    pub fn receive(&mut self) -> Result<Option<StreamItem>, SimulatorError> {
        loop {
            if let Some(found) = self.items.pop_front() {
                return Ok(Some(found));
            }
            match self.splitter.next(self.decoder.as_ref().map(|run| run.assembler.layout())) {
                foveate_packets::StreamItem::Pending => {
                    match self.decoder.as_mut().filter(|_| self.is_complete) {
                        Some(run) => match run.assembler.end_frame() {
                            Some(last) => run.add_frames([Some(last)], &mut self.items)?,
                            None => return Ok(None),
                        },
                        None => return Ok(None),
                    }
                }
                // The lengths of another camera's packets are not known, so skipped bytes are not a
                // loss.
                foveate_packets::StreamItem::Skipped { .. } if self.is_refused => {}
                foveate_packets::StreamItem::Skipped { offset, bytes } => {
                    return Ok(Some(StreamItem::Loss(StreamLoss::Bytes { offset, bytes })));
                }
                foveate_packets::StreamItem::Packet {
                    packet: Packet::Register(register), ..
                } => {
                    return Ok(Some(StreamItem::Register(register)));
                }
                foveate_packets::StreamItem::Packet { frame, packet } => {
                    let is_frame = matches!(packet, Packet::Frame(_));
                    if self.is_refused && !is_frame {
                        continue;
                    }
                    self.is_refused = is_frame;
                    if let (None, Packet::Frame(info)) = (&self.decoder, &packet) {
                        self.decoder = Some(StreamDecoder::start(&self.config, frame, info)?);
                    }
                    if let Some(run) = &mut self.decoder {
                        let ended = run.assembler.push(frame, packet)?;
                        self.is_refused = false;
                        run.add_frames(ended, &mut self.items)?;
                    }
                }
            }
        }
    }
}

/// The state from packets to the screen.
#[derive(Debug)]
struct StreamDecoder {
    design: Design,
    assembler: FrameAssembler,
    receiver: Receiver,
    clock: FrameClock,
}

impl StreamDecoder {
    /// Starts the decoding of a stream with this first FRAME packet.
    fn start(config: &DesignConfig, frame: u32, info: &FrameInfo) -> Result<Self, SimulatorError> {
        if info.version != foveate_packets::VERSION {
            return Err(PacketError::UnsupportedVersion { frame, version: info.version }.into());
        }
        check_claimed_size(config, frame, info)?;
        let design = config.validate_for_frames(info.width.into(), info.height.into())?;
        let layout = PacketLayout::new(&design, info.has_scores, info.ticks_per_second)?;
        let assembler = FrameAssembler::new(layout);
        assembler.check(frame, info)?;
        Ok(Self {
            receiver: Receiver::new(&design),
            assembler,
            design,
            clock: FrameClock::default(),
        })
    }

    /// Adds the losses so far, and then the frames that have ended.
    fn add_frames(
        &mut self,
        ended: impl IntoIterator<Item = Option<ReceivedFrame>>,
        found: &mut VecDeque<StreamItem>,
    ) -> Result<(), SimulatorError> {
        found.extend(self.assembler.take_losses().into_iter().map(StreamItem::Loss));
        for frame in ended.into_iter().flatten() {
            let number = frame.number;
            let time = frame.info.as_ref().map(|info| self.clock.next_time(info));
            if time.is_some_and(|time| time.is_impossible) {
                found.push_back(StreamItem::Loss(StreamLoss::Time { frame: number }));
            }
            let shown = self.show_frame(frame, time.map(|time| time.time_us))?;
            found.push_back(StreamItem::Frame(Box::new(shown)));
        }
        Ok(())
    }

    /// Shows a frame on the screen.
    fn show_frame(
        &mut self,
        frame: ReceivedFrame,
        time_us: Option<u64>,
    ) -> Result<ShownFrame, SimulatorError> {
        if frame.info.as_ref().is_some_and(|info| info.first) {
            self.receiver.reset();
        }
        let info = frame.info.as_ref().filter(|_| self.assembler.layout().has_zones());
        let map_version = info.map(|info| info.map_version);
        for (region, content) in (0..).zip(&frame.contents) {
            match content {
                Some(RegionContent::Pixels(pixels)) => self.receiver.take_pixels(region, pixels),
                Some(RegionContent::Means(means)) => self.receiver.take_means(region, means),
                None => {}
            }
        }
        let actions = frame.actions(self.design.irrelevant());
        self.receiver.show(&actions);
        let of = |bit: fn(&foveate_packets::RegionDecision) -> bool| {
            frame.decisions.iter().map(bit).collect::<Vec<_>>()
        };
        let outcome = FrameOutcome {
            srs: of(|decision| decision.srs),
            trs: of(|decision| decision.trs),
            active: of(|decision| decision.srs && decision.trs),
            actions,
            temporal_count: frame.temporal_count,
            scores: frame.scores,
            displacements: frame.displacements,
            skipped: 0,
        };
        let screen = copy_of_screen(&self.design, self.receiver.rendered())?;
        Ok(ShownFrame { number: frame.number, time_us, map_version, screen, outcome })
    }
}

/// Refuses a stream that alone claims larger frames than permitted.
fn check_claimed_size(
    config: &DesignConfig,
    frame: u32,
    info: &FrameInfo,
) -> Result<(), SimulatorError> {
    let (width, height) = (u32::from(info.width), u32::from(info.height));
    let own = &config.camera.frame;
    let is_given = own.width.is_some() && own.height.is_some();
    if is_given || width.saturating_mul(height) <= MAX_CLAIMED_PIXELS {
        return Ok(());
    }
    Err(SimulatorError::ClaimedSize { frame, width, height, most: MAX_CLAIMED_PIXELS })
}

fn copy_of_screen(design: &Design, screen: FramePixels<'_>) -> Result<ByteFrame, SimulatorError> {
    let (width, height, bits) = (design.width(), design.height(), design.pixel_bits());
    Ok(match screen {
        FramePixels::Bytes(pixels) => ByteFrame::from_bytes(width, height, bits, pixels.to_vec())?,
        FramePixels::Words(pixels) => ByteFrame::from_words(width, height, bits, pixels.to_vec())?,
    })
}
