// SPDX-License-Identifier: MIT OR Apache-2.0
//! A feed whose frames get their times from a file.

use std::path::Path;

use super::feed::FrameFeed;
use super::set_form::SetForm;
use super::{SourceFrame, SourceKind};
use crate::timestamps::{TimestampEntry, TimestampsFile};
use crate::{FootageError, LumaRange};

/// A feed whose frames have the times of a file.
pub(crate) struct TimestampedFeed {
    feed: Box<dyn FrameFeed>,
    file: TimestampsFile,
    entries: std::vec::IntoIter<TimestampEntry>,
    count: usize,
}

impl TimestampedFeed {
    /// Gives a feed the times of a file.
    ///
    /// # Errors
    /// Fails if the feed has times of its own, if the file cannot be read, or if it has another number of times
    /// than the feed has frames.
    pub(crate) fn new(
        feed: Box<dyn FrameFeed>,
        file: TimestampsFile,
    ) -> Result<Self, FootageError> {
        if !feed.takes_timestamps() || feed.kind() == SourceKind::Set {
            let problem = "it gives times to the frames of a clip of images or of raw video; leave it out for \
                           other inputs"
                .to_owned();
            return Err(FootageError::Option { option: "--timestamps", problem });
        }
        let entries = file.read()?;
        let count = entries.len();
        match feed.total() {
            Some(total) if total != count as u64 => Err(file.refused(format!(
                "it has {count} times, but there are {total} frames; each frame needs a line"
            ))),
            _ => Ok(Self { feed, file, entries: entries.into_iter(), count }),
        }
    }

    fn too_many_frames_error(&self) -> FootageError {
        self.file.refused(format!(
            "it has {} times, but there are more frames; each frame needs a line",
            self.count
        ))
    }
}

/// Returns an error if an entry is for another file than that of a frame.
fn check_name(
    file: &TimestampsFile,
    entry: &TimestampEntry,
    frame: &SourceFrame,
) -> Result<(), FootageError> {
    let Some(name) = &entry.name else { return Ok(()) };
    let own = Path::new(&frame.name).file_name().map(|own| own.to_string_lossy().into_owned());
    if own.as_ref() == Some(name) {
        return Ok(());
    }
    Err(file.refused(format!(
        "line {} is for `{name}`, but the frame is `{}`; the lines must have the order of the frames",
        entry.line, frame.name
    )))
}

impl FrameFeed for TimestampedFeed {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        let Some(frame) = self.feed.next()? else { return Ok(None) };
        let Some(entry) = self.entries.next() else { return Err(self.too_many_frames_error()) };
        if self.feed.is_file_per_frame() {
            check_name(&self.file, &entry, &frame)?;
        }
        Ok(Some(SourceFrame { time_us: entry.time_us, ..frame }))
    }

    fn total(&self) -> Option<u64> {
        self.feed.total()
    }

    fn kind(&self) -> SourceKind {
        self.feed.kind()
    }

    fn form(&self) -> SetForm {
        self.feed.form()
    }

    fn luma(&self) -> Option<LumaRange> {
        self.feed.luma()
    }

    fn problem(&self) -> Option<String> {
        self.feed.problem()
    }

    fn recycle(&mut self, bytes: Vec<u8>) {
        self.feed.recycle(bytes);
    }

    fn stop(&mut self) {
        self.feed.stop();
    }

    fn is_file_per_frame(&self) -> bool {
        self.feed.is_file_per_frame()
    }

    fn is_stream(&self) -> bool {
        self.feed.is_stream()
    }
}
