// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames of a run in memory, because tuning sees them many times.

use crate::InferenceError;
use crate::camera::{Kept, Seen};
use crate::clips::Audience;

/// Bytes of pictures that are kept.
const MAX_BYTES: usize = 4 << 30;

#[derive(Debug, Default)]
pub(crate) struct Album {
    clips: Vec<Filmed>,
    bytes: usize,
    frames: usize,
}

/// A clip or set.
#[derive(Debug)]
struct Filmed {
    name: String,
    black: Option<Vec<f32>>,
    frames: Vec<Kept>,
    /// Why frames are missing, if some are.
    problem: Option<String>,
}

impl Filmed {
    fn part<'a>(&'a self, frames: &'a [Kept]) -> Part<'a> {
        Part { clip: &self.name, black: self.black.as_deref(), frames }
    }
}

/// Frames of one clip that follow each other, or some of a set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a> {
    pub(crate) clip: &'a str,
    /// The picture before every image of a set.
    pub(crate) black: Option<&'a [f32]>,
    pub(crate) frames: &'a [Kept],
}

impl Part<'_> {
    /// Frames that count: all of a set, of a clip all but the first.
    fn counted(&self) -> usize {
        if self.black.is_some() { self.frames.len() } else { self.frames.len().saturating_sub(1) }
    }
}

impl Audience for Album {
    fn begin(&mut self, clip: &str, black: Option<&[f32]>) {
        let (name, black) = (clip.to_owned(), black.map(<[f32]>::to_vec));
        self.clips.push(Filmed { name, black, frames: Vec::new(), problem: None });
    }

    fn look(&mut self, seen: Seen<'_>) -> Result<(), InferenceError> {
        self.bytes += seen.bytes();
        if self.bytes > MAX_BYTES {
            return Err(InferenceError::TooLong { frames: self.frames });
        }
        self.frames += 1;
        self.clips.last_mut().expect("a clip has begun").frames.push(Kept::of(seen));
        Ok(())
    }

    fn end(&mut self, problem: Option<String>) {
        self.clips.last_mut().expect("a clip has begun").problem = problem;
    }
}

impl Album {
    pub(crate) fn frames(&self) -> u64 {
        self.frames as u64
    }

    /// Why frames of clips are missing, where some are.
    pub(crate) fn problems(&self) -> Vec<(String, String)> {
        let of = |clip: &Filmed| Some((clip.name.clone(), clip.problem.clone()?));
        self.clips.iter().filter_map(of).collect()
    }

    /// What a run of so many clips is tuned on: every clip that is here. Of the only clip it is the first half of the frames, and the second
    /// half is what is left.
    pub(crate) fn parts(
        &self,
        clips: usize,
    ) -> Result<(Vec<Part<'_>>, Option<Part<'_>>), InferenceError> {
        if clips == 1 {
            let [first, second] = self.halves()?;
            return Ok((vec![first], Some(second)));
        }
        let parts: Vec<_> = self.clips.iter().map(|clip| clip.part(&clip.frames)).collect();
        if parts.iter().all(|part| part.counted() == 0) {
            return Err(InferenceError::NothingCounts { clips: "clips that it tunes on" });
        }
        Ok((parts, None))
    }

    /// Both halves of the only clip, each with at least one frame that counts.
    fn halves(&self) -> Result<[Part<'_>; 2], InferenceError> {
        let clip = self.clips.first().expect("a clip has begun");
        // The first frame of each half of a clip does not count.
        let least = if clip.black.is_some() { 2 } else { 4 };
        if self.frames < least {
            return Err(InferenceError::TooShort { frames: self.frames, least });
        }
        let (first, second) = clip.frames.split_at(self.frames / 2);
        Ok([first, second].map(|frames| clip.part(frames)))
    }
}
