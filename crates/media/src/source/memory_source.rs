// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames that are already in memory, as a source like any other.

use foveate_pixels::ByteFrame;

use super::feed::{AdjustedSource, FrameAdjustment, FrameFeed};
use super::timestamped_feed::TimestampedFeed;
use super::{FrameSource, SourceFrame, SourceKind};
use crate::{FootageError, FrameRate, ImageRelation, InputOptions};

/// A feed of frames in a given order.
struct MemoryFeed {
    name: String,
    frames: std::vec::IntoIter<ByteFrame>,
    total: u64,
    next: u64,
    rate: FrameRate,
    kind: SourceKind,
}

/// Makes a source of frames in memory. The same options apply as for files. `name` is their name in
/// results.
///
/// # Errors
/// Fails if there are no frames, or if an option does not apply to frames in memory.
pub fn source_from_memory(
    name: &str,
    frames: Vec<ByteFrame>,
    options: &InputOptions,
) -> Result<Box<dyn FrameSource>, FootageError> {
    let of_files = |option, what: &str| FootageError::Option {
        option,
        problem: format!("{what} are files, but `{name}` is not a file"),
    };
    let kind = match options.images {
        ImageRelation::Clip => SourceKind::Clip,
        ImageRelation::Set => SourceKind::Set,
        ImageRelation::CifarSheet => return Err(of_files("--images", "CIFAR sheets")),
    };
    if options.labels.is_some() {
        return Err(of_files("--labels", "labelled images"));
    }
    if options.raw.is_some() {
        return Err(of_files("--raw", "raw video"));
    }
    if options.bayer.is_some() {
        return Err(of_files("--bayer", "images of a mosaic"));
    }
    let feed: Box<dyn FrameFeed> = Box::new(MemoryFeed {
        name: name.to_owned(),
        total: frames.len() as u64,
        frames: frames.into_iter(),
        next: 0,
        rate: options.frame_rate,
        kind,
    });
    let feed = match &options.timestamps {
        Some(file) => Box::new(TimestampedFeed::new(feed, file.clone(), &options.interrupt)?),
        None => feed,
    };
    let names = vec![name.to_owned()];
    Ok(Box::new(AdjustedSource::new(names, feed, FrameAdjustment::from_options(options))?))
}

impl FrameFeed for MemoryFeed {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        let Some(frame) = self.frames.next() else { return Ok(None) };
        let name = format!("{}[{}]", self.name, self.next);
        let time_us = self.kind.time_us(self.rate, self.next);
        self.next += 1;
        Ok(Some(SourceFrame { name, time_us, label: None, frame }))
    }

    fn total(&self) -> Option<u64> {
        Some(self.total)
    }

    fn kind(&self) -> SourceKind {
        self.kind
    }

    fn takes_timestamps(&self) -> bool {
        true
    }
}
