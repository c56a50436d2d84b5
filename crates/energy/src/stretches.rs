// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stretches of a clip whose activity is measured: a quiet one, a usual one and the busiest one.

use std::collections::BTreeMap;
use std::path::Path;

use foveate_design::{Design, DesignConfig};
use foveate_engine::Engine;
use foveate_estimate::count_to_f64;
use foveate_footage::{InputOptions, SourceKind};
use foveate_frame::Frame;
use foveate_playback::{ClipReading, PlaybackError, RunClips};

use crate::error::EnergyError;

/// The frames before a stretch, after which an RPU has a reference and no longer sends the first frame.
pub(crate) const FRAMES_BEFORE: u64 = 2;
/// The frames behind a stretch. A lane works on a frame while it takes the next one, so the clocks of the
/// last frame end with the first of them.
pub(crate) const FRAMES_BEHIND: u64 = 2;

/// A stretch of a clip.
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
    pub(crate) fn simulated(&self) -> std::ops::Range<u64> {
        self.first - FRAMES_BEFORE..self.first + self.frames + FRAMES_BEHIND
    }
}

/// A clip that is played to a design.
pub(crate) struct PlayedClip {
    clips: RunClips,
    /// The design in the size of the clip.
    pub(crate) design: Design,
}

impl PlayedClip {
    /// Opens a clip for a design of its size.
    pub(crate) fn open(
        input: &Path,
        config: &DesignConfig,
        options: &InputOptions,
    ) -> Result<Self, EnergyError> {
        let clips = RunClips::new(&[input.to_owned()], &[], &config.camera, options)?;
        if clips.clips().len() > 1 {
            return Err(EnergyError::SeveralClips { input: clips.inputs().join(", ") });
        }
        let (width, height) = clips.common_format(ClipReading::Repeated)?.size;
        let design = config.validate_for_frames(width, height)?;
        Ok(Self { clips, design })
    }

    /// Plays the clip to a camera. Returns the number of its frames and the stretches to measure, of
    /// `length` frames or as many as the clip has.
    pub(crate) fn stretches(&self, length: u64) -> Result<(u64, Vec<ClipStretch>), EnergyError> {
        let mut engine = Engine::new(self.design.camera());
        let mut sent = Vec::new();
        let player = self.clips.open(0)?;
        if player.kind() == SourceKind::Set {
            return Err(EnergyError::NoClip { input: player.inputs().join(", ") });
        }
        for played in player {
            let outcome = played?.show_to(&mut engine)?;
            sent.push(outcome.active.iter().filter(|active| **active).count() as u64);
        }
        let stretches = choose_stretches(&sent, u64::from(self.design.regions()), length)?;
        Ok((sent.len() as u64, stretches))
    }

    /// Reads the frames of all stretches.
    pub(crate) fn frames(
        &self,
        stretches: &[ClipStretch],
    ) -> Result<BTreeMap<u64, Frame>, EnergyError> {
        let is_wanted =
            |number| stretches.iter().any(|stretch| stretch.simulated().contains(&number));
        let last = stretches.iter().map(|stretch| stretch.simulated().end).max().unwrap_or(0);
        let mut frames = BTreeMap::new();
        for played in self.clips.open(0)?.limited_to(last) {
            let played = played?;
            if is_wanted(played.number) {
                frames.insert(played.number, played.frame.to_frame().map_err(PlaybackError::from)?);
            }
        }
        Ok(frames)
    }
}

/// Chooses a quiet, a usual and the busiest stretch by the number of regions that each frame sent.
fn choose_stretches(
    sent: &[u64],
    regions: u64,
    length: u64,
) -> Result<Vec<ClipStretch>, EnergyError> {
    let found = sent.len() as u64;
    let around = FRAMES_BEFORE + FRAMES_BEHIND;
    let frames = found.saturating_sub(around).min(length);
    if frames == 0 {
        return Err(EnergyError::TooShort { found, needed: around + 1 });
    }
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
    Ok(vec![stretch("quiet", quiet), stretch("usual", usual), stretch("busiest", busiest)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stretches_are_the_quietest_the_median_and_the_busiest() {
        let sent = [9, 9, 5, 5, 5, 5, 0, 0, 0, 0, 8, 8, 8, 8, 1];
        let stretches = choose_stretches(&sent, 10, 4).unwrap();
        let found: Vec<_> =
            stretches.iter().map(|own| (own.name, own.first, own.frames, own.sent_share)).collect();
        assert_eq!(found, [("quiet", 6, 4, 0.0), ("usual", 3, 4, 0.375), ("busiest", 9, 4, 0.6)]);
        assert_eq!(stretches[2].simulated(), 7..15);
    }

    #[test]
    fn a_short_clip_has_short_stretches() {
        let stretches = choose_stretches(&[1, 1, 1, 1, 1], 10, 4).unwrap();
        assert!(stretches.iter().all(|own| (own.first, own.frames) == (2, 1)));
        let error = choose_stretches(&[1, 1, 1, 1], 10, 4).unwrap_err().to_string();
        assert!(error.contains("has 4 frames") && error.contains("at least 5"), "{error}");
    }
}
