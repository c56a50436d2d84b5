// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clocks that a timing diagram shows. The model is played during a frame and after it,
//! clock by clock ([`PortTrace`]), and the clocks around the changes of a line become columns
//! ([`columns`]).

use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::level::CosimLevel;
use crate::stimulus::{
    ClockReceiver, FrameFeed, FrameLimit, GapPattern, ModelDriver, Random, UnusedInputs,
};
use foveate_design::{ArrayStructure, CoreInterface, CoreStream, Design, Port, PortDirection};
use foveate_emit::Top;
use foveate_pixels::Frame;
use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

/// The largest number of regions of an array whose model is played. Of a larger array only one lane
/// is played.
const MAX_REGIONS: u32 = 1 << 14;

/// The clocks from the edge that takes the first pixel on.
pub(super) struct PortTrace {
    pub(super) title: String,
    pub(super) signals: Vec<DiagramSignal>,
    /// The stretches of equal clocks, in order.
    pub(super) stretches: Vec<ClockStretch>,
    /// The edges that take the first pixels of frames.
    pub(super) frame_edges: Vec<u64>,
}

/// A port, or its first lane.
pub(super) struct DiagramSignal {
    pub(super) name: String,
    /// True if the signal is drawn as a line, false if it is drawn as numbers.
    pub(super) is_bit: bool,
}

/// Consecutive clocks at which every signal has the same value.
pub(super) struct ClockStretch {
    /// The edge at which the first clock begins; edge 0 takes the first pixel.
    pub(super) first_edge: u64,
    pub(super) clocks: u64,
    /// The value of each signal; `None` if the value is not valid.
    pub(super) values: Vec<Option<u64>>,
}

impl PortTrace {
    /// Plays a frame with noise in its first region, the same frame as often as needed for the
    /// first one to leave, and the clocks until everything is decided.
    pub(super) fn record(design: &Design, cancel: &AtomicBool) -> Result<Self, CosimError> {
        let (part, title) = traced_design(design)?;
        let top = match part.unit().array {
            ArrayStructure::RpuCopies => Top::Rpu,
            ArrayStructure::SharedLogic => Top::Rcm,
        };
        let mut recorder = TraceRecorder::new(&part, top, title);
        let unused = UnusedInputs::Constant { refused_clocks: 0 };
        let (feed, random) = (FrameFeed::for_design(&part), Random::new(1));
        let mut driver =
            ModelDriver::new((&part, top), feed, unused, &mut recorder, random, cancel);
        let frame = traced_frame(&part);
        for _ in 0..=driver.drain_timing().frames_behind {
            driver.wait_until_ready(None)?;
            driver.receiver().begin_frame();
            driver.send_frame(&frame, FrameLimit::WholeFrame, GapPattern::None)?;
        }
        driver.wait_until_ready(None)?;
        driver.idle(driver.drain_timing().settling_clocks.max(2))?;
        Ok(recorder.trace)
    }
}

/// Returns the part of the design that is played: one region if all regions behave alike, or else
/// the array, or one lane of a huge array.
fn traced_design(design: &Design) -> Result<(Design, String), CosimError> {
    let size = design.region_size();
    match design.unit().array {
        ArrayStructure::RpuCopies => {
            let part = CosimLevel::Rcm { columns: 1, rows: 1 }.design(design)?;
            let title = format!("One of {} regions of {size}x{size} pixels", design.regions());
            return Ok((part, title));
        }
        ArrayStructure::SharedLogic => {}
    }
    if design.regions() <= MAX_REGIONS {
        let words = format!("{} regions of {size}x{size} pixels", design.regions());
        let unit = design.unit();
        let units = match unit.count {
            1 => format!("one {}", unit.name),
            count => format!("{count} {}s", unit.name),
        };
        return Ok((design.clone(), format!("{words} in {units}")));
    }
    let part = design.lone_unit();
    let words = format!("{} regions of {size}x{size} pixels, module rpu", part.regions());
    Ok((part, words))
}

/// Returns a frame with noise in the first region, and one level elsewhere.
fn traced_frame(part: &Design) -> Frame {
    let side = part.region_size();
    let max = u16::try_from(part.pixel_max()).expect("a pixel has at most 16 bits");
    let mut random = Random::new(1);
    let pixel = |x: u32, y: u32| if x < side && y < side { random.pixel(max) } else { max / 3 };
    Frame::from_fn(part.width(), part.height(), part.pixel_bits(), pixel)
        .unwrap_or_else(|error| unreachable!("pixels are those of the design: {error}"))
}

/// A trace that is being made.
struct TraceRecorder {
    inputs: RecordLayout,
    outputs: RecordLayout,
    edge: u64,
    trace: PortTrace,
    interface: CoreInterface,
}

