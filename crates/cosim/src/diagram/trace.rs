// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports of the model during a frame and after it, clock by clock.

use crate::error::CosimError;
use crate::level::Level;
use crate::shipped::{Record, Rig, TestPattern};
use crate::stimulus::Random;
use foveate_design::{Array, Design, Direction, Interface, Port, Stream};
use foveate_emit::Top;
use foveate_frame::Frame;
use foveate_model::{CoreInput, Thresholds};
use foveate_toolchain::ToolError;
use std::sync::atomic::{AtomicBool, Ordering};

/// The largest number of regions of an array whose model is played. Of a larger array only one lane
/// is played.
const MAX_REGIONS: u32 = 1 << 14;

/// The clocks from the edge that takes the first pixel on.
pub(super) struct Trace {
    /// The title of the diagram.
    pub(super) title: String,
    pub(super) signals: Vec<Signal>,
    /// The stretches of equal clocks, in order.
    pub(super) stretches: Vec<Stretch>,
    /// The edges that take the first pixels of frames.
    pub(super) frames: Vec<u64>,
}

/// A port, or its first lane.
pub(super) struct Signal {
    pub(super) name: String,
    /// True if the signal is drawn as a line, false if it is drawn as numbers.
    pub(super) is_bit: bool,
}

/// Consecutive clocks at which every signal has the same value.
pub(super) struct Stretch {
    /// The edge at which the first clock begins; edge 0 takes the first pixel.
    pub(super) first_edge: u64,
    pub(super) clocks: u64,
    /// The value of each signal; `None` if the value is not valid.
    pub(super) values: Vec<Option<u64>>,
}

impl Trace {
    /// Plays a frame with noise in its first region, the same frame as often as needed for the
    /// first one to leave, and the clocks until everything is decided.
    pub(super) fn of(design: &Design, cancel: &AtomicBool) -> Result<Self, CosimError> {
        let (part, title) = part(design)?;
        let top = match part.unit().array {
            Array::Copies => Top::Rpu,
            Array::Whole => Top::Rcm,
        };
        let mut take = Take::new(&part, top, title, cancel);
        let frame = frame(&part);
        for _ in 0..=take.rig.frames_behind() {
            let beats = take.rig.beats(&frame);
            take.wait()?;
            take.trace.frames.push(take.edge);
            for (number, pixels) in beats.iter().enumerate() {
                take.wait()?;
                take.clock(Some(pixels), number == 0)?;
            }
        }
        take.wait()?;
        let settling = take.rig.settling_clocks();
        (0..settling.max(2)).try_for_each(|_| take.clock(None, false))?;
        Ok(take.trace)
    }
}

/// Returns the part of the design that is played: one region if all regions behave alike, or else
/// the array, or one lane of a huge array.
fn part(design: &Design) -> Result<(Design, String), CosimError> {
    let size = design.region_size();
    match design.unit().array {
        Array::Copies => {
            let part = Level::Rcm { columns: 1, rows: 1 }.design(design)?;
            let title = format!("One of {} regions of {size}x{size} pixels", design.regions());
            return Ok((part, title));
        }
        Array::Whole => {}
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
fn frame(part: &Design) -> Frame {
    let side = part.region_size();
    let max = u16::try_from(part.pixel_max()).expect("a pixel has at most 16 bits");
    let square = TestPattern::Noise.draw(side as usize, max, false, &mut Random::new(1));
    let pixel = |x: u32, y: u32| {
        if x < side && y < side { square[(y * side + x) as usize] } else { max / 3 }
    };
    Frame::from_fn(part.width(), part.height(), part.pixel_bits(), pixel)
        .unwrap_or_else(|error| unreachable!("pixels are those of the design: {error}"))
}

/// A trace that is being made.
struct Take<'a> {
    rig: Rig<'a>,
    record: Record,
    thresholds: Thresholds,
    garbage: Vec<u16>,
    edge: u64,
    trace: Trace,
    interface: Interface,
    cancel: &'a AtomicBool,
}

impl<'a> Take<'a> {
    fn new(part: &'a Design, top: Top, title: String, cancel: &'a AtomicBool) -> Self {
        let interface = top.interface(part);
        let record = Record::of(&interface.ports());
        let rig = Rig::new(part, top);
        let shown =
            record.inputs.fields().iter().chain(record.outputs.fields()).map(|field| &field.port);
        let signals = shown.filter(|port| is_shown(&interface, port)).map(signal).collect();
        Self {
            garbage: vec![0; rig.width()],
            record,
            rig,
            thresholds: Thresholds::of(part),
            edge: 0,
            trace: Trace { title, signals, stretches: Vec::new(), frames: Vec::new() },
            interface,
            cancel,
        }
    }

    /// Lets clocks pass until a pixel can be taken.
    fn wait(&mut self) -> Result<(), CosimError> {
        while !self.rig.is_ready() {
            match self.rig.quiet_clocks() {
                0 | 1 => self.clock(None, false)?,
                quiet => {
                    let applied = CoreInput::idle(&self.garbage, &self.thresholds);
                    self.rig.skip(&applied, &mut self.record);
                    self.keep(quiet);
                }
            }
        }
        Ok(())
    }

    fn clock(&mut self, pixels: Option<&[u16]>, sof: bool) -> Result<(), CosimError> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(ToolError::Interrupted.into());
        }
        let idle = CoreInput::idle(pixels.unwrap_or(&self.garbage), &self.thresholds);
        let applied = CoreInput { valid: pixels.is_some(), sof, ..idle };
        self.rig.clock(&applied, &mut self.record);
        self.keep(1);
        Ok(())
    }

    fn keep(&mut self, clocks: u64) {
        let Record { inputs, outputs, input, expected } = &self.record;
        let is_high = |role| {
            let valid = inputs.fields().iter().find(|field| field.port.role == role);
            valid.is_some_and(|field| field.get(input, 0) == 1)
        };
        let interface = &self.interface;
        let shown = inputs.fields().iter().filter(|field| is_shown(interface, &field.port));
        let input = shown.map(|field| {
            let role = field.port.role;
            let valid = interface.stream_of(role).map(|stream| stream.valid.role);
            let says = valid.is_none_or(|valid| valid == role || is_high(valid));
            says.then(|| field.get(input, 0))
        });
        let output = outputs.fields().iter().map(|field| {
            let says = outputs.compared_lanes(field, expected).next() == Some(0);
            says.then(|| field.get(expected, 0))
        });
        let values: Vec<_> = input.chain(output).collect();
        let first_edge = self.edge;
        self.edge += clocks;
        match self.trace.stretches.last_mut() {
            Some(last) if last.values == values => last.clocks += clocks,
            _ => self.trace.stretches.push(Stretch { first_edge, clocks, values }),
        }
    }
}

/// Returns true if a port is shown. Thresholds, resets and borders do not change, and the sink is
/// always ready.
fn is_shown(interface: &Interface, port: &Port) -> bool {
    let brings = |stream: &Stream| stream.direction == Direction::Input;
    port.direction == Direction::Output || interface.stream_of(port.role).is_some_and(brings)
}

fn signal(port: &Port) -> Signal {
    let lane = match (port.lanes, port.width) {
        (1, _) => String::new(),
        (_, 1) => "[0]".to_owned(),
        (_, width) => format!("[{}:0]", width - 1),
    };
    Signal { name: format!("{}{lane}", port.name), is_bit: !port.role.is_number() }
}
