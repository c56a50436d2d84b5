// SPDX-License-Identifier: MIT OR Apache-2.0
//! What every kind of input is underneath, and the one source made of it: frames are taken or left by
//! their times, cropped, scaled, and held to one size, all in the same way whatever they come from.

use super::form::SetForm;
use super::resize;
use super::select::{Selection, Selector, Verdict};
use super::{Kind, Origin, Source, SourceFrame};
use crate::limits::Crop;
use crate::{FootageError, InputOptions};

/// Frames as they come, of any size.
pub(crate) trait Feed: Send {
    /// The next frame, or `None` after the last.
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError>;

    /// How many there will be, as far as is known.
    fn total(&self) -> Option<u64>;

    /// Whether frames follow each other in time.
    fn kind(&self) -> Kind {
        Kind::Clip
    }

    /// Of a set: what files hold it, and what its labels are.
    fn form(&self) -> SetForm {
        SetForm::default()
    }

    /// Why it ended before its end, once it has.
    fn problem(&self) -> Option<String> {
        None
    }

    /// Takes back the memory of a frame that is done with.
    fn give_back(&mut self, _bytes: Vec<u8>) {}

    /// No more frames are wanted: what feeds them may end.
    fn stop(&mut self) {}

    /// Whether every frame is a file with a name of its own.
    fn is_of_files(&self) -> bool {
        false
    }

    /// Whether what came before a fault is a result worth keeping, as of a long recording.
    fn is_stream(&self) -> bool {
        false
    }
}

/// What is done to frames on the way.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Adjustment {
    pub(crate) selection: Selection,
    pub(crate) crop: Option<Crop>,
    pub(crate) size: Option<(u32, u32)>,
    pub(crate) frames: Option<u32>,
}

impl Adjustment {
    /// What the options ask for.
    pub(crate) fn of(options: &InputOptions) -> Self {
        Self {
            selection: options.selection,
            crop: options.crop,
            size: options.resize,
            frames: options.frames,
        }
    }
}

/// A feed whose frames are adjusted, all of one size.
pub(crate) struct Input {
    names: Vec<String>,
    feed: Box<dyn Feed>,
    adjustment: Adjustment,
    selector: Selector,
    /// The first frame, read to learn the size.
    first: Option<SourceFrame>,
    first_name: String,
    size: (u32, u32),
    /// Frames that the feed has given, taken or not.
    given: u64,
    taken: u64,
    /// Of the frame that was taken last.
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

    /// The next frame that is wanted, cropped and scaled.
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

    /// A stream that changes its size ends there, with what came before; images are refused.
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

    /// The first frame is read early, but no other before it is given.
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
