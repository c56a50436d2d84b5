// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors for a design: what goes into the hardware, with what the model says comes out.
//!
//! A recording is a row of *sequences*, each begun by a reset: directed ones from [`motif`]s, with
//! thresholds that hit the data exactly ([`aim`]) and pixels with and without gaps, then the frames
//! of the caller. Sequences end drained, in mid-frame or in mid-flush, so that each reset finds
//! something else under way. Everything follows from the design, the seed and the frames.

mod ahead;
mod aim;
mod brush;
mod damage;
mod driver;
mod feed;
mod gallery;
mod gauge;
mod manners;
mod memory;
mod motif;
mod pace;
mod parts;
mod queue;
mod random;
mod scout;
mod sequences;
mod session;
mod sink;
mod turns;

use crate::error::CosimError;
use crate::level::Level;
use crate::recording::{Recorder, Recording};
pub(crate) use feed::FrameFeed;
use foveate_design::Design;
use foveate_frame::Frame;
pub(crate) use motif::{Artist, Motif};
pub(crate) use pace::settling_clocks;
pub(crate) use queue::Queue;
pub(crate) use random::Random;
use session::Session;
pub(crate) use sink::ends_region;
use std::sync::atomic::AtomicBool;
use turns::Extent;

/// Regions of the largest array: each is an RPU of the model, with buffers of its own.
const MAX_REGIONS: u64 = 1 << 16;
/// Pixels that all regions of an array take in per frame. The model keeps several frames of them, and
/// some kilobytes per region: at these bounds the whole takes some gigabytes.
const MAX_PIXELS: u64 = 1 << 26;

/// What vectors are made from.
#[derive(Clone, Debug)]
pub struct Stimulus {
    /// How much of the hardware they are for.
    pub level: Level,
    /// Equal seeds give equal vectors.
    pub seed: u64,
    /// How often the directed sequences are run through, each time with other data and gaps;
    /// 0 leaves only the frames.
    pub rounds: u32,
    /// Frames of the caller, of the size and depth of the design.
    pub frames: Vec<Frame>,
    /// Clocks in a round that are enough: where all directed sequences take more, about as many of them
    /// are recorded as take so many, but always the first three, the most telling. Without it all are.
    pub enough: Option<u64>,
}

/// Directed sequences that every round has, from the first on: extremes, a reset in a frame, and what comes third.
const MOST_TELLING: usize = 3;
/// Frame times that a directed sequence takes: some frames, with gaps.
const FRAMES_OF_A_SEQUENCE: u64 = 6;

impl Default for Stimulus {
    fn default() -> Self {
        Self { level: Level::Rpu, seed: 1, rounds: 3, frames: Vec::new(), enough: None }
    }
}

impl Stimulus {
    /// Runs the model and records. `progress` hears how many sequences of how many are done.
    ///
    /// # Errors
    /// When a frame is not of the design's kind, the array is too large, or the files find no room.
    pub fn record(
        &self,
        design: &Design,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Recording, CosimError> {
        self.record_until(design, &AtomicBool::new(false), progress)
    }

    /// As [`Stimulus::record`], but stops with an error as soon as `cancel` is set.
    ///
    /// # Errors
    /// As [`Stimulus::record`], and one of which [`CosimError::is_interrupted`] is true.
    pub fn record_until(
        &self,
        design: &Design,
        cancel: &AtomicBool,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Recording, CosimError> {
        self.record_without(design, |_| false, cancel, progress)
    }

    /// The same without the directed sequences of some names: what such a recording lacks must be missed.
    fn record_without(
        &self,
        design: &Design,
        is_left_out: fn(&str) -> bool,
        cancel: &AtomicBool,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Recording, CosimError> {
        self.check(design)?;
        let simulated = self.level.design(design)?;
        self.check_size(&simulated)?;
        let mut recorder = Recorder::new(&self.level.top().ports(&simulated))?;
        if self.rounds > 0 {
            recorder.watch(&simulated, self.level.top());
        }
        let plan = (self.seed, self.extent(&simulated), is_left_out);
        Session::new((design, &simulated), self.level, plan, &mut recorder, cancel)
            .run(&self.frames, progress)?;
        recorder.finish()
    }

    fn extent(&self, simulated: &Design) -> Extent {
        let sequence = FRAMES_OF_A_SEQUENCE * simulated.timing().clocks_per_frame().max(1);
        let fit = |clocks: u64| usize::try_from(clocks / sequence).unwrap_or(usize::MAX);
        let most = self.enough.map_or(usize::MAX, |clocks| fit(clocks).max(MOST_TELLING));
        Extent { rounds: self.rounds, most }
    }

    /// Refuses an array that would not fit into memory, before any of it is made.
    fn check_size(&self, design: &Design) -> Result<(), CosimError> {
        let regions = u64::from(match self.level {
            Level::Rpu => design.unit().regions,
            Level::Rcm { .. } | Level::Full => design.regions(),
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

    /// What can be refused before anything is made.
    fn check(&self, design: &Design) -> Result<(), CosimError> {
        if self.rounds == 0 && self.frames.is_empty() {
            return Err(CosimError::Nothing);
        }
        let kind = |width, height, bits| format!("{width}x{height} pixels of {bits} bits");
        let wanted = kind(design.width(), design.height(), design.pixel_bits());
        for (index, frame) in self.frames.iter().enumerate() {
            let found = kind(frame.width(), frame.height(), frame.bits());
            if found != wanted {
                return Err(CosimError::FrameShape { index, found, wanted });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::Config;

    /// What is missing in a recording without sequences.
    fn missing(toml: &str, is_left_out: fn(&str) -> bool) -> Vec<String> {
        let toml = format!("frame={{width=32,height=24}}\n{toml}");
        let design = Config::from_toml(&toml).unwrap().validate().unwrap();
        let stimulus = Stimulus { level: Level::Full, rounds: 1, ..Stimulus::default() };
        let cancel = AtomicBool::new(false);
        let found = stimulus.record_without(&design, is_left_out, &cancel, &mut |_, _| {});
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
        let held = "a region is held while its summary is shown, and is irrelevant again";
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
        for name in [held, "a region is lost in the middle", "a mean waits for the sink"] {
            assert!(alone.iter().any(|missing| missing == name), "{name}: {alone:?}");
        }
    }
}
