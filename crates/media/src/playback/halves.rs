// SPDX-License-Identifier: MIT OR Apache-2.0
//! The end of the first half of every clip.

use crate::playback::{InputError, PlaybackError, RunClips, RunMonitor};

/// The halves of all clips.
#[derive(Clone, Debug, Default)]
pub struct ClipHalves {
    /// The number of frames of each clip's first half, and of the whole clip.
    pub frames: Vec<(u64, u64)>,
    /// The clips that ended early, with the reasons.
    pub problems: Vec<String>,
}

impl ClipHalves {
    /// Counts the frames of every clip by reading it, because a container may state a wrong number.
    /// Each clip needs `least` frames, and an entry in its boxes if there are any.
    ///
    /// # Errors
    /// Fails if a clip cannot be read or has too few frames, or if the run is to stop.
    pub fn count(
        clips: &RunClips,
        least: u64,
        monitor: &RunMonitor<'_>,
    ) -> Result<Self, PlaybackError> {
        let mut found = Self::default();
        for (number, clip) in clips.clips().iter().enumerate() {
            let mut player = clips.open(number)?;
            let (mut frames, mut has_entry) = (0, false);
            for frame in monitor.watch(&mut player) {
                has_entry |= clips.objects(number, &frame?)?.is_some();
                frames += 1;
            }
            if frames < least {
                let clip = clip.name.clone();
                return Err(InputError::TooFewFrames { clip, frames, least }.into());
            }
            clips.check_entries(number, has_entry)?;
            found.frames.push((frames / 2, frames));
            let problem = player.problem().map(|problem| format!("{}: {problem}", clip.name));
            found.problems.extend(problem);
        }
        Ok(found)
    }
}
