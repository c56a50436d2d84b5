// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors for a design: the inputs of the hardware, and the outputs that the model expects.
//!
//! A recording is a list of *sequences*, each begun by a reset. Directed sequences of
//! [`stimulus_pattern`]s come first, with thresholds that meet the data exactly
//! ([`threshold_ranges`]) and pixels with and without gaps, then the frames of the caller. A
//! sequence ends when everything has left, within a frame or within a flush, so that each reset
//! finds the core in another state. The vectors follow from the design, the seed and the frames
//! alone.
//!
//! A [`ModelDriver`] drives the ports of the model for every user: for a recording, for the benches
//! that ship with a core ([`crate::shipped_bench`]) and for its timing diagram. The users differ in
//! the frames that they choose and in the [`ClockReceiver`] that takes the clocks. The benches, and
//! the traffic of a core on AXI ([`crate::bus`]), draw their frames with the same patterns.

mod frame_feed;
mod frame_generator;
mod model_driver;
mod pattern_scorer;
mod port_thresholds;
mod port_zones;
mod random;
mod sequence_end;
mod sequences;
mod session;
mod sink;
mod stimulus_pattern;
mod threshold_ranges;
mod unit_frames;
mod unused_inputs;

use crate::error::CosimError;
use crate::level::CosimLevel;
use crate::recording::{Recorder, Recording};
use foveate_design::Design;
use foveate_pixels::Frame;
pub(crate) use frame_feed::{FrameDelivery, FrameFeed, GapPattern};
pub(crate) use frame_generator::{FrameGenerator, PatternAim};
pub(crate) use model_driver::{ClockReceiver, FrameLimit, ModelDriver, SequenceSurroundings};
pub(crate) use pattern_scorer::PatternScores;
pub(crate) use port_zones::ClassChoice;
pub(crate) use random::Random;
pub(crate) use sequence_end::SequenceEnd;
use session::{SequenceLimits, StimulusPace, StimulusPlan, StimulusSession};
pub(crate) use sink::{SinkPattern, StoreFault};
use std::sync::atomic::AtomicBool;
pub(crate) use stimulus_pattern::{PatternGenerator, StimulusPattern, Texture};
pub(crate) use threshold_ranges::{ThresholdAim, ThresholdAimer, ThresholdRanges};
pub use unit_frames::UnitFrames;
pub(crate) use unused_inputs::UnusedInputs;

/// The largest number of regions of an array. Each is an RPU of the model, with buffers of its own.
const MAX_REGIONS: u64 = 1 << 16;
/// The largest number of pixels that all regions of an array take per frame. The model keeps
/// several frames of them, and some kilobytes per region: at these limits it takes some gigabytes.
const MAX_PIXELS: u64 = 1 << 26;

/// The settings from which vectors are made.
#[derive(Clone, Debug)]
pub struct Stimulus {
    /// The part of the hardware that the vectors are for.
    pub level: CosimLevel,
    /// The seed of all random data; equal seeds give equal vectors.
    pub seed: u64,
    /// The number of times that the directed sequences are played, each time with other data and
    /// gaps. With 0 only the frames are played.
    pub rounds: u32,
    /// The frames of the caller, of the size and depth of the design.
    pub frames: Vec<Frame>,
    /// The number of clocks in a round that are enough, or `None` for all. If all directed
    /// sequences take more, about as many of them are recorded as fit into this number, but always
    /// the first three, which are the most telling.
    pub sufficient_clocks: Option<u64>,
}

/// The number of directed sequences that every round has: extremes, a reset in a frame, and the
/// third of the organization.
const MIN_SEQUENCES: usize = 3;
/// The approximate length of a directed sequence, in frame times: some frames, with gaps.
const FRAMES_OF_A_SEQUENCE: u64 = 6;

impl Default for Stimulus {
    fn default() -> Self {
        Self {
            level: CosimLevel::Rpu,
            seed: 1,
            rounds: 3,
            frames: Vec::new(),
            sufficient_clocks: None,
        }
    }
}

