// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outputs of a run: arrays, tables, pictures, pixel events and a summary.
//!
//! An output that takes frames one at a time and writes them at once is a [`sink::Sink`]; the
//! recorder feeds all of them. A new kind of output is a new sink and a line in the recorder.

mod arrays;
mod bandwidth;
mod canvas;
mod crew;
mod csv;
mod data_set;
mod events;
mod font;
mod gallery;
mod headed;
mod heatmap;
mod npz;
mod options;
mod overlay;
mod packer;
mod packet_file;
mod parquet;
mod picture;
mod pixel_camera;
mod pixel_events;
mod png;
mod png_series;
mod recorder;
mod row_writer;
mod sink;
mod strip;
mod summary;
mod table;
mod video;

pub use bandwidth::{Bandwidth, PIXEL_EVENT_BYTES, Traffic};
pub(crate) use csv::Csv;
pub use data_set::DataSet;
pub use options::{EventTables, Medium, Packets, PixelEvents, RunOptions};
pub use packet_file::write_packets;
pub use pixel_camera::{PixelCamera, PixelEvent};
pub(crate) use recorder::{DISK_FULL, INTERRUPTED, Recorder};
pub use summary::{Grid, Range, Summary};

use std::io;
use std::path::Path;

use crate::SimulatorError;

/// Makes an error that names the file from an error of the operating system.
fn cannot_write(path: &Path) -> impl Fn(io::Error) -> SimulatorError + '_ {
    |source| SimulatorError::Write { path: path.to_owned(), source }
}
