// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of all kinds of input, and the source that is made of it. Frames are selected by
//! their times, cropped, scaled, and checked to have one size, in the same way for every kind of
//! input.

use super::scaling;
use super::selection::{FrameSelection, FrameSelector, SelectionDecision};
use super::set_form::SetForm;
use super::{FrameOrigin, FrameSource, SourceFrame, SourceKind};
use crate::limits::CropRect;
use crate::{FootageError, InputOptions, LumaRange};

/// A kind of input. It returns frames as they come, of any size.
pub(crate) trait FrameFeed: Send {
    /// Returns the next frame, or `None` after the last.
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError>;

    /// Returns the number of all frames, if it is known.
    fn total(&self) -> Option<u64>;

    /// Returns the relation between the frames.
    fn kind(&self) -> SourceKind {
        SourceKind::Clip
    }

    /// Returns the kind of the files and of the labels of a set.
    fn form(&self) -> SetForm {
        SetForm::default()
    }

    /// Returns the range of luma, if the input is video.
    fn luma(&self) -> Option<LumaRange> {
        None
    }

    /// After the last frame, returns the problem because of which the input ended too early.
    fn problem(&self) -> Option<String> {
        None
    }

    /// Takes back the memory of a frame that is no longer needed.
    fn recycle(&mut self, _bytes: Vec<u8>) {}

    /// Ends the input, since no more frames are needed.
    fn stop(&mut self) {}

    fn is_file_per_frame(&self) -> bool {
        false
    }

    /// Returns true if the pixels may be those of a mosaic of colours.
    fn reads_mosaics(&self) -> bool {
        false
    }

    /// Returns true if the user may give the frames times, because they have none of their own.
    fn takes_timestamps(&self) -> bool {
        false
    }

    /// Returns true if the frames before a fault are worth keeping, as for a long recording.
    fn is_stream(&self) -> bool {
        false
    }
}

/// The selection, cropping and scaling of frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FrameAdjustment {
    pub(crate) selection: FrameSelection,
    pub(crate) crop: Option<CropRect>,
    pub(crate) size: Option<(u32, u32)>,
    pub(crate) frames: Option<u32>,
}

impl FrameAdjustment {
    /// Returns the adjustment that the options ask for.
    pub(crate) fn from_options(options: &InputOptions) -> Self {
        Self {
            selection: options.selection,
            crop: options.crop,
            size: options.resize,
            frames: options.frames,
        }
    }
}

/// A source that adjusts the frames of a feed, and checks that all have one size.
pub(crate) struct AdjustedSource {
    names: Vec<String>,
    feed: Box<dyn FrameFeed>,
    adjustment: FrameAdjustment,
    selector: FrameSelector,
    /// The first frame, which was read early to learn the size.
    first: Option<SourceFrame>,
    first_name: String,
    size: (u32, u32),
    /// The number of frames that the feed has returned, selected or not.
    frames_returned: u64,
    frames_selected: u64,
    /// The origin of the frame that was selected last.
    origin: Option<FrameOrigin>,
    problem: Option<String>,
    ended: bool,
}

impl AdjustedSource {
    pub(crate) fn new(
        names: Vec<String>,
        feed: Box<dyn FrameFeed>,
        adjustment: FrameAdjustment,
    ) -> Result<Self, FootageError> {
        adjustment.selection.check()?;
        if feed.kind() == SourceKind::Set && !adjustment.selection.is_all() {
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
            selector: FrameSelector::new(adjustment.selection),
            first: None,
            first_name: String::new(),
            size: (0, 0),
            frames_returned: 0,
            frames_selected: 0,
            origin: None,
            problem: None,
            ended: false,
        };
        let Some(first) = input.next_selected()? else {
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
    fn next_selected(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        let limit = self.adjustment.frames.map(u64::from);
        while !self.ended && limit.is_none_or(|limit| self.frames_selected < limit) {
            let Some(mut next) = self.feed.next()? else {
                self.problem = self.feed.problem();
                break;
            };
            let number = self.frames_returned;
            self.frames_returned += 1;
            match self.selector.decide(next.time_us) {
                SelectionDecision::Skip => {}
                SelectionDecision::End => break,
                SelectionDecision::Take => {
                    let size = (next.frame.width(), next.frame.height());
                    let own_file = self.feed.is_file_per_frame();
                    self.origin = Some(FrameOrigin { number, size, own_file });
                    if let Some(part) = self.adjustment.crop {
                        match scaling::crop(&next.frame, part) {
                            Ok(frame) => next.frame = frame,
                            // A stream whose frames become smaller keeps the frames before.
                            Err(error) if self.feed.is_stream() && self.frames_selected > 0 => {
                                self.problem = Some(error.to_string());
                                break;
                            }
                            Err(error) => return Err(error),
                        }
                    }
                    if let Some((width, height)) = self.adjustment.size {
                        next.frame = scaling::resize(next.frame, width, height)?;
                    }
                    self.frames_selected += 1;
                    if limit.is_some_and(|limit| self.frames_selected >= limit) {
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
    fn handle_other_size(
        &mut self,
        other: &SourceFrame,
    ) -> Result<Option<SourceFrame>, FootageError> {
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

impl FrameSource for AdjustedSource {
    fn crop(&self) -> Option<CropRect> {
        self.adjustment.crop
    }

    fn luma(&self) -> Option<LumaRange> {
        self.feed.luma()
    }

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
        match self.next_selected()? {
            Some(next) if (next.frame.width(), next.frame.height()) != self.size => {
                self.handle_other_size(&next)
            }
            next => Ok(next),
        }
    }

    fn recycle(&mut self, frame: SourceFrame) {
        if let Some(bytes) = frame.frame.into_bytes() {
            self.feed.recycle(bytes);
        }
    }

    /// The first frame is read early. Until it is returned, there is no origin.
    fn origin(&self) -> Option<FrameOrigin> {
        self.origin.filter(|_| self.first.is_none())
    }

    fn kind(&self) -> SourceKind {
        self.feed.kind()
    }

    fn form(&self) -> SetForm {
        self.feed.form()
    }

    fn problem(&self) -> Option<String> {
        self.problem.clone()
    }
}
