// SPDX-License-Identifier: MIT OR Apache-2.0
//! A stream of packets, decoded step by step: frames as the receiver's screen shows them, losses,
//! and answers of a board. It writes nothing and does not wait, so it serves for recordings and for
//! live streams.

use std::collections::VecDeque;

use foveate_design::{Config, Design};
use foveate_engine::{FrameOutcome, Receiver};
use foveate_frame::{Plane, Raster};
use foveate_packets::{
    Assembler, Content, Found, FrameClock, FrameInfo, Layout, Loss, Packet, PacketError,
    ReceivedFrame, Register, Splitter,
};

use crate::SimulatorError;

/// The largest number of pixels of a frame whose size is known only from the stream: slightly more
/// than 8K video. The sender of a stream must not decide how much memory is used.
pub const CLAIMED_PIXELS: u32 = 1 << 25;

/// The next item of a stream.
#[derive(Clone, Debug)]
pub enum Received {
    /// A frame has ended, and is on the screen.
    Frame(Box<ShownFrame>),
    /// Data is missing.
    Loss(Loss),
    /// A board has answered.
    Register(Register),
}

/// A frame that is on the screen.
#[derive(Clone, Debug)]
pub struct ShownFrame {
    /// The number of the frame in the stream.
    pub number: u32,
    /// The time when the frame began, in microseconds since the first frame, or `None` if its FRAME
    /// packet is missing. Times never decrease.
    pub time_us: Option<u64>,
    /// The screen after the frame.
    pub screen: Raster,
    /// The decisions and actions of all regions. Unknown values are 0.
    pub outcome: FrameOutcome,
}

/// A stream and the state of its decoding.
#[derive(Debug)]
pub struct Stream {
    config: Config,
    splitter: Splitter,
    run: Option<Run>,
    found: VecDeque<Received>,
    /// The last FRAME packet did not belong to this camera.
    is_refused: bool,
    is_complete: bool,
}

impl Stream {
    /// Makes a stream of a camera with this configuration, which may leave the frame size open.
    #[must_use]
    pub fn new(config: &Config) -> Self {
        Self {
            config: config.clone(),
            splitter: Splitter::default(),
            run: None,
            found: VecDeque::new(),
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
        self.splitter.complete();
        self.is_complete = true;
    }

    /// Returns the number of bytes that have been processed.
    #[must_use]
    pub fn position(&self) -> u64 {
        self.splitter.position()
    }

    /// Returns the design, once a FRAME packet has given the frame size.
    #[must_use]
    pub fn design(&self) -> Option<&Design> {
        self.run.as_ref().map(|run| &run.design)
    }

    /// Returns true if the stream has scores, and false before the first FRAME packet.
    #[must_use]
    pub fn has_scores(&self) -> bool {
        self.run.as_ref().is_some_and(|run| run.assembler.layout().info().has_scores)
    }

    /// Returns the next item, or `None` if more bytes are needed.
    ///
    /// # Errors
    /// Fails if a FRAME packet does not belong to this camera. The next call continues with the
    /// next FRAME packet that does. Damage is not an error.
    pub fn receive(&mut self) -> Result<Option<Received>, SimulatorError> {
        loop {
            if let Some(found) = self.found.pop_front() {
                return Ok(Some(found));
            }
            match self.splitter.next(self.run.as_ref().map(|run| run.assembler.layout())) {
                Found::Nothing => match self.run.as_mut().filter(|_| self.is_complete) {
                    Some(run) => match run.assembler.end() {
                        Some(last) => run.show([Some(last)], &mut self.found)?,
                        None => return Ok(None),
                    },
                    None => return Ok(None),
                },
                // The lengths of another camera's packets are not known, so skipped bytes are not a
                // loss.
                Found::Skipped { .. } if self.is_refused => {}
                Found::Skipped { offset, bytes } => {
                    return Ok(Some(Received::Loss(Loss::Bytes { offset, bytes })));
                }
                Found::Packet { packet: Packet::Register(register), .. } => {
                    return Ok(Some(Received::Register(register)));
                }
                Found::Packet { frame, packet } => {
                    let is_frame = matches!(packet, Packet::Frame(_));
                    if self.is_refused && !is_frame {
                        continue;
                    }
                    self.is_refused = is_frame;
                    if let (None, Packet::Frame(info)) = (&self.run, &packet) {
                        self.run = Some(Run::begin(&self.config, frame, info)?);
                    }
                    if let Some(run) = &mut self.run {
                        let ended = run.assembler.push(frame, packet)?;
                        self.is_refused = false;
                        run.show(ended, &mut self.found)?;
                    }
                }
            }
        }
    }
}

/// The state from packets to the screen.
#[derive(Debug)]
struct Run {
    design: Design,
    assembler: Assembler,
    receiver: Receiver,
    clock: FrameClock,
}

impl Run {
    /// Starts the decoding of a stream with this first FRAME packet.
    fn begin(config: &Config, frame: u32, info: &FrameInfo) -> Result<Self, SimulatorError> {
        if info.version != foveate_packets::VERSION {
            return Err(PacketError::Version { frame, version: info.version }.into());
        }
        refuse_claim(config, frame, info)?;
        let design = config.for_frames(info.width.into(), info.height.into())?;
        let layout = Layout::new(&design, info.has_scores, info.ticks_per_second)?;
        let assembler = Assembler::new(layout);
        assembler.check(frame, info)?;
        Ok(Self {
            receiver: Receiver::new(&design),
            assembler,
            design,
            clock: FrameClock::default(),
        })
    }

