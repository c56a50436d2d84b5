// SPDX-License-Identifier: MIT OR Apache-2.0
//! The activity of the hardware at a clock: the pixel that enters, or the phase of its work.
//!
//! It is counted from the inputs of the vectors and the outputs of the model, from the reset of the
//! sequence on.

use super::layout::RecordField;
use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::recording::Recording;
use foveate_design::{
    Design, Hardware, PipelinedDesign, PixelFeed, PortRole, RasterTiming, SerialDesign,
    SerialPhase, SerialTiming,
};
use foveate_model::FrameSync;
use std::fmt;

/// The activity of the hardware after an edge. Frames are counted from 0 after the reset of the
/// sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CoreActivity {
    /// The core is in reset.
    Reset,
    /// The edge has taken this pixel of a frame's stream: its number, column and row, which are
    /// negative in a halo. A raster core takes words; the place is that of the first pixel.
    Pixel { unit: &'static str, frame: u64, number: u64, of: u64, x: i64, y: i64 },
    /// Nothing was taken; `taken` pixels or words of this frame have come in.
    Waiting { unit: &'static str, frame: u64, taken: u64, of: u64 },
    /// The core completes this frame by itself; `taken` pixels or words of it have come in.
    Completing { unit: &'static str, frame: u64, taken: u64, of: u64 },
    /// The lanes work on a frame.
    Work { frame: u64, slot: u64, phase: SerialPhase, step: u64, of: u64 },
}

impl fmt::Display for CoreActivity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reset => write!(f, "in reset"),
            Self::Pixel { unit, frame, number, of, x, y } => {
                write!(f, "{unit} {number} of {of} (x {x}, y {y}) of frame {frame} enters")
            }
            Self::Waiting { unit, frame, taken, of } => {
                write!(f, "{taken} of {of} {unit}s of frame {frame} are in")
            }
            Self::Completing { unit, frame, taken, of } => {
                write!(f, "the core completes frame {frame}, {taken} of {of} {unit}s are in")
            }
            Self::Work { frame, slot, phase, step, of } => {
                write!(f, "frame {frame}, slot {slot}, phase \"{phase}\", step {step} of {of}")
            }
        }
    }
}

impl CoreActivity {
    /// Returns the name of the score that passes the ports.
    pub(crate) fn score(&self) -> Option<&'static str> {
        match self {
            Self::Work { phase: SerialPhase::RotateCount, .. } => Some("temporal count"),
            Self::Work { phase: SerialPhase::RotateScore(kind), .. } => Some(kind.name()),
            _ => None,
        }
    }
}

/// The way in which a frame comes in.
enum FrameInput<'a> {
    /// One pixel of every region at a time.
    Regions(PipelinedDesign<'a>),
    /// One pixel of every lane at a time, or one pixel of the frame; then the lanes work on it.
    Lanes(SerialDesign<'a>, SerialTiming),
    /// One word of the frame at a time.
    Words(RasterTiming),
}

impl<'a> FrameInput<'a> {
    fn for_design(design: &'a Design) -> Self {
        match design.hardware() {
            Hardware::Pipelined(own) => Self::Regions(design.with_hardware(own)),
            Hardware::Serial(own) => {
                let array = design.with_hardware(own);
                Self::Lanes(array, SerialTiming::from_design(array))
            }
            Hardware::Raster(own) => {
                Self::Words(RasterTiming::from_design(design.with_hardware(own)))
            }
        }
    }

    /// Returns the name of the unit that comes at a time.
    fn unit_name(&self) -> &'static str {
        match self {
            Self::Regions(_) | Self::Lanes(..) => "pixel",
            Self::Words(_) => "word",
        }
    }

    /// Returns the timing of the lanes, if they work on a frame after it has come in.
    fn lane_timing(&self) -> Option<&SerialTiming> {
        match self {
            Self::Lanes(_, timing) => Some(timing),
            Self::Regions(_) | Self::Words(_) => None,
        }
    }

    /// Returns the number of clocks after a pixel or word, at the given column and row, in which
    /// none is taken within a frame.
    fn pause_after(&self, number: u64, (x, y): (i64, i64)) -> u64 {
        match self {
            Self::Words(timing) if (number + 1).is_multiple_of(timing.taken_words.into()) => {
                (timing.row_words - timing.taken_words).into()
            }
            Self::Lanes(array, _) if array.feed() == PixelFeed::Raster => {
                let at = |place: i64| u32::try_from(place).expect("a place in a frame");
                u64::from(array.column_places(at(x)) * array.row_places(at(y)) - 1)
            }
            Self::Regions(_) | Self::Lanes(..) | Self::Words(_) => 0,
        }
    }

    /// Returns the column and row of a pixel of the stream: of the frame if it comes in row-major
    /// order, or else of a region.
    fn pixel_position(&self, number: u64) -> (i64, i64) {
        let signed = |value: u64| i64::try_from(value).expect("a place in a frame");
        let in_region = |design: &Design| {
            let (width, halo) = (u64::from(design.stream_side()), i64::from(design.halo()));
            // The slots of a lane follow each other.
            let in_slot = number % (width * width);
            (signed(in_slot % width) - halo, signed(in_slot / width) - halo)
        };
        match self {
            Self::Regions(design) => in_region(design),
            Self::Lanes(array, _) => match array.feed() {
                PixelFeed::Parallel => in_region(array),
                PixelFeed::Raster => {
                    let width = u64::from(array.columns() * array.region_size());
                    (signed(number % width), signed(number / width))
                }
            },
            Self::Words(timing) => {
                let (row, word) = (u64::from(timing.taken_words), u64::from(timing.word_pixels));
                (signed(number % row * word), signed(number / row))
            }
        }
    }
}

