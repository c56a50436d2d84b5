// SPDX-License-Identifier: MIT OR Apache-2.0
//! A data set in the format IDX: a file of images and a file of labels. Each is gzipped if the
//! input file was.
//!
//! In this project IDX has 8 bits per pixel, as an input and as an output.

use std::path::Path;

use foveate_pixels::FramePixels;

use super::super::sink::{FrameSink, SinkFrame};
use crate::SimulatorError;
use crate::output::headed_file::HeadedFile;
use crate::output::raw_image::to_byte;
use foveate_media::{FootageError, IdxFile};
use foveate_pixels::convert_depth;

const BITS: u32 = 8;

pub(super) fn idx_sinks(
    folder: &Path,
    images: &IdxFile,
    labels: Option<&IdxFile>,
) -> Result<Vec<Box<dyn FrameSink>>, SimulatorError> {
    if let Some(labels) = labels.filter(|labels| labels.name == images.name) {
        let name = &labels.name;
        let problem = format!("images and labels are both called `{name}`; rename one of them");
        return Err(FootageError::Option { option: "--labels", problem }.into());
    }
    let file = HeadedFile::create(&folder.join(&images.name), images.packed)?;
    let mut sinks: Vec<Box<dyn FrameSink>> =
        vec![Box::new(IdxImageSink { file, count: 0, size: (0, 0), bytes: Vec::new() })];
    if let Some(labels) = labels {
        let file = HeadedFile::create(&folder.join(&labels.name), labels.packed)?;
        sinks.push(Box::new(IdxLabelSink { file, count: 0 }));
    }
    Ok(sinks)
}

/// The file of images while it is written.
struct IdxImageSink {
    file: HeadedFile<16>,
    /// The number of images. The 32-bit count of the input file bounds it.
    count: u32,
    size: (u32, u32),
    bytes: Vec<u8>,
}

impl FrameSink for IdxImageSink {
    fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        let byte = |value: u16| to_byte(convert_depth(value, sink_frame.camera.pixel_bits(), BITS));
        self.bytes.clear();
        match sink_frame.screen {
            FramePixels::Bytes(pixels) => self.bytes.extend(pixels.iter().map(|&p| byte(p.into()))),
            FramePixels::Words(pixels) => self.bytes.extend(pixels.iter().map(|&p| byte(p))),
        }
        self.size = (sink_frame.camera.width(), sink_frame.camera.height());
        self.count += 1;
        self.file.write(&self.bytes);
        Ok(())
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.file.write_out()
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        let (width, height) = self.size;
        self.file.finish(&idx_header([0x0803, self.count, height, width]))
    }
}

/// The file of labels while it is written.
struct IdxLabelSink {
    file: HeadedFile<8>,
    count: u32,
}

impl FrameSink for IdxLabelSink {
    fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        let label = sink_frame.source.label.as_deref().and_then(|label| label.parse().ok());
        self.count += 1;
        self.file.write(&[label.expect("the reader of IDX makes text of a byte for every image")]);
        Ok(())
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.file.write_out()
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        self.file.finish(&idx_header([0x0801, self.count]))
    }
}

/// Returns numbers with their high bytes first. The first number is the magic number of the file.
fn idx_header<const NUMBERS: usize, const BYTES: usize>(numbers: [u32; NUMBERS]) -> [u8; BYTES] {
    let mut bytes = [0; BYTES];
    for (bytes, number) in bytes.chunks_exact_mut(4).zip(numbers) {
        bytes.copy_from_slice(&number.to_be_bytes());
    }
    bytes
}
