// SPDX-License-Identifier: MIT OR Apache-2.0
//! A feed whose frames get their times from a file.

use std::path::Path;

use foveate_tools::Interrupt;

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
    problem: Option<String>,
}

impl TimestampedFeed {
    /// Gives a feed the times of a file.
    ///
    /// # Errors
    /// Fails if the feed has times of its own, if the file cannot be read, or if it has another
    /// number of times than the feed has frames.
    pub(crate) fn new(
        feed: Box<dyn FrameFeed>,
        file: TimestampsFile,
        interrupt: &Interrupt,
    ) -> Result<Self, FootageError> {
        if feed.kind() == SourceKind::Set {
            let problem = "the images of a set have no times; leave the option out".to_owned();
            return Err(FootageError::Option { option: "--timestamps", problem });
        }
        if !feed.takes_timestamps() {
            let problem = "it gives times to the frames of a clip of images or of raw video; leave it out for \
                           other inputs"
                .to_owned();
            return Err(FootageError::Option { option: "--timestamps", problem });
        }
        let entries = file.read(interrupt)?;
        let count = entries.len();
        match feed.total() {
            Some(total) if total != count as u64 => Err(file.refused(format!(
                "it has {count} times, but there are {total} frames; each frame needs a line"
            ))),
            _ => Ok(Self { feed, file, entries: entries.into_iter(), count, problem: None }),
        }
    }

    /// Ends a feed whose number of frames is not that of the times. The frames of a stream before
    /// it are kept.
    fn end_with(&mut self, problem: String) -> Result<Option<SourceFrame>, FootageError> {
        let error = self.file.refused(problem);
        if self.feed.is_stream() && self.entries.len() < self.count {
            self.problem = Some(error.to_string());
            return Ok(None);
        }
        Err(error)
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
        if self.problem.is_some() {
            return Ok(None);
        }
        let Some(frame) = self.feed.next()? else {
            let (left, count) = (self.entries.len(), self.count);
            if left > 0 && self.feed.problem().is_none() {
                let problem =
                    format!("it has {count} times, but there are {} frames", count - left);
                return self.end_with(problem);
            }
            return Ok(None);
        };
        let Some(entry) = self.entries.next() else {
            let count = self.count;
            self.feed.stop();
            return self.end_with(format!(
                "it has {count} times, but there are more frames; each frame needs a line"
            ));
        };
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
        self.problem.clone().or_else(|| self.feed.problem())
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
