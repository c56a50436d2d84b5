// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stretches of a clip whose activity is measured: a quiet one, a usual one and the busiest
//! one.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use foveate_design::Design;
use foveate_engine::Engine;
use foveate_estimate::count_to_f64;
use foveate_media::{ClipPlayer, FrameDepths, PlaybackError, PlayedFrame, RunClips, SourceKind};
use foveate_pixels::Frame;

use crate::energy::error::EnergyError;

/// The frames before a stretch, after which an RPU has a reference and no longer sends the first
/// frame.
pub(crate) const FRAMES_BEFORE: u64 = 2;
/// The frames behind a stretch. A lane works on a frame while it takes the next one, so the clocks
/// of the last frame end with the first of them.
pub(crate) const FRAMES_BEHIND: u64 = 2;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ClipStretch {
    pub(crate) name: &'static str,
    /// The number of its first frame.
    pub(crate) first: u64,
    pub(crate) frames: u64,
    /// The share of regions that are sent.
    pub(crate) sent_share: f64,
}

impl ClipStretch {
    /// Returns the numbers of the frames that are simulated.
    pub(crate) fn simulated(&self) -> Range<u64> {
        self.first - FRAMES_BEFORE..self.first + self.frames + FRAMES_BEHIND
    }
}

/// Frames of a clip that give a design its activity.
#[derive(Clone, Debug)]
pub struct ActivityClip<'a> {
    /// The clips of the run.
    pub clips: &'a RunClips,
    /// The number of the clip among them.
    pub clip: usize,
    /// The numbers of the frames whose activity counts. The camera sees the frames before them,
    /// too.
    pub frames: Range<u64>,
}

impl ActivityClip<'_> {
    /// The least number of frames whose activity counts.
    pub const MIN_FRAMES: u64 = FRAMES_BEFORE + 1 + FRAMES_BEHIND;

    /// Checks that the clip has an order in time and enough frames.
    ///
    /// # Errors
    /// Fails if the clip is a set of images, is too short, or cannot be read.
    pub fn check(&self) -> Result<(), EnergyError> {
        let Range { start, end } = self.frames;
        let mut found = 0;
        let needed = end.min(start.saturating_add(Self::MIN_FRAMES));
        self.play(needed, &AtomicBool::new(false), |played| {
            found += u64::from(self.frames.contains(&played.number));
            Ok(())
        })?;
        self.check_length(found)
    }

    fn check_length(&self, found: u64) -> Result<(), EnergyError> {
        let needed = Self::MIN_FRAMES;
        if found < needed {
            return Err(EnergyError::TooShort { clip: self.name().to_owned(), found, needed });
        }
        Ok(())
    }

    fn name(&self) -> &str {
        &self.clips.clips()[self.clip].name
    }

    fn play(
        &self,
        end: u64,
        cancel: &AtomicBool,
        mut take: impl FnMut(PlayedFrame) -> Result<(), EnergyError>,
    ) -> Result<(), EnergyError> {
        let mut player = self.open()?.limited_to(end);
        for played in player.by_ref() {
            if cancel.load(Ordering::Relaxed) {
                return Err(PlaybackError::Interrupted.into());
            }
            take(played?)?;
        }
        match player.problem() {
            None => Ok(()),
            Some(problem) => Err(EnergyError::IncompleteClip {
                clip: self.name().to_owned(),
                problem: problem.to_owned(),
            }),
        }
    }

    fn open(&self) -> Result<ClipPlayer, EnergyError> {
        let player = self.clips.open(self.clip)?;
        match player.kind() {
            SourceKind::Clip => Ok(player),
            SourceKind::Set => Err(EnergyError::NoClip { input: player.inputs().join(", ") }),
        }
    }

    /// Shows the clip to the camera of a design. Returns the number of frames whose activity
    /// counts, and the stretches to measure, of `length` frames or as many as there are.
    pub(crate) fn stretches(
        &self,
        design: &Design,
        length: u64,
        cancel: &AtomicBool,
    ) -> Result<(u64, Vec<ClipStretch>), EnergyError> {
        let mut engine = Engine::new(design.camera());
        let mut sent = Vec::new();
        self.play(self.frames.end, cancel, |played| {
            let frames = FrameDepths::from_frame(&played, [design.pixel_bits()])?;
            let outcome = frames.show_to(&mut engine)?;
            if self.frames.contains(&played.number) {
                sent.push(outcome.active.iter().filter(|active| **active).count() as u64);
            }
            Ok(())
        })?;
        self.check_length(sent.len() as u64)?;
        let mut stretches = choose_stretches(&sent, u64::from(design.regions()), length);
        stretches.iter_mut().for_each(|stretch| stretch.first += self.frames.start);
        Ok((sent.len() as u64, stretches))
    }

    pub(crate) fn read_stretches(
        &self,
        stretches: &[ClipStretch],
        pixel_bits: u32,
        cancel: &AtomicBool,
    ) -> Result<BTreeMap<u64, Frame>, EnergyError> {
        let is_wanted =
            |number| stretches.iter().any(|stretch| stretch.simulated().contains(&number));
        let last = stretches.iter().map(|stretch| stretch.simulated().end).max().unwrap_or(0);
        let mut frames = BTreeMap::new();
        self.play(last, cancel, |played| {
            if is_wanted(played.number) {
                let depths = FrameDepths::from_frame(&played, [pixel_bits])?;
                let frame = depths.frame_at(pixel_bits).to_frame().map_err(PlaybackError::from)?;
                frames.insert(played.number, frame);
            }
            Ok(())
        })?;
        Ok(frames)
    }
}

/// Chooses a quiet, a usual and the busiest stretch by the number of regions that each frame sent.
/// There are at least [`ActivityClip::MIN_FRAMES`] frames.
fn choose_stretches(sent: &[u64], regions: u64, length: u64) -> Vec<ClipStretch> {
    let found = sent.len() as u64;
    let frames = (found - FRAMES_BEFORE - FRAMES_BEHIND).min(length);
    let of_stretch = |first: u64| -> u64 {
        let of_frame = |frame: u64| usize::try_from(frame).ok().and_then(|frame| sent.get(frame));
        (first..first + frames).filter_map(of_frame).sum()
    };
    let mut firsts: Vec<u64> = (FRAMES_BEFORE..=found - FRAMES_BEHIND - frames).collect();
    firsts.sort_by_key(|&first| (of_stretch(first), first));
    let stretch = |name, first| {
        let sent_share = count_to_f64(of_stretch(first)) / count_to_f64(regions * frames);
        ClipStretch { name, first, frames, sent_share }
    };
    let (quiet, usual, busiest) = (firsts[0], firsts[firsts.len() / 2], firsts[firsts.len() - 1]);
    vec![stretch("quiet", quiet), stretch("usual", usual), stretch("busiest", busiest)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stretches_are_the_quietest_the_median_and_the_busiest() {
        let sent = [9, 9, 5, 5, 5, 5, 0, 0, 0, 0, 8, 8, 8, 8, 1];
        let stretches = choose_stretches(&sent, 10, 4);
        let found: Vec<_> =
            stretches.iter().map(|own| (own.name, own.first, own.frames, own.sent_share)).collect();
        assert_eq!(found, [("quiet", 6, 4, 0.0), ("usual", 3, 4, 0.375), ("busiest", 9, 4, 0.6)]);
        assert_eq!(stretches[2].simulated(), 7..15);
    }

    #[test]
    fn a_short_clip_has_short_stretches() {
        let stretches = choose_stretches(&[1, 1, 1, 1, 1], 10, 4);
        assert!(stretches.iter().all(|own| (own.first, own.frames) == (2, 1)));
    }
}
