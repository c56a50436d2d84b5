// SPDX-License-Identifier: MIT OR Apache-2.0
//! The model of a core with its surroundings, for benches and diagrams.

use super::surroundings::{ExternalStore, StallingSink};
use crate::codec::RecordCodec;
use crate::layout::RecordLayout;
use crate::stimulus::{FrameFeed, settling_clocks};
use foveate_design::{Design, Hardware, PipelinedTiming, Port, PortRole};
use foveate_emit::Top;
use foveate_frame::Frame;
use foveate_model::{CoreInput, CycleModel, rcm_model, rpu_model};

/// The border mask of the only region of a 1x1 array: it touches the frame's border on all sides.
const ALL_SIDES: u8 = 0b1111;

/// The model of a core, with its external frame store if it has one, and a codec for its ports.
pub(crate) struct CoreSimulation<'a> {
    core: Box<dyn CycleModel>,
    codec: RecordCodec,
    feed: FrameFeed<'a>,
    external_store: Option<ExternalStore>,
    sink: StallingSink,
    settling_time: SettlingTime,
    has_pixels: bool,
    distinguishes_means: bool,
}

/// The time that a core needs after a frame.
#[derive(Clone, Copy, Debug)]
struct SettlingTime {
    /// The number of clocks after the last pixel of a frame until everything is decided that does
    /// not wait for another frame. A core that is ready earlier may need more clocks.
    settling_clocks: u64,
    /// The number of frames that must follow before the pixels of a frame have left.
    frames_behind: u32,
}

impl SettlingTime {
    fn for_design(design: &Design) -> Self {
        let (settling_clocks, frames_behind) = match design.hardware() {
            Hardware::Pipelined(own) => {
                let design = design.with_hardware(own);
                (settling_clocks(design), PipelinedTiming::from_design(design).forward_frames)
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

impl<'a> CoreSimulation<'a> {
    pub(crate) fn new(part: &'a Design, top: Top) -> Self {
        let ports = top.ports(part);
        let has = |role| ports.iter().any(|port| port.role == role);
        Self {
            has_pixels: has(PortRole::ForwardValid),
            distinguishes_means: has(PortRole::ForwardSummary),
            core: match top {
                Top::Rpu => rpu_model(part),
                Top::Rcm => rcm_model(part),
            },
            codec: RecordCodec::new(part),
            feed: FrameFeed::for_design(part),
            external_store: ExternalStore::for_design(part),
            sink: StallingSink::default(),
            settling_time: SettlingTime::for_design(part),
        }
    }

    /// Returns the number of pixels that the port takes in one beat.
    pub(crate) fn beat_width(&self) -> usize {
        self.feed.width()
    }

    /// Returns the beats of a frame for the pixel port, in order.
    pub(crate) fn beats(&self, frame: &Frame) -> Vec<Vec<u16>> {
        self.feed.beats(frame, || 0)
    }

    /// Simulates one clock edge.
    pub(crate) fn clock(&mut self, input: &CoreInput<'_>, record: &mut ClockRecord) {
        let input = CoreInput { border: ALL_SIDES, ..*input };
        let (reference_valid, word) = match &mut self.external_store {
            Some(outside) => outside.output_word(input.reset, &*self.core),
            None => (false, Vec::new()),
        };
        let input = CoreInput { reference_valid, reference_pixels: &word, ..input };
        self.core.clock(&input);
        if let Some(outside) = &mut self.external_store {
            outside.store_output(&*self.core);
        }
        self.record(&input, record);
    }

    /// Simulates the number of edges that [`CoreSimulation::quiet_clocks`] returns, without a
    /// pixel, in one step.
    pub(crate) fn skip_quiet_clocks(&mut self, input: &CoreInput<'_>, record: &mut ClockRecord) {
        self.core.skip_quiet_clocks();
        self.record(input, record);
    }

    fn record(&mut self, input: &CoreInput<'_>, record: &mut ClockRecord) {
        self.codec.encode_inputs(&record.inputs, input, &mut record.input);
        self.codec.encode_outputs(&record.outputs, &*self.core, &mut record.expected);
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
    pub(crate) fn is_sending(&self) -> bool {
        self.has_pixels && self.core.is_high(PortRole::ForwardValid)
    }

    /// Returns true if the ports distinguish means from pixels.
    pub(crate) fn distinguishes_means(&self) -> bool {
        self.distinguishes_means
    }

    /// Returns true if a mean leaves and the ports distinguish means from pixels.
    pub(crate) fn is_sending_mean(&self) -> bool {
        self.is_sending() && self.distinguishes_means && self.core.is_high(PortRole::ForwardSummary)
    }

    /// Returns the number of clocks after the last pixel of a frame until everything is decided
    /// that does not wait for another frame. A core that is ready earlier may need more clocks.
    pub(crate) fn settling_clocks(&self) -> u64 {
        self.settling_time.settling_clocks
    }

    /// Returns true if the stalling sink is ready at the next edge. It chooses the edges so that
    /// regions are lost in several ways.
    pub(crate) fn is_stalling_sink_ready(&mut self) -> bool {
        self.sink.is_ready_next(&*self.core)
    }

    /// Returns the number of frames that must follow before the pixels of a frame have left.
    pub(crate) fn frames_behind(&self) -> u32 {
        self.settling_time.frames_behind
    }
}

/// The inputs and outputs of one clock, as bytes.
pub(crate) struct ClockRecord {
    pub(crate) inputs: RecordLayout,
    pub(crate) outputs: RecordLayout,
    pub(crate) input: Vec<u8>,
    pub(crate) expected: Vec<u8>,
}

impl ClockRecord {
    pub(crate) fn for_ports(ports: &[Port]) -> Self {
        let (inputs, outputs) = (RecordLayout::inputs(ports), RecordLayout::outputs(ports));
        Self { input: inputs.zero_record(), expected: outputs.zero_record(), inputs, outputs }
    }
}
