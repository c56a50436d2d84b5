// SPDX-License-Identifier: MIT OR Apache-2.0
//! The model of a core in the middle of what surrounds it, as benches and diagrams play it.

use super::surroundings::{Outside, Stalling};
use crate::codec::Codec;
use crate::layout::Layout;
use crate::stimulus::{FrameFeed, settling_clocks};
use foveate_design::{Design, Hardware, PipelinedTiming, Port, PortRole};
use foveate_emit::Top;
use foveate_frame::Frame;
use foveate_model::{CoreInput, CycleModel, rcm, rpu};

/// The only region of an array of one is at the frame's border on all sides.
const ALL_SIDES: u8 = 0b1111;

/// The model, its frame store outside where it has one, and its values in records.
pub(crate) struct Rig<'a> {
    core: Box<dyn CycleModel>,
    codec: Codec,
    feed: FrameFeed<'a>,
    outside: Option<Outside>,
    sink: Stalling,
    tail: Tail,
    has_pixels: bool,
    tells_means: bool,
}

/// What comes after a frame.
#[derive(Clone, Copy, Debug)]
struct Tail {
    /// Clocks after the last pixel of a frame until everything has been decided that does not wait for another
    /// frame; more where the core is ready again before.
    settling_clocks: u64,
    /// Frames that must follow before the pixels of a frame have left.
    frames_behind: u32,
}

impl Tail {
    fn of(design: &Design) -> Self {
        let (settling_clocks, frames_behind) = match design.hardware() {
            Hardware::Pipelined(own) => {
                let design = design.on(own);
                (settling_clocks(design), PipelinedTiming::of(design).forward_frames)
            }
            Hardware::Serial(_) => (0, 0),
            Hardware::Raster(_) => {
                let departure = design.timing().departure();
                (departure.decision_clocks.max(departure.forward_clocks), 0)
            }
        };
        Self { settling_clocks, frames_behind }
    }
}

impl<'a> Rig<'a> {
    pub(crate) fn new(part: &'a Design, top: Top) -> Self {
        let ports = top.ports(part);
        let has = |role| ports.iter().any(|port| port.role == role);
        Self {
            has_pixels: has(PortRole::ForwardValid),
            tells_means: has(PortRole::ForwardSummary),
            core: match top {
                Top::Rpu => rpu(part),
                Top::Rcm => rcm(part),
            },
            codec: Codec::new(part),
            feed: FrameFeed::of(part),
            outside: Outside::of(part),
            sink: Stalling::default(),
            tail: Tail::of(part),
        }
    }

    /// Pixels that the port takes at once.
    pub(crate) fn width(&self) -> usize {
        self.feed.width()
    }

    /// What the pixel port takes of a frame, one after the other.
    pub(crate) fn beats(&self, frame: &Frame) -> Vec<Vec<u16>> {
        self.feed.beats(frame, || 0)
    }

    /// One edge.
    pub(crate) fn clock(&mut self, input: &CoreInput<'_>, record: &mut Record) {
        let input = CoreInput { border: ALL_SIDES, ..*input };
        let (reference_valid, word) = match &mut self.outside {
            Some(outside) => outside.show(input.reset, &*self.core),
            None => (false, Vec::new()),
        };
        let input = CoreInput { reference_valid, reference_pixels: &word, ..input };
        self.core.clock(&input);
        if let Some(outside) = &mut self.outside {
            outside.keep(&*self.core);
        }
        self.record(&input, record);
    }

    /// As many edges without a pixel as [`Rig::quiet_clocks`] says, at once.
    pub(crate) fn skip(&mut self, input: &CoreInput<'_>, record: &mut Record) {
        self.core.skip_quiet_clocks();
        self.record(input, record);
    }

    fn record(&mut self, input: &CoreInput<'_>, record: &mut Record) {
        self.codec.inputs(&record.inputs, input, &mut record.input);
        self.codec.outputs(&record.outputs, &*self.core, &mut record.expected);
    }

    /// For how many clocks without a pixel the outputs stay as they are.
    pub(crate) fn quiet_clocks(&self) -> u64 {
        self.core.quiet_clocks()
    }

    /// Whether a pixel is taken.
    pub(crate) fn is_ready(&self) -> bool {
        self.core.is_ready()
    }

    /// Whether a pixel leaves, or a mean.
    pub(crate) fn sends(&self) -> bool {
        self.has_pixels && self.core.is_high(PortRole::ForwardValid)
    }

    /// Whether the ports tell means from pixels.
    pub(crate) fn tells_means(&self) -> bool {
        self.tells_means
    }

    /// Whether a mean leaves, where the ports tell.
    pub(crate) fn sends_mean(&self) -> bool {
        self.sends() && self.tells_means && self.core.is_high(PortRole::ForwardSummary)
    }

    /// Clocks after the last pixel of a frame until everything has been decided that does not wait for another
    /// frame; more where the core is ready again before.
    pub(crate) fn settling_clocks(&self) -> u64 {
        self.tail.settling_clocks
    }

    /// Whether a sink that stalls is ready at the next edge: at some, where that tells more of what is lost.
    pub(crate) fn takes_while_stalling(&mut self) -> bool {
        self.sink.next(&*self.core)
    }

    /// Frames that must follow before the pixels of a frame have left.
    pub(crate) fn frames_behind(&self) -> u32 {
        self.tail.frames_behind
    }
}

/// What goes in and what comes out at one clock, as bytes.
pub(crate) struct Record {
    pub(crate) inputs: Layout,
    pub(crate) outputs: Layout,
    pub(crate) input: Vec<u8>,
    pub(crate) expected: Vec<u8>,
}

impl Record {
    pub(crate) fn of(ports: &[Port]) -> Self {
        let (inputs, outputs) = (Layout::inputs(ports), Layout::outputs(ports));
        Self { input: inputs.record(), expected: outputs.record(), inputs, outputs }
    }
}
