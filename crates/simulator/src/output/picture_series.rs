// SPDX-License-Identifier: MIT OR Apache-2.0
//! A series of pictures of one kind, as numbered PNG files or as a video.

use std::path::{Path, PathBuf};

use foveate_camera::Camera;
use foveate_tools::Interrupt;

use super::PictureFormat;
use super::canvas::{PictureCanvas, PictureLayout};
use super::png_writers::{PngSeries, PngWriters};
use super::raw_image::RawImage;
use super::sink::{FrameSink, SinkFrame};
use super::video_file::VideoFile;
use crate::SimulatorError;

/// Draws a picture of a frame and its outcome.
pub(super) trait PicturePainter: Send {
    fn paint(&mut self, sink_frame: &SinkFrame<'_>) -> PictureCanvas;
}

/// The height of the largest legend and chart below a painted frame in pixels.
const MAX_FOOTER_HEIGHT: u32 = 320;

enum SeriesFiles {
    Folder(PngSeries),
    Video(VideoFile),
}

/// The pictures of one kind and their files.
pub(super) struct PictureSeriesSink {
    /// The painter of the pictures. Without one, the screen is written.
    painter: Option<Box<dyn PicturePainter>>,
    series: SeriesFiles,
}

impl PictureSeriesSink {
    /// Makes the series of the rendered frames.
    pub(super) fn rendered(
        folder: &Path,
        format: PictureFormat,
        interrupt: &Interrupt,
    ) -> Result<Self, SimulatorError> {
        Ok(Self {
            painter: None,
            series: SeriesFiles::create(folder, "rendered", format, interrupt)?,
        })
    }

    pub(super) fn with_painter(
        folder: &Path,
        name: &str,
        (format, interrupt): (PictureFormat, &Interrupt),
        painter: impl PicturePainter + 'static,
    ) -> Result<Self, SimulatorError> {
        let series = SeriesFiles::create(folder, name, format, interrupt)?;
        Ok(Self { painter: Some(Box::new(painter)), series })
    }
}

impl FrameSink for PictureSeriesSink {
    fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        let picture = match &mut self.painter {
            Some(painter) => painter.paint(sink_frame).into(),
            None => RawImage::of_screen(sink_frame, self.series.take_spare_buffer()),
        };
        match &mut self.series {
            SeriesFiles::Folder(series) => series.push(picture),
            SeriesFiles::Video(video) => video.push(picture, sink_frame.source.time_us)?,
        }
        Ok(())
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        match &mut self.series {
            SeriesFiles::Folder(series) => series.writers.check_written(),
            SeriesFiles::Video(video) => video.check_encoder(),
        }
    }

    fn max_bytes_owed(&self, camera: &Camera) -> u64 {
        let (width, height) = (camera.width(), camera.height());
        match &self.series {
            SeriesFiles::Folder(_) if self.painter.is_some() => {
                // A small frame is enlarged, and its legend and chart stand below it.
                let layout = PictureLayout::of_camera(camera);
                let height = layout.frame_height + MAX_FOOTER_HEIGHT;
                PngWriters::max_bytes_in_work(layout.width, height, 3)
            }
            SeriesFiles::Folder(_) => PngWriters::max_bytes_in_work(width, height, 2),
            SeriesFiles::Video(_) => 0,
        }
    }

    fn expendable_path(&self) -> Option<PathBuf> {
        match &self.series {
            SeriesFiles::Folder(series) => Some(series.folder().to_owned()),
            SeriesFiles::Video(video) => Some(video.path().to_owned()),
        }
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        match self.series {
            SeriesFiles::Folder(series) => series.writers.finish(),
            SeriesFiles::Video(video) => video.finish(),
        }
    }
}

impl SeriesFiles {
    fn create(
        folder: &Path,
        name: &str,
        picture_format: PictureFormat,
        interrupt: &Interrupt,
    ) -> Result<Self, SimulatorError> {
        let video = |extension: &str| {
            let path = folder.join(format!("{name}.{extension}"));
            VideoFile::create(&path, interrupt).map(Self::Video)
        };
        match picture_format {
            PictureFormat::Png => PngSeries::create(folder.join(name)).map(Self::Folder),
            PictureFormat::Mkv => video("mkv"),
            PictureFormat::Mp4 => video("mp4"),
        }
    }

    /// Returns the buffer of an earlier picture, or an empty one.
    fn take_spare_buffer(&mut self) -> Vec<u8> {
        match self {
            Self::Folder(series) => series.writers.take_spare_buffer(),
            Self::Video(_) => Vec::new(),
        }
    }
}