impl Stimulus {
    /// Runs the model and records its inputs and outputs. `progress` is called with the number of
    /// finished sequences and the number of all sequences.
    ///
    /// # Errors
    /// Fails if a frame has another size or depth than the design, the array is too large, or there
    /// is no room for the files.
    pub fn record(
        &self,
        design: &Design,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Recording, CosimError> {
        self.record_until(design, &AtomicBool::new(false), progress)
    }

    /// Records like [`Stimulus::record`], but stops with an error as soon as `cancel` is set.
    ///
    /// # Errors
    /// Fails like [`Stimulus::record`], and with an error for which [`CosimError::is_interrupted`]
    /// is true if it was cancelled.
    pub fn record_until(
        &self,
        design: &Design,
        cancel: &AtomicBool,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Recording, CosimError> {
        self.record_without_sequences(design, |_| false, cancel, progress)
    }

    /// Records without the directed sequences for whose names `is_left_out` returns true. Tests use
    /// it to show that the situations of these sequences are then missing.
    fn record_without_sequences(
        &self,
        design: &Design,
        is_left_out: fn(&str) -> bool,
        cancel: &AtomicBool,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Recording, CosimError> {
        if self.rounds == 0 && self.frames.is_empty() {
            return Err(CosimError::NothingToSimulate);
        }
        check_frames(&self.frames, design)?;
        let simulated = self.level.design(design)?;
        self.check_size(&simulated)?;
        let mut recorder = Recorder::new(&self.level.top().ports(&simulated))?;
        if self.rounds > 0 {
            recorder.count_situations(&simulated, self.level.top());
        }
        let plan = StimulusPlan {
            seed: self.seed,
            limits: self.limits(&simulated),
            is_left_out,
            pace: StimulusPace::Varied,
        };
        StimulusSession::new((design, &simulated), self.level, plan, &mut recorder, cancel)
            .run(&self.frames, progress)?;
        recorder.finish()
    }

    fn limits(&self, simulated: &Design) -> SequenceLimits {
        let sequence = FRAMES_OF_A_SEQUENCE * simulated.timing().clocks_per_frame().max(1);
        let fit = |clocks: u64| usize::try_from(clocks / sequence).unwrap_or(usize::MAX);
        let most =
            self.sufficient_clocks.map_or(usize::MAX, |clocks| fit(clocks).max(MIN_SEQUENCES));
        SequenceLimits { rounds: self.rounds, max_sequences: most }
    }

    /// Refuses an array that would not fit into memory, before any part of it is made.
    fn check_size(&self, design: &Design) -> Result<(), CosimError> {
        let regions = u64::from(match self.level {
            CosimLevel::Rpu => design.unit().regions,
            CosimLevel::Rcm { .. } | CosimLevel::Full => design.regions(),
        });
        let pixels = regions * u64::from(design.stream_pixels());
        if regions > MAX_REGIONS || pixels > MAX_PIXELS {
            return Err(CosimError::TooLarge {
                regions,
                pixels,
                max_regions: MAX_REGIONS,
                max_pixels: MAX_PIXELS,
            });
        }
        Ok(())
    }
}

/// Refuses frames of another size or depth than the design.
fn check_frames(frames: &[Frame], design: &Design) -> Result<(), CosimError> {
    let kind = |width, height, bits| format!("{width}x{height} pixels of {bits} bits");
    let wanted = kind(design.width(), design.height(), design.pixel_bits());
    for (index, frame) in frames.iter().enumerate() {
        let found = kind(frame.width(), frame.height(), frame.bits());
        if found != wanted {
            return Err(CosimError::FrameShape { index, found, wanted });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::DesignConfig;

    /// Returns the situations that do not occur in a recording without some sequences.
    fn missing(toml: &str, is_left_out: fn(&str) -> bool) -> Vec<String> {
        let toml = format!("frame={{width=32,height=24}}\n{toml}");
        let design = DesignConfig::from_toml(&toml).unwrap().validate().unwrap();
        let stimulus = Stimulus { level: CosimLevel::Full, rounds: 1, ..Stimulus::default() };
        let cancel = AtomicBool::new(false);
        let found =
            stimulus.record_without_sequences(&design, is_left_out, &cancel, &mut |_, _| {});
        let found = found.unwrap();
        found.situations().missing().into_iter().map(str::to_owned).collect()
    }

    #[test]
    fn a_sequence_that_is_deleted_is_missed() {
        let means = "render.irrelevant='mean'\n";
        let pipelined = means.to_owned();
        let serial = format!("{means}hardware={{organization='serial',fold=2}}\n");
        let raster = format!("{means}hardware.organization='raster'\n");
        let again = "a reset comes while a summary is shown, and the same frame follows";
        for toml in [&pipelined, &serial, &raster] {
            let none = missing(toml, |_| false);
            assert!(none.is_empty(), "{toml}: {none:?}");
            let around =
                missing(toml, |name| name.contains("a reset") && name.starts_with("means"));
            assert!(around.iter().any(|name| name == again), "{toml}: {around:?}");
            let all = missing(toml, |name| name.contains("means"));
            assert!(all.iter().any(|name| name == again), "{toml}: {all:?}");
        }
        let alone = missing(&raster, |name| name != "extremes");
        for name in ["a region is lost in the middle", "a mean waits for the sink"] {
            assert!(alone.iter().any(|missing| missing == name), "{name}: {alone:?}");
        }
    }
}
