// SPDX-License-Identifier: MIT OR Apache-2.0
//! A series of pictures of one kind, as numbered PNGs or as a video.

use std::path::Path;

use foveate_model::Frame;

use super::Medium;
use super::canvas::Canvas;
use super::png::{PngSeries, low_byte};
use super::sink::{Sink, Step};
use super::video::VideoFile;
use crate::{SimulatorError, convert_depth, display_depth};

/// Draws a picture of a frame and what came of it.
pub(super) trait Painter: Send {
    fn paint(&mut self, step: &Step<'_>) -> Canvas;
}

/// What the samples of a picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Samples {
    Grey8,
    /// In native order.
    Grey16,
    Rgb8,
}

/// A picture as bytes.
pub(super) struct Picture {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) samples: Samples,
    pub(super) bytes: Vec<u8>,
}

impl From<Canvas> for Picture {
    fn from(canvas: Canvas) -> Self {
        let Canvas { width, height, rgb } = canvas;
        Self { width, height, samples: Samples::Rgb8, bytes: rgb }
    }
}

impl Picture {
    /// A grey frame at the depth that [`display_depth`] gives it.
    pub(super) fn grey(frame: &Frame) -> Self {
        let depth = display_depth(frame.bits());
        let values = frame.pixels().iter().map(|&value| convert_depth(value, frame.bits(), depth));
        let (samples, bytes) = if depth == 8 {
            (Samples::Grey8, values.map(low_byte).collect())
        } else {
            (Samples::Grey16, values.flat_map(u16::to_ne_bytes).collect())
        };
        Self { width: frame.width(), height: frame.height(), samples, bytes }
    }
}

/// A series, open.
enum Series {
    Folder(PngSeries),
    Video(VideoFile),
}

/// Pictures of one kind and where they go.
pub(super) struct Gallery {
    /// What is on the screen is shown without one.
    painter: Option<Box<dyn Painter>>,
    series: Series,
}

impl Gallery {
    /// The frames that are on the screen.
    pub(super) fn rendered(folder: &Path, medium: Medium) -> Result<Self, SimulatorError> {
        Ok(Self { painter: None, series: Series::create(folder, "rendered", medium)? })
    }

    pub(super) fn painted(
        folder: &Path,
        name: &str,
        medium: Medium,
        painter: impl Painter + 'static,
    ) -> Result<Self, SimulatorError> {
        let series = Series::create(folder, name, medium)?;
        Ok(Self { painter: Some(Box::new(painter)), series })
    }
}

impl Sink for Gallery {
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError> {
        let picture = match &mut self.painter {
            Some(painter) => painter.paint(step).into(),
            None => Picture::grey(step.rendered()?),
        };
        match &mut self.series {
            Series::Folder(series) => series.push(&picture),
            Series::Video(video) => video.push(picture, step.source.time_us),
        }
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        match self.series {
            Series::Folder(_) => Ok(()),
            Series::Video(video) => video.finish(),
        }
    }
}

impl Series {
    fn create(folder: &Path, name: &str, medium: Medium) -> Result<Self, SimulatorError> {
        match medium {
            Medium::Png => PngSeries::create(folder.join(name)).map(Self::Folder),
            Medium::Mkv => VideoFile::create(&folder.join(format!("{name}.mkv"))).map(Self::Video),
            Medium::Mp4 => VideoFile::create(&folder.join(format!("{name}.mp4"))).map(Self::Video),
        }
    }
}
