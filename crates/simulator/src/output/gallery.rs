// SPDX-License-Identifier: MIT OR Apache-2.0
//! A series of pictures of one kind, as numbered PNG files or as a video.

use std::path::{Path, PathBuf};

use foveate_camera::Camera;
use foveate_toolchain::Interrupt;

use super::Medium;
use super::canvas::Canvas;
use super::crew::Crew;
use super::picture::RawImage;
use super::png_series::PngSeries;
use super::sink::{Sink, Step};
use super::video::VideoFile;
use crate::SimulatorError;

/// Draws a picture of a frame and its outcome.
pub(super) trait Painter: Send {
    fn paint(&mut self, step: &Step<'_>) -> Canvas;
}

/// The files of a series.
enum Series {
    Folder(PngSeries),
    Video(VideoFile),
}

/// The pictures of one kind and their files.
pub(super) struct Gallery {
    /// The painter of the pictures. Without one, the screen is written.
    painter: Option<Box<dyn Painter>>,
    series: Series,
}

impl Gallery {
    /// Makes the series of the rendered frames.
    pub(super) fn rendered(
        folder: &Path,
        medium: Medium,
        interrupt: &Interrupt,
    ) -> Result<Self, SimulatorError> {
        Ok(Self { painter: None, series: Series::create(folder, "rendered", medium, interrupt)? })
    }

    pub(super) fn painted(
        folder: &Path,
        name: &str,
        (medium, interrupt): (Medium, &Interrupt),
        painter: impl Painter + 'static,
    ) -> Result<Self, SimulatorError> {
        let series = Series::create(folder, name, medium, interrupt)?;
        Ok(Self { painter: Some(Box::new(painter)), series })
    }
}

impl Sink for Gallery {
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError> {
        let picture = match &mut self.painter {
            Some(painter) => painter.paint(step).into(),
            None => RawImage::grey(step, self.series.spare()),
        };
        match &mut self.series {
            Series::Folder(series) => series.push(picture),
            Series::Video(video) => video.push(picture, step.source.time_us)?,
        }
        Ok(())
    }

    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        match &mut self.series {
            Series::Folder(series) => series.crew.write_out(all),
            Series::Video(video) => video.check(),
        }
    }

    fn owed(&self, camera: &Camera) -> u64 {
        // A painted picture has a footer below the frame, and is larger if the frame is small.
        let (lines, samples) = if self.painter.is_some() { (256, 12) } else { (0, 2) };
        match &self.series {
            Series::Folder(_) => Crew::owed(camera.width(), camera.height() + lines, samples),
            Series::Video(_) => 0,
        }
    }

    fn expendable(&self) -> Option<PathBuf> {
        match &self.series {
            Series::Folder(series) => Some(series.folder().to_owned()),
            Series::Video(video) => Some(video.path().to_owned()),
        }
    }

    fn is_written_apart(&self) -> bool {
        matches!(self.series, Series::Video(_))
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        match self.series {
            Series::Folder(series) => series.crew.finish(),
            Series::Video(video) => video.finish(),
        }
    }
}

impl Series {
    fn create(
        folder: &Path,
        name: &str,
        medium: Medium,
        interrupt: &Interrupt,
    ) -> Result<Self, SimulatorError> {
        let video = |extension: &str| {
            let path = folder.join(format!("{name}.{extension}"));
            VideoFile::create(&path, interrupt).map(Self::Video)
        };
        match medium {
            Medium::Png => PngSeries::create(folder.join(name)).map(Self::Folder),
            Medium::Mkv => video("mkv"),
            Medium::Mp4 => video("mp4"),
        }
    }

    /// Returns the buffer of an earlier picture, or an empty one.
    fn spare(&mut self) -> Vec<u8> {
        match self {
            Self::Folder(series) => series.crew.spare(),
            Self::Video(_) => Vec::new(),
        }
    }
}