/// A state machine that follows a sequence clock by clock.
pub(crate) struct ActivityTracker<'a> {
    intake: FrameInput<'a>,
    /// The number of pixels or words of a frame.
    units_per_frame: u64,
    /// The number of clocks for which the last pixel of a frame continues to enter.
    last_pixel_clocks: u64,
    /// The number of pixels or words of this frame that have come in; `frames` is the number of
    /// whole frames.
    taken: u64,
    frames: u64,
    /// The number of clocks since the last pixel of a serial frame came in, while the lanes work on
    /// it.
    clocks_since_frame: Option<u64>,
    /// True if a pixel is taken at the next edge.
    is_ready: bool,
    /// The frame synchronization, if it is simulated.
    sync: Option<FrameSync>,
    /// The number of clocks until a core that completes a frame takes the next pixel.
    clocks_until_next: u64,
}

impl<'a> ActivityTracker<'a> {
    fn new(design: &'a Design, sync: Option<FrameSync>) -> Self {
        let intake = FrameInput::for_design(design);
        let pixels = design.timing().pixels_per_frame();
        let lag = match &intake {
            FrameInput::Lanes(..) => {
                intake.pause_after(pixels - 1, intake.pixel_position(pixels - 1))
            }
            FrameInput::Regions(_) | FrameInput::Words(_) => 0,
        };
        let (taken, frames, since, is_ready, busy) = (0, 0, None, true, 0);
        Self {
            intake,
            units_per_frame: pixels,
            last_pixel_clocks: lag,
            taken,
            frames,
            clocks_since_frame: since,
            is_ready,
            sync,
            clocks_until_next: busy,
        }
    }

    /// Advances by one clock, with its inputs and with the readiness of the array after it.
    fn step(&mut self, reset: bool, (valid, sof): (bool, bool), ready_after: bool) -> CoreActivity {
        let was_ready = std::mem::replace(&mut self.is_ready, ready_after);
        if reset {
            (self.taken, self.frames, self.clocks_since_frame, self.clocks_until_next) =
                (0, 0, None, 0);
            if let Some(sync) = &mut self.sync {
                sync.reset();
            }
            return CoreActivity::Reset;
        }
        if let (Some(timing), Some(since)) =
            (self.intake.lane_timing(), &mut self.clocks_since_frame)
        {
            *since += 1;
            let first = self.last_pixel_clocks + timing.edges_to_step(0);
            let step = since.saturating_sub(first);
            if step < timing.steps() {
                return work(timing, self.frames - 1, step);
            }
            self.clocks_since_frame = None;
        }
        let (frame, of) = (self.frames, self.units_per_frame);
        let unit = self.intake.unit_name();
        let completes = self.sync.as_ref().is_some_and(FrameSync::is_filling);
        let is_open = if completes { self.clocks_until_next == 0 } else { was_ready };
        self.clocks_until_next = self.clocks_until_next.saturating_sub(1);
        let is_taken = match &mut self.sync {
            Some(sync) => sync.step(valid, sof, is_open),
            None => valid && is_open,
        };
        if completes && !is_taken {
            return CoreActivity::Completing { unit, frame, taken: self.taken, of };
        }
        if !is_taken {
            return CoreActivity::Waiting { unit, frame, taken: self.taken, of };
        }
        let number = self.taken;
        self.taken += 1;
        if self.taken == self.units_per_frame {
            (self.taken, self.frames) = (0, self.frames + 1);
            self.clocks_since_frame = self.intake.lane_timing().map(|_| 0);
        }
        let (x, y) = self.intake.pixel_position(number);
        if completes {
            self.clocks_until_next = self.intake.pause_after(number, (x, y));
            return CoreActivity::Completing { unit, frame, taken: number + 1, of };
        }
        CoreActivity::Pixel { unit, frame, number, of, x, y }
    }
}

