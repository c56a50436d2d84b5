// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options that select the outputs of a run.

use foveate_camera::Decimal;
use foveate_timed::SinkPattern;

/// The style of an overlay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OverlayStyle {
    /// Sent regions are bright, regions that are not sent are dark, and means are tinted.
    #[default]
    Sent,
    /// The frame is dimmed, with a colour for each of the decisions about a region, and outlines.
    Outlines,
}

/// The file format of a series of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// A folder of pictures `000000.png`, `000001.png` and so on.
    Png,
    /// One lossless video, FFV1 in Matroska. It needs ffmpeg.
    Mkv,
    /// One video for any player, H.264 in MP4. It is not lossless, and needs ffmpeg.
    Mp4,
}

/// The tables with one row per region and frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EventTableOptions {
    /// Writes `events.csv`.
    pub csv: bool,
    /// Writes `events.parquet`.
    pub parquet: bool,
    /// Writes only rows of regions that send pixels or a summary.
    pub only_active: bool,
}

/// The ordinary (x, y, t, p) events of the same frames, for comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelEventOptions {
    /// Writes `pixel_events.npz`.
    pub npz: bool,
    /// Writes `pixel_events.csv`.
    pub csv: bool,
    /// Writes `pixel_events_evt2.raw`, in EVT 2.0.
    pub evt2: bool,
    /// Writes `pixel_events_evt3.raw`, in EVT 3.0.
    pub evt3: bool,
    /// Writes `pixel_events.aedat4`, in AEDAT4.
    pub aedat4: bool,
    /// The change of a pixel that makes an event, in grey levels, or as a natural logarithm if
    /// `is_logarithmic` is set. The default is the smallest change that the camera's temporal score
    /// counts, or 0.2 if `is_logarithmic` is set.
    pub contrast: Option<Decimal>,
    /// Measures changes in natural logarithms.
    pub is_logarithmic: bool,
}

/// The tables of clocks, and the surroundings of the core for which they are computed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ClockOptions {
    /// Writes `clocks.csv`.
    pub csv: bool,
    /// Writes `clocks.parquet`.
    pub parquet: bool,
    /// Writes `clocks.npy`.
    pub npy: bool,
    /// The clock of the core in Hz. Each frame comes at its time in the clip, or as soon as the core
    /// is ready after that. Without a clock each frame follows the one before without a pause.
    pub clock_hz: Option<u64>,
    /// The sink of the words that leave. Only a raster core waits for it.
    pub sink: SinkPattern,
}

/// The content of the packets of a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PacketContent {
    /// The data that a receiver needs for its screen.
    Plain,
    /// The same data, and the scores of every region.
    WithScores,
}

/// The outputs that a run writes besides the arrays, the table of frames and the summary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunOptions {
    /// The rendered frames, `rendered`. Frames of 8 bits per pixel are written unchanged. Fewer
    /// bits are converted to 8 and more bits to 16 by [`foveate_pixels::convert_depth`].
    pub rendered: Option<PictureFormat>,
    /// The original frames with what is sent of them, `overlay`.
    pub overlay: Option<PictureFormat>,
    /// The style of the overlay.
    pub overlay_style: OverlayStyle,
    /// The heat map of every score, `heatmap_<feature>` and `heatmap_temporal`.
    pub heatmap: Option<PictureFormat>,
    /// The tables of regions.
    pub events: EventTableOptions,
    /// The events of pixels.
    pub pixel_events: PixelEventOptions,
    /// The packets that the camera sends, `packets.bin`.
    pub packets: Option<PacketContent>,
    /// The clocks of decisions, words and losses.
    pub clocks: ClockOptions,
    /// Writes the rendered images of a set as a data set of the same form.
    pub data_set: bool,
    /// Replaces the output folder of an earlier run.
    pub overwrite: bool,
}

impl Default for RunOptions {
    fn default() -> Self {
        Self {
            rendered: Some(PictureFormat::Png),
            overlay: None,
            overlay_style: OverlayStyle::default(),
            heatmap: None,
            events: EventTableOptions::default(),
            pixel_events: PixelEventOptions::default(),
            packets: None,
            clocks: ClockOptions::default(),
            data_set: false,
            overwrite: false,
        }
    }
}

impl ClockOptions {
    /// Returns true if a table of clocks is written.
    #[must_use]
    pub fn is_wanted(&self) -> bool {
        self.csv || self.parquet || self.npy
    }
}

impl PixelEventOptions {
    /// Returns true if a file of pixel events is written.
    #[must_use]
    pub fn is_wanted(self) -> bool {
        self.npz || self.csv || self.evt2 || self.evt3 || self.aedat4
    }
}