impl TraceRecorder {
    fn new(part: &Design, top: Top, title: String) -> Self {
        let interface = top.interface(part);
        let ports = interface.ports();
        let (inputs, outputs) = (RecordLayout::inputs(&ports), RecordLayout::outputs(&ports));
        let shown = inputs.fields().iter().chain(outputs.fields()).map(|field| &field.port);
        let signals = shown.filter(|port| is_shown(&interface, port)).map(diagram_signal).collect();
        Self {
            inputs,
            outputs,
            edge: 0,
            trace: PortTrace { title, signals, stretches: Vec::new(), frame_edges: Vec::new() },
            interface,
        }
    }

    /// Marks the next edge as the one that takes the first pixel of a frame.
    fn begin_frame(&mut self) {
        self.trace.frame_edges.push(self.edge);
    }
}

impl ClockReceiver for TraceRecorder {
    fn inputs(&self) -> &RecordLayout {
        &self.inputs
    }

    fn outputs(&self) -> &RecordLayout {
        &self.outputs
    }

    fn add_clocks(&mut self, input: &[u8], output: &[u8], clocks: u64) -> Result<(), CosimError> {
        let Self { inputs, outputs, .. } = self;
        let is_high = |role| {
            let valid = inputs.fields().iter().find(|field| field.port.role == role);
            valid.is_some_and(|field| field.get(input, 0) == 1)
        };
        let interface = &self.interface;
        let shown = inputs.fields().iter().filter(|field| is_shown(interface, &field.port));
        let input_values = shown.map(|field| {
            let role = field.port.role;
            let valid = interface.stream_with_port(role).map(|stream| stream.valid.role);
            let says = valid.is_none_or(|valid| valid == role || is_high(valid));
            says.then(|| field.get(input, 0))
        });
        let output_values = outputs.fields().iter().map(|field| {
            let says = outputs.compared_lanes(field, output).next() == Some(0);
            says.then(|| field.get(output, 0))
        });
        let values: Vec<_> = input_values.chain(output_values).collect();
        let first_edge = self.edge;
        self.edge += clocks;
        match self.trace.stretches.last_mut() {
            Some(last) if last.values == values => last.clocks += clocks,
            _ => self.trace.stretches.push(ClockStretch { first_edge, clocks, values }),
        }
        Ok(())
    }
}

/// Returns true if a port is shown. Thresholds, resets and borders do not change, and the sink is
/// always ready.
fn is_shown(interface: &CoreInterface, port: &Port) -> bool {
    let brings = |stream: &CoreStream| stream.direction == PortDirection::Input;
    port.direction == PortDirection::Output
        || interface.stream_with_port(port.role).is_some_and(brings)
}

fn diagram_signal(port: &Port) -> DiagramSignal {
    let lane = match (port.lanes, port.width) {
        (1, _) => String::new(),
        (_, 1) => "[0]".to_owned(),
        (_, width) => format!("[{}:0]", width - 1),
    };
    DiagramSignal { name: format!("{}{lane}", port.name), is_bit: !port.role.is_number() }
}

/// The number of shown changes of a line at the start and at the end; a line may change thousands
/// of times.
const SHOWN_CHANGES: usize = 2;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DiagramColumn {
    /// The clock that begins with this edge, in the stretch with this index.
    Clock { edge: u64, stretch: usize },
    /// A gap for clocks that are left out.
    Gap,
}

/// Returns the columns of a diagram: the last clock, the clocks before and after a frame begins or
/// a line changes, and gaps.
pub(super) fn columns(trace: &PortTrace) -> Vec<DiagramColumn> {
    let end = trace.stretches.last().map_or(0, |last| last.first_edge + last.clocks);
    let bits = (0..trace.signals.len()).filter(|&at| trace.signals[at].is_bit);
    let mut starts = trace.frame_edges.clone();
    starts.push(end);
    starts.extend(bits.flat_map(|at| change_edges(&trace.stretches, at)));
    // The clocks before, at and after a change are shown.
    let near = |start: u64| [start.checked_sub(1), Some(start), Some(start + 1)];
    let edges = starts.into_iter().flat_map(near).flatten().filter(|&edge| edge < end);
    let mut columns = Vec::new();
    let mut next = 0;
    for edge in edges.collect::<BTreeSet<_>>() {
        // A gap of one clock is as wide as the clock itself.
        if edge == next + 1 {
            columns.push(clock_column(trace, next));
        } else if edge > next {
            columns.push(DiagramColumn::Gap);
        }
        columns.push(clock_column(trace, edge));
        next = edge + 1;
    }
    columns
}

fn change_edges(stretches: &[ClockStretch], signal: usize) -> Vec<u64> {
    let pairs = stretches.windows(2);
    let changed = pairs.filter(|pair| pair[0].values[signal] != pair[1].values[signal]);
    let mut edges: Vec<u64> = changed.map(|pair| pair[1].first_edge).collect();
    if edges.len() > 2 * SHOWN_CHANGES {
        edges.drain(SHOWN_CHANGES..edges.len() - SHOWN_CHANGES);
    }
    edges
}

fn clock_column(trace: &PortTrace, edge: u64) -> DiagramColumn {
    let behind = trace.stretches.partition_point(|stretch| stretch.first_edge <= edge);
    DiagramColumn::Clock { edge, stretch: behind - 1 }
}