/// Returns the phase of a step of a frame.
fn work(timing: &SerialTiming, frame: u64, step: u64) -> CoreActivity {
    let (slot, mut left) = (step / timing.slot_steps(), step % timing.slot_steps());
    for &(phase, of) in timing.phases() {
        if left < of {
            return CoreActivity::Work { frame, slot, phase, step: left, of };
        }
        left -= of;
    }
    unreachable!("the phases of a slot take {} steps", timing.slot_steps())
}

/// Returns the activity of the hardware at each of these clocks, which are in order and of one
/// sequence.
///
/// # Errors
/// Fails if the vectors cannot be read.
pub(crate) fn core_activities(
    design: &Design,
    recording: &Recording,
    clocks: &[u64],
) -> Result<Vec<CoreActivity>, CosimError> {
    let (Some(&first), Some(&last)) = (clocks.first(), clocks.last()) else {
        return Ok(Vec::new());
    };
    let start = recording.sequence(first).start;
    let (inputs, outputs) = (recording.inputs(), recording.outputs());
    let (reset, valid) =
        (field_of_role(inputs, PortRole::Reset), field_of_role(inputs, PortRole::Valid));
    let (ready, sof) =
        (field_of_role(outputs, PortRole::Ready), field_of_role(inputs, PortRole::StartOfFrame));
    let says =
        |field: Option<&RecordField>, record: &[u8]| field.is_some_and(|f| f.get(record, 0) == 1);
    let mut follower = ActivityTracker::new(design, sof.map(|_| FrameSync::new(design)));
    let (mut moments, mut wanted) = (Vec::new(), clocks.iter().peekable());
    recording.for_each_clock(start..last + 1, |clock, input, expected| {
        // Without such a port every pixel is taken.
        let ready_after = ready.is_none() || says(ready, expected);
        let comes = (says(valid, input), says(sof, input));
        let moment = follower.step(says(reset, input), comes, ready_after);
        while wanted.next_if(|&&wanted| wanted == clock).is_some() {
            moments.push(moment);
        }
    })?;
    Ok(moments)
}

