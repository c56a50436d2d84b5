// SPDX-License-Identifier: MIT OR Apache-2.0
//! The model of a core with its surroundings, for benches and diagrams.

use super::surroundings::{Outside, Stalling};
use crate::codec::Codec;
use crate::layout::Layout;
use crate::stimulus::{FrameFeed, settling_clocks};
use foveate_design::{Design, Hardware, PipelinedTiming, Port, PortRole};
use foveate_emit::Top;
use foveate_frame::Frame;
use foveate_model::{CoreInput, CycleModel, rcm, rpu};

/// The border mask of the only region of a 1x1 array: it touches the frame's border on all sides.
const ALL_SIDES: u8 = 0b1111;

/// The model of a core, with its external frame store if it has one, and a codec for its ports.
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

/// The time that a core needs after a frame.
#[derive(Clone, Copy, Debug)]
struct Tail {
    /// The number of clocks after the last pixel of a frame until everything is decided that does
    /// not wait for another frame. A core that is ready earlier may need more clocks.
    settling_clocks: u64,
    /// The number of frames that must follow before the pixels of a frame have left.
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

    /// Returns the number of pixels that the port takes in one beat.
    pub(crate) fn width(&self) -> usize {
        self.feed.width()
    }

    /// Returns the beats of a frame for the pixel port, in order.
    pub(crate) fn beats(&self, frame: &Frame) -> Vec<Vec<u16>> {
        self.feed.beats(frame, || 0)
    }

    /// Simulates one clock edge.
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

    /// Simulates the number of edges that [`Rig::quiet_clocks`] returns, without a pixel, in one
    /// step.
    pub(crate) fn skip(&mut self, input: &CoreInput<'_>, record: &mut Record) {
        self.core.skip_quiet_clocks();
        self.record(input, record);
    }

    fn record(&mut self, input: &CoreInput<'_>, record: &mut Record) {
        self.codec.inputs(&record.inputs, input, &mut record.input);
        self.codec.outputs(&record.outputs, &*self.core, &mut record.expected);
    }

    /// Returns the number of clocks without a pixel during which the outputs do not change.
    pub(crate) fn quiet_clocks(&self) -> u64 {
        self.core.quiet_clocks()
    }

    /// Returns true if a pixel can be taken.
    pub(crate) fn is_ready(&self) -> bool {
        self.core.is_ready()
    }

    /// Returns true if a pixel or a mean leaves.
    pub(crate) fn sends(&self) -> bool {
        self.has_pixels && self.core.is_high(PortRole::ForwardValid)
    }

    /// Returns true if the ports distinguish means from pixels.
    pub(crate) fn tells_means(&self) -> bool {
        self.tells_means
    }

    /// Returns true if a mean leaves and the ports distinguish means from pixels.
    pub(crate) fn sends_mean(&self) -> bool {
        self.sends() && self.tells_means && self.core.is_high(PortRole::ForwardSummary)
    }

    /// Returns the number of clocks after the last pixel of a frame until everything is decided
    /// that does not wait for another frame. A core that is ready earlier may need more clocks.
    pub(crate) fn settling_clocks(&self) -> u64 {
        self.tail.settling_clocks
    }

    /// Returns true if the stalling sink is ready at the next edge. It chooses the edges so that
    /// regions are lost in several ways.
    pub(crate) fn takes_while_stalling(&mut self) -> bool {
        self.sink.next(&*self.core)
    }

    /// Returns the number of frames that must follow before the pixels of a frame have left.
    pub(crate) fn frames_behind(&self) -> u32 {
        self.tail.frames_behind
    }
}

/// The inputs and outputs of one clock, as bytes.
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
