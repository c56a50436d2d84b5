// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the first half of every clip ends.

use crate::ExploreError;
use crate::footage::Footage;
use crate::{Hooks, Progress};

/// Clips and where they are divided.
#[derive(Clone, Debug, Default)]
pub(super) struct Halves {
    /// For every clip the frames of its first half and all of its frames.
    pub(super) frames: Vec<(u64, u64)>,
    /// Clips that ended too early, and why.
    pub(super) problems: Vec<String>,
}

/// A frame to start with, and one that can change, in each half.
pub(super) const LEAST: u64 = 4;

/// Counts the frames of every clip, of which each needs `least`; what a container says may be wrong.
pub(super) fn halves(
    footage: &Footage<'_>,
    least: u64,
    hooks: &dyn Hooks,
) -> Result<Halves, ExploreError> {
    let mut found = Halves::default();
    let mut read = 0;
    for (clip, subject) in footage.subjects.iter().enumerate() {
        let mut source = footage.open(subject)?;
        let (mut frames, mut has_boxes) = (0, footage.boxes.is_empty());
        while let Some(frame) = source.next_frame()? {
            has_boxes |= footage.objects(clip, &frame, source.as_ref())?.is_some();
            source.give_back(frame);
            frames += 1;
            read += 1;
            hooks.progress(Progress::Reading { frames: read });
            if hooks.cancelled() {
                return Err(ExploreError::Cancelled);
            }
        }
        if frames < least {
            let clip = subject.name.clone();
            return Err(ExploreError::Short { clip, frames, least });
        }
        if let Some(boxes) = footage.boxes.get(clip).filter(|_| !has_boxes) {
            return Err(boxes.none_fit(&subject.name).into());
        }
        found.frames.push((frames / 2, frames));
        let problem = source.problem().map(|problem| format!("{}: {problem}", subject.name));
        found.problems.extend(problem);
    }
    Ok(found)
}