    /// Adds the losses so far, and then the frames that have ended.
    fn show(
        &mut self,
        ended: impl IntoIterator<Item = Option<ReceivedFrame>>,
        found: &mut VecDeque<Received>,
    ) -> Result<(), SimulatorError> {
        found.extend(self.assembler.losses().into_iter().map(Received::Loss));
        for frame in ended.into_iter().flatten() {
            let number = frame.number;
            let time = frame.info.as_ref().map(|info| self.clock.take(info));
            if time.is_some_and(|time| time.is_wrong) {
                found.push_back(Received::Loss(Loss::Time { frame: number }));
            }
            let shown = self.shown(frame, time.map(|time| time.time_us))?;
            found.push_back(Received::Frame(Box::new(shown)));
        }
        Ok(())
    }

    /// Shows a frame on the screen.
    fn shown(
        &mut self,
        frame: ReceivedFrame,
        time_us: Option<u64>,
    ) -> Result<ShownFrame, SimulatorError> {
        if frame.info.as_ref().is_some_and(|info| info.first) {
            self.receiver.reset();
        }
        for (region, content) in (0..).zip(&frame.contents) {
            match content {
                Some(Content::Pixels(pixels)) => self.receiver.take_pixels(region, pixels),
                Some(Content::Means(means)) => self.receiver.take_means(region, means),
                None => {}
            }
        }
        let actions = frame.actions(self.design.irrelevant());
        self.receiver.show(&actions);
        let of = |bit: fn(&foveate_packets::Decision) -> bool| {
            frame.decisions.iter().map(bit).collect::<Vec<_>>()
        };
        let outcome = FrameOutcome {
            srs: of(|decision| decision.srs),
            trs: of(|decision| decision.trs),
            active: of(|decision| decision.srs && decision.trs),
            actions,
            temporal_count: frame.temporal_count,
            scores: frame.scores,
            skipped: 0,
        };
        let screen = raster(&self.design, self.receiver.rendered())?;
        Ok(ShownFrame { number: frame.number, time_us, screen, outcome })
    }
}

/// Refuses a stream that alone claims larger frames than permitted.
fn refuse_claim(config: &Config, frame: u32, info: &FrameInfo) -> Result<(), SimulatorError> {
    let (width, height) = (u32::from(info.width), u32::from(info.height));
    let own = &config.camera.frame;
    let is_given = own.width.is_some() && own.height.is_some();
    if is_given || width.saturating_mul(height) <= CLAIMED_PIXELS {
        return Ok(());
    }
    Err(SimulatorError::ClaimedSize { frame, width, height, most: CLAIMED_PIXELS })
}

/// Returns a copy of the screen.
fn raster(design: &Design, screen: Plane<'_>) -> Result<Raster, SimulatorError> {
    let (width, height, bits) = (design.width(), design.height(), design.pixel_bits());
    Ok(match screen {
        Plane::Bytes(pixels) => Raster::from_bytes(width, height, bits, pixels.to_vec())?,
        Plane::Words(pixels) => Raster::from_words(width, height, bits, pixels.to_vec())?,
    })
}
