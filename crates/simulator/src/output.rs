// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outputs of a run: arrays, tables, pictures, pixel events, packets and a summary.
//!
//! An output that takes frames one at a time and writes them at once is a [`sink::FrameSink`]; the
//! recorder feeds all of them. A new kind of output is a new sink and a line in the recorder.

mod activity_chart;
mod arrays;
mod arrow;
mod bandwidth;
mod canvas;
mod clock_files;
mod csv;
mod data_set;
mod event_files;
mod frame_packets;
mod frame_table;
mod headed_file;
mod heatmap;
mod latency_files;
mod npz;
mod options;
mod overlay;
mod parquet_file;
mod parquet_table;
mod picture_series;
mod pixel_camera;
mod pixel_event_files;
mod png_writers;
mod raw_image;
mod recorder;
mod row_writer;
mod sink;
mod summary;
mod video_file;

pub use bandwidth::{BandwidthComparison, CameraTraffic, PIXEL_EVENT_BYTES};
pub use clock_files::ClockFigures;
pub(crate) use csv::CsvFile;
pub use data_set::DataSetPaths;
pub use frame_packets::{
    FrameStart, SentValues, packet_bytes, packet_layout, wrapped_number, write_kept_packets,
    write_packets,
};
pub use options::{
    ClockOptions, EventTableOptions, OverlayStyle, PacketContent, PictureFormat, PixelEventOptions,
    RunOptions,
};
pub use overlay::{OverlayFrame, draw_overlay};
pub use pixel_camera::{PixelCamera, PixelEvent};
pub(crate) use recorder::{DISK_FULL, FrameContent, INTERRUPTED, RunRecorder};
pub use summary::{GridSize, RunSummary, SentCounts, ValueRange};

use std::io;
use std::path::Path;

use crate::SimulatorError;

/// Makes an error that names the file from an error of the operating system.
fn cannot_write(path: &Path) -> impl Fn(io::Error) -> SimulatorError + '_ {
    |source| SimulatorError::Write { path: path.to_owned(), source }
}
