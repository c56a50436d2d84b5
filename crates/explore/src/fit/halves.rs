// SPDX-License-Identifier: MIT OR Apache-2.0
//! The end of the first half of every clip.

use crate::ExploreError;
use crate::footage::ExplorationFootage;
use crate::{ExploreHooks, ExploreProgress};

/// The clips, and where they are divided.
#[derive(Clone, Debug, Default)]
pub(super) struct ClipHalves {
    /// The number of frames of each clip's first half, and of the whole clip.
    pub(super) frames: Vec<(u64, u64)>,
    /// The clips that ended early, with the reasons.
    pub(super) problems: Vec<String>,
}

/// The least number of frames of a clip: each half needs a first frame, and one that can change.
pub(super) const MIN_FRAMES: u64 = 4;

/// Counts the frames of every clip by reading it, because a container may state a wrong number.
/// Each clip needs `least` frames.
pub(super) fn count_halves(
    footage: &ExplorationFootage<'_>,
    least: u64,
    hooks: &dyn ExploreHooks,
) -> Result<ClipHalves, ExploreError> {
    let mut found = ClipHalves::default();
    let mut read = 0;
    for (clip, subject) in footage.subjects.iter().enumerate() {
        let mut source = footage.open(subject)?;
        let (mut frames, mut has_boxes) = (0, footage.boxes.is_empty());
        while let Some(frame) = source.next_frame()? {
            has_boxes |= footage.objects(clip, &frame, source.as_ref())?.is_some();
            source.recycle(frame);
            frames += 1;
            read += 1;
            hooks.progress(ExploreProgress::Reading { frames: read });
            if hooks.cancelled() {
                return Err(ExploreError::Cancelled);
            }
        }
        if frames < least {
            let clip = subject.name.clone();
            return Err(ExploreError::TooFewFrames { clip, frames, least });
        }
        if let Some(boxes) = footage.boxes.get(clip).filter(|_| !has_boxes) {
            return Err(boxes.no_entry_error(&subject.name).into());
        }
        found.frames.push((frames / 2, frames));
        let problem = source.problem().map(|problem| format!("{}: {problem}", subject.name));
        found.problems.extend(problem);
    }
    Ok(found)
}
