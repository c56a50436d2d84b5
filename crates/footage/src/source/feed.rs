// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of all kinds of input, and the source that is made of it. Frames are selected by
//! their times, cropped, scaled, and checked to have one size, in the same way for every kind of
//! input.

use super::form::SetForm;
use super::resize;
use super::select::{Selection, Selector, Verdict};
use super::{Kind, Origin, Source, SourceFrame};
use crate::limits::Crop;
use crate::{FootageError, InputOptions};

/// A kind of input. It returns frames as they come, of any size.
pub(crate) trait Feed: Send {
    /// Returns the next frame, or `None` after the last.
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError>;

    /// Returns the number of all frames, if it is known.
    fn total(&self) -> Option<u64>;

    /// Returns the relation between the frames.
    fn kind(&self) -> Kind {
        Kind::Clip
    }

    /// Returns the kind of the files and of the labels of a set.
    fn form(&self) -> SetForm {
        SetForm::default()
    }

    /// After the last frame, returns the problem because of which the input ended too early.
    fn problem(&self) -> Option<String> {
        None
    }

    /// Takes back the memory of a frame that is no longer needed.
    fn give_back(&mut self, _bytes: Vec<u8>) {}

    /// Ends the input, since no more frames are needed.
    fn stop(&mut self) {}

    /// Returns true if every frame is a file with its own name.
    fn is_of_files(&self) -> bool {
        false
    }

    /// Returns true if the frames before a fault are worth keeping, as for a long recording.
    fn is_stream(&self) -> bool {
        false
    }
}

/// The selection, cropping and scaling of frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Adjustment {
    pub(crate) selection: Selection,
    pub(crate) crop: Option<Crop>,
    pub(crate) size: Option<(u32, u32)>,
    pub(crate) frames: Option<u32>,
}

impl Adjustment {
    /// Returns the adjustment that the options ask for.
    pub(crate) fn of(options: &InputOptions) -> Self {
        Self {
            selection: options.selection,
            crop: options.crop,
            size: options.resize,
            frames: options.frames,
        }
    }
}

/// A source that adjusts the frames of a feed, and checks that all have one size.
pub(crate) struct Input {
    names: Vec<String>,
    feed: Box<dyn Feed>,
    adjustment: Adjustment,
    selector: Selector,
    /// The first frame, which was read early to learn the size.
    first: Option<SourceFrame>,
    first_name: String,
    size: (u32, u32),
    /// The number of frames that the feed has returned, selected or not.
    given: u64,
    taken: u64,
    /// The origin of the frame that was selected last.
    origin: Option<Origin>,
    problem: Option<String>,
    ended: bool,
}

impl Input {
    pub(crate) fn new(
        names: Vec<String>,
        feed: Box<dyn Feed>,
        adjustment: Adjustment,
    ) -> Result<Self, FootageError> {
        adjustment.selection.check()?;
        if feed.kind() == Kind::Set && !adjustment.selection.is_all() {
            return Err(FootageError::Option {
                option: "--start, --end and --input-fps",
                problem: format!(
                    "images of a set have no times; leave these options out for {}",
                    names.join(", ")
                ),
            });
        }
        let mut input = Self {
            names,
            feed,
            adjustment,
            selector: Selector::new(adjustment.selection),
            first: None,
            first_name: String::new(),
            size: (0, 0),
            given: 0,
            taken: 0,
            origin: None,
            problem: None,
            ended: false,
        };
        let Some(first) = input.take()? else {
            return Err(FootageError::NoFrames { inputs: input.inputs_in_words() });
        };
        input.size = (first.frame.width(), first.frame.height());
        input.first_name.clone_from(&first.name);
        input.first = Some(first);
        Ok(input)
    }

    fn inputs_in_words(&self) -> String {
        let selected = if self.adjustment.selection.is_all() { "" } else { " (as selected)" };
        self.names.join(", ") + selected
    }

    /// Returns the next selected frame, cropped and scaled.
    fn take(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        let limit = self.adjustment.frames.map(u64::from);
        while !self.ended && limit.is_none_or(|limit| self.taken < limit) {
            let Some(mut next) = self.feed.next()? else {
                self.problem = self.feed.problem();
                break;
            };
            let number = self.given;
            self.given += 1;
            match self.selector.judge(next.time_us) {
                Verdict::Skip => {}
                Verdict::End => break,
                Verdict::Take => {
                    let size = (next.frame.width(), next.frame.height());
                    let own_file = self.feed.is_of_files();
                    self.origin = Some(Origin { number, size, own_file });
                    if let Some(part) = self.adjustment.crop {
                        next.frame = resize::crop(&next.frame, part)?;
                    }
                    if let Some((width, height)) = self.adjustment.size {
                        next.frame = resize::resize(next.frame, width, height)?;
                    }
                    self.taken += 1;
                    if limit.is_some_and(|limit| self.taken >= limit) {
                        self.end();
                    }
                    return Ok(Some(next));
                }
            }
        }
        self.end();
        Ok(None)
    }

    fn end(&mut self) {
        self.ended = true;
        self.feed.stop();
    }

    /// Handles a frame of another size. A stream ends there and keeps the frames before; images are
    /// refused.
    fn other_size(&mut self, other: &SourceFrame) -> Result<Option<SourceFrame>, FootageError> {
        let other_size = (other.frame.width(), other.frame.height());
        if !self.feed.is_stream() {
            return Err(FootageError::MixedSizes {
                first: self.first_name.clone(),
                first_size: self.size,
                other: other.name.clone(),
                other_size,
            });
        }
        self.end();
        self.problem = Some(format!(
            "the frame size changes from {}x{} to {}x{} at {}.{:06} s; use --resize to make all one size",
            self.size.0,
            self.size.1,
            other_size.0,
            other_size.1,
            other.time_us / 1_000_000,
            other.time_us % 1_000_000,
        ));
        Ok(None)
    }
}

impl Source for Input {
    fn size(&self) -> (u32, u32) {
        self.size
    }

    fn inputs(&self) -> &[String] {
        &self.names
    }

    fn frames(&self) -> Option<u64> {
        if !self.adjustment.selection.is_all() {
            return None;
        }
        let limit = self.adjustment.frames.map_or(u64::MAX, u64::from);
        self.feed.total().map(|total| total.min(limit))
    }

    fn next_frame(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        if let Some(first) = self.first.take() {
            return Ok(Some(first));
        }
        match self.take()? {
            Some(next) if (next.frame.width(), next.frame.height()) != self.size => {
                self.other_size(&next)
            }
            next => Ok(next),
        }
    }

    fn give_back(&mut self, frame: SourceFrame) {
        if let Some(bytes) = frame.frame.into_bytes() {
            self.feed.give_back(bytes);
        }
    }

    /// The first frame is read early. Until it is returned, there is no origin.
    fn origin(&self) -> Option<Origin> {
        self.origin.filter(|_| self.first.is_none())
    }

    fn kind(&self) -> Kind {
        self.feed.kind()
    }

    fn form(&self) -> SetForm {
        self.feed.form()
    }

    fn problem(&self) -> Option<String> {
        self.problem.clone()
    }
}
