// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of a core: a clock, a reset, streams, and control inputs. The list of ports
//! follows from it, and so do headers, test harnesses, vectors and benches.

use crate::{OutputQualifier, Port, PortDirection, PortRole};

/// The contents of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StreamRole {
    /// The pixels of frames, on their way into the core.
    Pixels,
    /// The words of the map of classes, on their way into the core.
    ClassWords,
    /// The commits of maps of classes.
    ClassCommits,
    /// The words that an external frame store returns to the core.
    References,
    /// The words that the core writes to an external frame store.
    StoredWords,
    /// The scores of regions, one after the other.
    Scores,
    /// The decisions of regions.
    Decisions,
    /// The pixels of active regions, and the means of summaries.
    ForwardedPixels,
    /// The regions that were lost because the sink stalled.
    LostRegions,
}

impl StreamRole {
    /// Returns the name that documents use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pixels => "pixels",
            Self::ClassWords => "classes",
            Self::ClassCommits => "commits",
            Self::References => "references",
            Self::StoredWords => "stored",
            Self::Scores => "scores",
            Self::Decisions => "decisions",
            Self::ForwardedPixels => "forwarded",
            Self::LostRegions => "lost",
        }
    }
}

/// The way in which a beat names the region that it belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeatRegion {
    /// The beat belongs to no region, or to several regions.
    None,
    /// The lane number is the region number.
    Lane,
    /// The lane, together with the slot number on the port of this role.
    Slot(PortRole),
    /// The region number is on the port of this role.
    Number(PortRole),
}

/// A group of ports that carry one beat together. A beat is transferred at an edge if `valid` is 1
/// before the edge, and `ready`, where the stream has it, is 1 too.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CoreStream {
    /// The contents of the stream.
    pub role: StreamRole,
    /// The direction of the beats, seen from the core.
    pub direction: PortDirection,
    /// The meaning of one beat, such as "a pixel of every region".
    pub beat: &'static str,
    /// The port that is 1 while there is a beat.
    pub valid: Port,
    /// The port that is 1 while a beat would be taken. Without it every beat is taken.
    pub ready: Option<Port>,
    /// The port that marks the first beat of a frame.
    pub start: Option<Port>,
    /// The ports with the data of a beat.
    pub payload: Vec<Port>,
    /// The way in which a beat names its region.
    pub region: BeatRegion,
    /// The role of the payload port that marks the last beat of a region or a row.
    pub last: Option<PortRole>,
    /// Outputs that report the state of the stream beside its beats: errors and counters.
    pub status: Vec<Port>,
}

/// The ports of a core, grouped by their purpose.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CoreInterface {
    /// The clock.
    pub clock: Port,
    /// The reset.
    pub reset: Port,
    /// The streams, in the order of their ports.
    pub streams: Vec<CoreStream>,
    /// Inputs that stay constant while a frame is under way: thresholds, and the borders of a
    /// single RPU.
    pub controls: Vec<Port>,
}

impl CoreStream {
    /// Makes a stream into the core without back-pressure: every beat is taken.
    pub(crate) fn into_core(
        role: StreamRole,
        beat: &'static str,
        valid: Port,
        payload: Vec<Port>,
    ) -> Self {
        let (ready, start, last) = (None, None, None);
        let (region, status, direction) = (BeatRegion::None, Vec::new(), PortDirection::Input);
        Self { role, direction, beat, valid, ready, start, payload, region, last, status }
    }

    /// Makes a stream out of the core without back-pressure: every beat is taken.
    pub(crate) fn out_of_core(
        role: StreamRole,
        beat: &'static str,
        valid: Port,
        payload: Vec<Port>,
    ) -> Self {
        Self { direction: PortDirection::Output, ..Self::into_core(role, beat, valid, payload) }
    }

    /// Returns the input ports of the stream, in their order.
    fn inputs(&self) -> impl Iterator<Item = &Port> {
        let (beat, ready) = match self.direction {
            PortDirection::Input => (Some(self.beat_ports()), None),
            PortDirection::Output => (None, self.ready.as_ref()),
        };
        beat.into_iter().flatten().chain(ready)
    }

    /// Returns the output ports of the stream, in their order.
    fn outputs(&self) -> impl Iterator<Item = &Port> {
        let (beat, ready) = match self.direction {
            PortDirection::Input => (None, self.ready.as_ref()),
            PortDirection::Output => (Some(self.beat_ports()), None),
        };
        ready.into_iter().chain(beat.into_iter().flatten()).chain(&self.status)
    }

    /// Returns the ports that carry one beat: `valid`, the start of a frame and the payload.
    fn beat_ports(&self) -> impl Iterator<Item = &Port> {
        std::iter::once(&self.valid).chain(&self.start).chain(&self.payload)
    }

    /// Returns every port of the stream.
    fn ports_mut(&mut self) -> impl Iterator<Item = &mut Port> {
        let beat = std::iter::once(&mut self.valid).chain(&mut self.start).chain(&mut self.payload);
        beat.chain(&mut self.ready).chain(&mut self.status)
    }
}

impl CoreInterface {
    /// Makes an interface with a clock, a reset, and the given streams and controls.
    pub(crate) fn new(streams: Vec<CoreStream>, controls: Vec<Port>) -> Self {
        let input = |role, doc| Port::scalar(PortDirection::Input, role, 1, doc);
        Self {
            clock: input(PortRole::Clock, "clock, rising edge"),
            reset: input(PortRole::Reset, "synchronous reset, active high"),
            streams,
            controls,
        }
    }

    /// Returns all ports, inputs first.
    #[must_use]
    pub fn ports(&self) -> Vec<Port> {
        let common = [&self.clock, &self.reset];
        let inputs = self.streams.iter().flat_map(CoreStream::inputs).chain(&self.controls);
        let outputs = self.streams.iter().flat_map(CoreStream::outputs);
        common.into_iter().chain(inputs).chain(outputs).cloned().collect()
    }

    /// Returns the stream that has a port of the role, or `None` for the clock, the reset and
    /// controls.
    #[must_use]
    pub fn stream_with_port(&self, role: PortRole) -> Option<&CoreStream> {
        let has =
            |stream: &&CoreStream| stream.inputs().chain(stream.outputs()).any(|p| p.role == role);
        self.streams.iter().find(has)
    }

    /// Returns the stream of the role, or `None` if the core does not have it.
    #[must_use]
    pub fn stream(&self, role: StreamRole) -> Option<&CoreStream> {
        self.streams.iter().find(|stream| stream.role == role)
    }

    /// Applies `change` to every port of every stream.
    pub(crate) fn change_stream_ports(&mut self, change: impl Fn(&mut Port)) {
        self.streams.iter_mut().flat_map(CoreStream::ports_mut).for_each(change);
    }
}

impl Port {
    /// Makes an output that has a meaning only while the port of role `valid` is 1.
    pub(crate) fn qualified_output(valid: PortRole, role: PortRole, width: u32, doc: &str) -> Self {
        let port = Self::scalar(PortDirection::Output, role, width, doc);
        Self { qualifier: OutputQualifier::WhileSet(valid), ..port }
    }
}
