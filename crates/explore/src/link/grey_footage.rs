// SPDX-License-Identifier: MIT OR Apache-2.0
//! A clip as a file of grey frames, which is read again after the timeline is known.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::PathBuf;

use foveate_media::RunMonitor;

use crate::link::LinkError;
use crate::link::error::scratch_error;

/// The frames of a clip as grey bytes in a file, one after the other.
#[derive(Clone, Debug)]
pub struct GreyFootage {
    /// The name of the clip.
    pub clip: String,
    /// The path of the file.
    pub path: PathBuf,
    /// The width in pixels.
    pub width: u32,
    /// The height in pixels.
    pub height: u32,
    /// The number of frames.
    pub frames: u64,
}

impl GreyFootage {
    /// Reads the frames and gives them to `visit`. `monitor` counts them.
    ///
    /// # Errors
    /// Fails if the file cannot be read, if the run is to stop, or as `visit` does.
    pub(crate) fn visit_frames(
        &self,
        monitor: &RunMonitor<'_>,
        visit: &mut dyn FnMut(&[u8]) -> Result<(), LinkError>,
    ) -> Result<(), LinkError> {
        let file = File::open(&self.path).map_err(scratch_error("read", &self.path))?;
        let mut file = BufReader::new(file);
        let mut pixels = vec![0; self.width as usize * self.height as usize];
        for _ in 0..self.frames {
            monitor.check()?;
            file.read_exact(&mut pixels).map_err(scratch_error("read", &self.path))?;
            visit(&pixels)?;
            monitor.add_frame();
        }
        Ok(())
    }
}
