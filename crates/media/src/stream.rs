// SPDX-License-Identifier: MIT OR Apache-2.0
//! Streams of frames without times of their own, from a file or a pipe, read without ffmpeg. Times
//! follow from a rate.

use std::io::{self, BufRead, Read};

use foveate_pixels::ByteFrame;
use foveate_tools::Interrupt;

use crate::source::feed::FrameFeed;
use crate::{FootageError, FrameRate, LumaRange, SourceFrame};

/// The format of the frames of a stream.
pub(crate) trait StreamFormat: Send {
    /// Reads the next frame. `memory` may be used for its pixels. Returns `None` at the end of the
    /// stream.
    ///
    /// # Errors
    /// Fails with a text that says what is wrong.
    fn read_frame(
        &mut self,
        input: &mut dyn BufRead,
        memory: Vec<u8>,
    ) -> Result<Option<ByteFrame>, String>;

    /// Returns the range of luma; `None` if the stream is not video.
    fn luma(&self) -> Option<LumaRange>;

    /// Returns true if the user may give the frames other times than those of a rate.
    fn takes_timestamps(&self) -> bool;

    /// Returns true if the pixels may be those of a mosaic of colours.
    fn reads_mosaics(&self) -> bool;

    fn no_frame_error(&self, name: String, problem: String) -> FootageError;
}

/// The frames of a stream.
pub(crate) struct StreamFeed<F> {
    name: String,
    input: Box<dyn BufRead + Send>,
    format: F,
    rate: FrameRate,
    /// The number of all frames, if it is known.
    total: Option<u64>,
    /// The memory for the next frame.
    memory: Vec<u8>,
    frames: u64,
    problem: Option<String>,
    interrupt: Interrupt,
}

impl<F: StreamFormat> StreamFeed<F> {
    pub(crate) fn new(
        name: String,
        input: Box<dyn BufRead + Send>,
        format: F,
        rate: FrameRate,
        interrupt: Interrupt,
    ) -> Self {
        Self {
            name,
            input,
            format,
            rate,
            total: None,
            memory: Vec::new(),
            frames: 0,
            problem: None,
            interrupt,
        }
    }

    /// Sets the number of all frames.
    pub(crate) fn with_total(self, total: u64) -> Self {
        Self { total: Some(total), ..self }
    }
}

impl<F: StreamFormat> FrameFeed for StreamFeed<F> {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        if self.problem.is_some() {
            return Ok(None);
        }
        let memory = std::mem::take(&mut self.memory);
        match self.format.read_frame(&mut *self.input, memory) {
            Ok(frame) => Ok(frame.map(|frame| {
                let time_us = self.rate.time_us(self.frames);
                self.frames += 1;
                SourceFrame { name: self.name.clone(), time_us, label: None, frame }
            })),
            Err(_) if self.interrupt.is_set() => Err(FootageError::Interrupted),
            Err(problem) if self.frames == 0 => {
                Err(self.format.no_frame_error(self.name.clone(), problem))
            }
            Err(problem) => {
                self.problem = Some(format!("after {} frames: {problem}", self.frames));
                Ok(None)
            }
        }
    }

    fn luma(&self) -> Option<LumaRange> {
        self.format.luma()
    }

    fn total(&self) -> Option<u64> {
        self.total
    }

    fn recycle(&mut self, bytes: Vec<u8>) {
        self.memory = bytes;
    }

    fn problem(&self) -> Option<String> {
        self.problem.clone()
    }

    fn is_stream(&self) -> bool {
        true
    }

    fn takes_timestamps(&self) -> bool {
        self.format.takes_timestamps()
    }

    fn reads_mosaics(&self) -> bool {
        self.format.reads_mosaics()
    }
}

pub(crate) fn is_at_end(input: &mut dyn BufRead) -> Result<bool, String> {
    input.fill_buf().map(<[u8]>::is_empty).map_err(|error| error.to_string())
}

/// Reads bytes of a frame until `bytes` is full.
pub(crate) fn read_whole(input: &mut dyn BufRead, bytes: &mut [u8]) -> Result<(), String> {
    input.read_exact(bytes).map_err(|error| stream_error(&error))
}

/// Reads bytes of a frame that are not needed.
pub(crate) fn skip_whole(input: &mut dyn BufRead, count: u64) -> Result<(), String> {
    let skipped = io::copy(&mut input.take(count), &mut io::sink());
    if skipped.map_err(|error| stream_error(&error))? < count {
        return Err(stream_error(&io::ErrorKind::UnexpectedEof.into()));
    }
    Ok(())
}

fn stream_error(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => "the stream ends inside a frame".to_owned(),
        _ => error.to_string(),
    }
}
