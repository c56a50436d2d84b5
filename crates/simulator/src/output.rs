// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outputs of a run: arrays, tables, pictures, pixel events and a summary.
//!
//! An output that takes frames one at a time and writes them at once is a [`sink::Sink`]; the
//! recorder feeds all of them. A new kind of output is a new sink and a line in the recorder.

mod arrays;
mod bandwidth;
mod canvas;
mod png_writers;
mod csv;
mod data_set;
mod event_files;
mod font;
mod picture_series;
mod headed_file;
mod heatmap;
mod npz;
mod options;
mod overlay;
mod deflate_packer;
mod packet_file;
mod parquet_table;
mod raw_image;
mod pixel_camera;
mod pixel_event_files;
mod png;
mod png_series;
mod recorder;
mod row_writer;
mod sink;
mod activity_chart;
mod summary;
mod frame_table;
mod video_file;

pub use bandwidth::{BandwidthComparison, PIXEL_EVENT_BYTES, CameraTraffic};
pub(crate) use csv::CsvFile;
pub use data_set::DataSetPaths;
pub use options::{EventTableOptions, PictureFormat, PacketContent, PixelEventOptions, RunOptions};
pub use packet_file::write_packets;
pub use pixel_camera::{PixelCamera, PixelEvent};
pub(crate) use recorder::{DISK_FULL, INTERRUPTED, RunRecorder};
pub use summary::{GridSize, ValueRange, RunSummary};

use std::io;
use std::path::Path;

use crate::SimulatorError;

/// Makes an error that names the file from an error of the operating system.
fn cannot_write(path: &Path) -> impl Fn(io::Error) -> SimulatorError + '_ {
    |source| SimulatorError::Write { path: path.to_owned(), source }
}