fn field_of_role(layout: &RecordLayout, role: PortRole) -> Option<&RecordField> {
    layout.fields().iter().find(|field| field.port.role == role)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::level::CosimLevel;
    use crate::stimulus::Stimulus;
    use foveate_design::DesignConfig;

    /// Calls `see` for every clock of a recording with its moment and expected outputs, sequence
    /// after sequence. Returns the number of clocks.
    fn for_each_activity(
        toml: &str,
        level: CosimLevel,
        mut see: impl FnMut(&RecordLayout, CoreActivity, &[u8]),
    ) -> u64 {
        let design = DesignConfig::from_toml(toml).unwrap().validate().unwrap();
        let stimulus = Stimulus { level, rounds: 1, ..Stimulus::default() };
        let recording = stimulus.record(&design, &mut |_, _| {}).unwrap();
        let simulated = level.design(&design).unwrap();
        let mut clock = 0;
        while clock < recording.clocks() {
            let sequence = recording.sequence(clock);
            let clocks: Vec<u64> = sequence.clone().collect();
            let mut moments = core_activities(&simulated, &recording, &clocks).unwrap().into_iter();
            recording
                .for_each_clock(sequence.clone(), |_, _, expected| {
                    see(recording.outputs(), moments.next().unwrap(), expected);
                })
                .unwrap();
            clock = sequence.end;
        }
        recording.clocks()
    }

    /// The model shows scores and pixels in their own phases, and in no other.
    #[test]
    fn phases_are_those_in_which_the_model_shows_something() {
        let base = "[frame]\nwidth = 12\nheight = 8\n[region]\nsize = 4\n[[spatial]]\n\
                    feature = \"edge\"\n[[spatial]]\nfeature = \"mad\"\n[hardware]\n\
                    organization = \"serial\"\n";
        for more in ["", "fold = 4\n", "fold = 2\nfeed = \"raster\"\n"] {
            for neighborhood in ["isolated", "shared"] {
                let toml = base.replace(
                    "size = 4\n",
                    &format!("size = 4\nneighborhood = \"{neighborhood}\"\n"),
                );
                let (mut scores, mut pixels) = (0, 0);
                for_each_activity(
                    &format!("{toml}{more}"),
                    CosimLevel::Full,
                    |layout, moment, expected| {
                        let says = |role| field_of_role(layout, role).unwrap().get(expected, 0);
                        if says(PortRole::ScoreValid) == 1 {
                            let names = ["temporal count", "edge", "mad"];
                            let index = usize::try_from(says(PortRole::ScoreIndex)).unwrap();
                            assert_eq!(moment.score(), Some(names[index]), "{moment}");
                            scores += 1;
                        }
                        let valid = field_of_role(layout, PortRole::ForwardValid).unwrap();
                        if valid.bytes_in(expected).iter().any(|&byte| byte != 0) {
                            let unload = matches!(
                                moment,
                                CoreActivity::Work { phase: SerialPhase::UnloadPixels, .. }
                            );
                            assert!(unload, "{moment}");
                            pixels += 1;
                        }
                    },
                );
                assert!(scores > 100 && pixels > 100, "{scores} {pixels}");
            }
        }
    }

    /// The halo of a region is counted, and a decision of a pipelined core comes after the last
    /// pixel of a frame.
    #[test]
    fn pixels_are_counted_with_their_halo() {
        let toml = "[region]\nsize = 4\nneighborhood = \"shared\"\n[denoise]\nfilter = \"none\"\n";
        let design = DesignConfig::from_toml(toml).unwrap().validate().unwrap();
        let last = u64::from(design.stream_pixels()) - 1;
        let (mut corners, mut decisions, mut open) = (0, 0, 0);
        for_each_activity(toml, CosimLevel::Rpu, |layout, moment, expected| {
            match moment {
                CoreActivity::Reset => open = 0,
                CoreActivity::Pixel { number: 0, x, y, .. } => {
                    assert_eq!((x, y), (-1, -1));
                    corners += 1;
                }
                CoreActivity::Pixel { number, x, y, .. } if number == last => {
                    assert_eq!((x, y), (4, 4));
                    open += 1;
                }
                _ => {}
            }
            if field_of_role(layout, PortRole::DecisionValid).unwrap().get(expected, 0) == 1 {
                assert!(open > 0, "a decision without a whole frame");
                open -= 1;
                decisions += 1;
            }
        });
        assert!(corners > 20 && decisions > 20, "{corners} {decisions}");
    }

    /// A frame of 31x7 pixels in words of two has rows of 16 words, and its last decision comes
    /// after its last word.
    #[test]
    fn the_words_of_a_raster_core_are_counted() {
        let toml = "[frame]\nwidth = 31\nheight = 7\n[region]\nsize = 4\n[hardware]\n\
                    organization = \"raster\"\npixels_per_clock = 2\n";
        for more in ["", "store = \"external\"\nforward = false\n"] {
            words_are_counted(&format!("{toml}{more}"));
        }
    }

    fn words_are_counted(toml: &str) {
        let last =
            CoreActivity::Pixel { unit: "word", frame: 0, number: 111, of: 112, x: 30, y: 6 };
        assert_eq!(last.to_string(), "word 111 of 112 (x 30, y 6) of frame 0 enters");
        let (mut frames, mut decisions) = (0, 0);
        for_each_activity(toml, CosimLevel::Full, |layout, moment, expected| {
            match moment {
                CoreActivity::Pixel { unit, number: 18, of, x, y, .. } => {
                    assert_eq!((unit, of, x, y), ("word", 112, 4, 1), "{moment}");
                    frames += 1;
                }
                CoreActivity::Pixel { number: 111, x, y, .. } => assert_eq!((x, y), (30, 6)),
                CoreActivity::Work { .. } => panic!("{moment}"),
                _ => {}
            }
            let says = |role| field_of_role(layout, role).unwrap().get(expected, 0);
            if says(PortRole::DecisionValid) == 1 && says(PortRole::Region) == 15 {
                assert!(
                    matches!(moment, CoreActivity::Waiting { taken: 0, of: 112, .. }),
                    "{moment}"
                );
                decisions += 1;
            }
        });
        assert!(frames > 20 && decisions > 20, "{frames} {decisions}");
    }
}
