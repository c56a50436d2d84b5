// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames of a run in memory, because tuning runs the network on them many times.

use crate::InferenceError;
use crate::camera::{Kept, Seen};
use crate::clips::Audience;

/// The most bytes of frames that are kept in memory.
const MAX_BYTES: usize = 4 << 30;

#[derive(Debug, Default)]
pub(crate) struct Album {
    clips: Vec<Filmed>,
    bytes: usize,
    frames: usize,
}

/// A clip or data set whose frames are kept.
#[derive(Debug)]
struct Filmed {
    name: String,
    black: Option<Vec<f32>>,
    frames: Vec<Kept>,
    /// The reason for missing frames, if some are missing.
    problem: Option<String>,
}

impl Filmed {
    fn part<'a>(&'a self, frames: &'a [Kept]) -> Part<'a> {
        Part { clip: &self.name, black: self.black.as_deref(), frames }
    }
}

/// Consecutive frames of one clip, or some frames of a data set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a> {
    pub(crate) clip: &'a str,
    /// The network's input for a black screen, from which every frame of a data set starts; `None`
    /// for a clip.
    pub(crate) black: Option<&'a [f32]>,
    pub(crate) frames: &'a [Kept],
}

impl Part<'_> {
    /// Returns the number of counted frames: all frames of a data set, and all frames of a clip but
    /// the first.
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

    /// Returns the names of clips with missing frames, each with the reason.
    pub(crate) fn problems(&self) -> Vec<(String, String)> {
        let of = |clip: &Filmed| Some((clip.name.clone(), clip.problem.clone()?));
        self.clips.iter().filter_map(of).collect()
    }

    /// Returns the frames that a run over `clips` clips is tuned on: all clips that are kept. A
    /// single clip is split: its first half is tuned on, and its second half is returned to be
    /// reported.
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

    /// Returns both halves of the only clip, each with at least one counted frame.
    fn halves(&self) -> Result<[Part<'_>; 2], InferenceError> {
        let clip = self.clips.first().expect("a clip has begun");
        // The first frame of each half of a clip is not counted.
        let least = if clip.black.is_some() { 2 } else { 4 };
        if self.frames < least {
            return Err(InferenceError::TooShort { frames: self.frames, least });
        }
        let (first, second) = clip.frames.split_at(self.frames / 2);
        Ok([first, second].map(|frames| clip.part(frames)))
    }
}
