// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of a core: a clock and a reset, streams, and controls beside them. The list of ports follows from it, and
//! so do headers, harnesses, vectors and benches.

use crate::{Direction, Port, PortRole, Qualifier};

/// What a stream carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StreamRole {
    /// The pixels of frames, into the core.
    Pixels,
    /// What a frame store outside gives back, into the core.
    References,
    /// What a frame store outside keeps.
    Stored,
    /// Scores, one after the other.
    Scores,
    /// Decisions.
    Decisions,
    /// The pixels of active regions.
    Forwarded,
    /// Regions that were lost on their way to a sink that stalls.
    Lost,
}

impl StreamRole {
    /// The name, as in documents.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pixels => "pixels",
            Self::References => "references",
            Self::Stored => "stored",
            Self::Scores => "scores",
            Self::Decisions => "decisions",
            Self::Forwarded => "forwarded",
            Self::Lost => "lost",
        }
    }
}

/// How a beat names the region that it belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeatRegion {
    /// It belongs to none, or to several.
    None,
    /// By its lane: lane i is region i.
    Lane,
    /// By its lane, and the port of this role, which says which region of the lane.
    Slot(PortRole),
    /// By the port of this role.
    Number(PortRole),
}

/// Ports that say one thing together. A beat is there at an edge if `valid` is 1 before it, and, where there is `ready`, if that is
/// 1, too.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stream {
    /// What it carries.
    pub role: StreamRole,
    /// Whether beats go into the core or out of it.
    pub direction: Direction,
    /// What a beat is, such as "a pixel of every region".
    pub beat: &'static str,
    /// Says that there is a beat.
    pub valid: Port,
    /// Says that it is taken; without it every beat is.
    pub ready: Option<Port>,
    /// Marks the first beat of a frame.
    pub start: Option<Port>,
    /// What a beat consists of.
    pub payload: Vec<Port>,
    /// How it names its region.
    pub region: BeatRegion,
    /// Which port of the payload marks the last beat of what belongs together.
    pub last: Option<PortRole>,
    /// What the core keeps or says of the stream beside its beats: errors and counters.
    pub status: Vec<Port>,
}

/// The ports of a core by what they are for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interface {
    /// The clock.
    pub clock: Port,
    /// The reset.
    pub reset: Port,
    /// The streams, in the order of their ports.
    pub streams: Vec<Stream>,
    /// Inputs that stand still while a frame is under way: thresholds, and the borders of a lone RPU.
    pub controls: Vec<Port>,
}

impl Stream {
    /// A stream into the core whose every beat is taken.
    pub(crate) fn into_core(
        role: StreamRole,
        beat: &'static str,
        valid: Port,
        payload: Vec<Port>,
    ) -> Self {
        let (ready, start, last) = (None, None, None);
        let (region, status, direction) = (BeatRegion::None, Vec::new(), Direction::Input);
        Self { role, direction, beat, valid, ready, start, payload, region, last, status }
    }

    /// A stream out of the core that nobody holds up.
    pub(crate) fn out_of_core(
        role: StreamRole,
        beat: &'static str,
        valid: Port,
        payload: Vec<Port>,
    ) -> Self {
        Self { direction: Direction::Output, ..Self::into_core(role, beat, valid, payload) }
    }

    /// Its ports from outside into the core, in their order.
    fn inputs(&self) -> impl Iterator<Item = &Port> {
        let (beat, ready) = match self.direction {
            Direction::Input => (Some(self.beat_ports()), None),
            Direction::Output => (None, self.ready.as_ref()),
        };
        beat.into_iter().flatten().chain(ready)
    }

    /// Its ports out of the core, in their order.
    fn outputs(&self) -> impl Iterator<Item = &Port> {
        let (beat, ready) = match self.direction {
            Direction::Input => (None, self.ready.as_ref()),
            Direction::Output => (Some(self.beat_ports()), None),
        };
        ready.into_iter().chain(beat.into_iter().flatten()).chain(&self.status)
    }

    /// What is there with a beat.
    fn beat_ports(&self) -> impl Iterator<Item = &Port> {
        std::iter::once(&self.valid).chain(&self.start).chain(&self.payload)
    }

    /// Every port of it.
    fn all_mut(&mut self) -> impl Iterator<Item = &mut Port> {
        let beat = std::iter::once(&mut self.valid).chain(&mut self.start).chain(&mut self.payload);
        beat.chain(&mut self.ready).chain(&mut self.status)
    }
}

impl Interface {
    /// The interface with these streams and controls.
    pub(crate) fn new(streams: Vec<Stream>, controls: Vec<Port>) -> Self {
        let input = |role, doc| Port::single(Direction::Input, role, 1, doc);
        Self {
            clock: input(PortRole::Clock, "clock, rising edge"),
            reset: input(PortRole::Reset, "synchronous reset, active high"),
            streams,
            controls,
        }
    }

    /// All ports, inputs first.
    #[must_use]
    pub fn ports(&self) -> Vec<Port> {
        let common = [&self.clock, &self.reset];
        let inputs = self.streams.iter().flat_map(Stream::inputs).chain(&self.controls);
        let outputs = self.streams.iter().flat_map(Stream::outputs);
        common.into_iter().chain(inputs).chain(outputs).cloned().collect()
    }

    /// The stream that a port belongs to; none of the clock, the reset and controls.
    #[must_use]
    pub fn stream_of(&self, role: PortRole) -> Option<&Stream> {
        let has =
            |stream: &&Stream| stream.inputs().chain(stream.outputs()).any(|p| p.role == role);
        self.streams.iter().find(has)
    }

    /// The stream of a role, if the core has it.
    #[must_use]
    pub fn stream(&self, role: StreamRole) -> Option<&Stream> {
        self.streams.iter().find(|stream| stream.role == role)
    }

    /// Changes ports of streams one by one.
    pub(crate) fn each_of_streams(&mut self, change: impl Fn(&mut Port)) {
        self.streams.iter_mut().flat_map(Stream::all_mut).for_each(change);
    }
}

impl Port {
    /// An output that means something only while that of another role is 1.
    pub(crate) fn with(valid: PortRole, role: PortRole, width: u32, doc: &str) -> Self {
        let port = Self::single(Direction::Output, role, width, doc);
        Self { qualifier: Qualifier::With(valid), ..port }
    }
}
