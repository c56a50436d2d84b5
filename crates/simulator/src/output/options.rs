// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run is asked to write.

use foveate_camera::Decimal;

/// How a series of pictures is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Medium {
    /// A folder of pictures `000000.png` and on.
    Png,
    /// One lossless video, FFV1 in Matroska; needs ffmpeg.
    Mkv,
    /// One video for any player, H.264 in MP4, not lossless; needs ffmpeg.
    Mp4,
}

/// Tables with one row per region and frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EventTables {
    /// `events.csv`.
    pub csv: bool,
    /// `events.parquet`.
    pub parquet: bool,
    /// Rows of active regions only.
    pub only_active: bool,
}

/// Ordinary (x, y, t, p) events of the same frames, for comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelEvents {
    /// `pixel_events.npz`.
    pub npz: bool,
    /// `pixel_events.csv`.
    pub csv: bool,
    /// Change of a pixel that makes an event: grey levels, or natural logarithms with `log`. Without
    /// one: the smallest change that the camera's temporal score counts, or 0.2 with `log`.
    pub contrast: Option<Decimal>,
    /// Whether changes are measured in logarithms.
    pub log: bool,
}

/// What goes into the packets of a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packets {
    /// What a receiver needs for its screen.
    Plain,
    /// The scores of every region besides.
    WithScores,
}

/// What a run writes beside arrays, the table of frames and the summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunOptions {
    /// What is on the screen, `rendered`. 8 bits per pixel as they are; fewer are widened to 8 and
    /// more to 16 bits by [`foveate_frame::convert_depth`].
    pub rendered: Option<Medium>,
    /// The original frames with the decisions in colour, `overlay`.
    pub overlay: Option<Medium>,
    /// A map of every score, `heatmap_<feature>` and `heatmap_temporal`.
    pub heatmap: Option<Medium>,
    /// Tables of regions.
    pub events: EventTables,
    /// Events of pixels.
    pub pixel_events: PixelEvents,
    /// What the camera sends, `packets.bin`.
    pub packets: Option<Packets>,
    /// The images of a set as a data set of the same form.
    pub data_set: bool,
    /// Replace the output folder of an earlier run.
    pub overwrite: bool,
}

impl Default for RunOptions {
    fn default() -> Self {
        Self {
            rendered: Some(Medium::Png),
            overlay: None,
            heatmap: None,
            events: EventTables::default(),
            pixel_events: PixelEvents::default(),
            packets: None,
            data_set: false,
            overwrite: false,
        }
    }
}

impl PixelEvents {
    /// Whether anything of them is written.
    #[must_use]
    pub fn wanted(self) -> bool {
        self.npz || self.csv
    }
}
