// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a region lies in the padded frame, and the padding itself.

use foveate_camera::Camera;

use crate::ModelError;
use crate::number::index;
use foveate_frame::Frame;

/// The square of pixels of one region, in coordinates of the padded frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Area {
    pub(crate) left: u32,
    pub(crate) top: u32,
    pub(crate) side: u32,
}

impl Area {
    /// The place of region `region`; regions are numbered row by row.
    pub(crate) fn of(camera: &Camera, region: u32) -> Self {
        let side = camera.region_size();
        let (column, row) = (region % camera.columns(), region / camera.columns());
        Self { left: column * side, top: row * side, side }
    }

    /// Rows of the frame that the region reaches.
    pub(crate) fn rows(self) -> std::ops::Range<u32> {
        self.top..self.top + self.side
    }

    /// Columns of the frame that the region reaches.
    pub(crate) fn columns(self) -> std::ops::Range<u32> {
        self.left..self.left + self.side
    }

    /// Every position, row by row.
    pub(crate) fn positions(self) -> impl Iterator<Item = (u32, u32)> {
        self.rows().flat_map(move |y| self.columns().map(move |x| (x, y)))
    }

    /// The part of row `y` of a frame that belongs to the region.
    pub(crate) fn row(self, frame: &Frame, y: u32) -> &[u16] {
        &frame.row(y)[index(self.left)..][..index(self.side)]
    }

    /// Every pixel, row by row.
    pub(crate) fn pixels(self, frame: &Frame) -> impl Iterator<Item = u16> {
        self.rows().flat_map(move |y| self.row(frame, y).iter().copied())
    }

    /// Copies the region from one frame to another of the same size.
    pub(crate) fn copy(self, from: &Frame, to: &mut Frame) {
        for y in self.rows() {
            to.write(self.left, y, self.row(from, y));
        }
    }

    /// Makes the region black.
    pub(crate) fn blank(self, frame: &mut Frame) {
        let black = vec![0; index(self.side)];
        for y in self.rows() {
            frame.write(self.left, y, &black);
        }
    }
}

/// A black frame of the camera's size.
pub(crate) fn black(camera: &Camera) -> Frame {
    filled(camera, camera.width(), camera.height())
}

/// A black frame as large as a whole number of the camera's regions.
pub(crate) fn black_padded(camera: &Camera) -> Frame {
    let side = camera.region_size();
    filled(camera, camera.columns() * side, camera.rows() * side)
}

fn filled(camera: &Camera, width: u32, height: u32) -> Frame {
    Frame::filled(width, height, camera.pixel_bits(), 0).expect("a camera has a size and a depth")
}

/// The pixels of one region of a padded frame, row by row, appended to `out`.
///
/// # Panics
/// When the frame is not as large as the camera's padded frame, or has no such region.
pub fn region_pixels(camera: &Camera, padded: &Frame, region: u32, out: &mut Vec<u16>) {
    out.extend(Area::of(camera, region).pixels(padded));
}

/// The frame, made as large as a whole number of regions by repeating its last column and row.
///
/// # Errors
/// When the frame is not of the camera's size and depth.
pub fn pad(camera: &Camera, frame: &Frame) -> Result<Frame, ModelError> {
    check_kind(camera, frame)?;
    let mut padded = black_padded(camera);
    pad_into(frame, &mut padded);
    Ok(padded)
}

/// Refuses a frame that is not of the camera's size and depth.
pub(crate) fn check_kind(camera: &Camera, frame: &Frame) -> Result<(), ModelError> {
    let expected = (camera.width(), camera.height(), camera.pixel_bits());
    if (frame.width(), frame.height(), frame.bits()) == expected {
        return Ok(());
    }
    let (width, height, bits) = expected;
    let expected = format!("{width}x{height} pixels of {bits} bits");
    Err(ModelError::FrameKind { given: frame.kind(), expected })
}

/// Fills a padded frame.
pub(crate) fn pad_into(frame: &Frame, padded: &mut Frame) {
    for y in 0..padded.height() {
        let own = frame.row(y.min(frame.height() - 1));
        padded.write(0, y, own);
        let last = frame.get(frame.width() - 1, y.min(frame.height() - 1));
        padded.write(frame.width(), y, &vec![last; index(padded.width()) - own.len()]);
    }
}

/// Cuts the padding off again.
pub(crate) fn crop_into(padded: &Frame, frame: &mut Frame) {
    for y in 0..frame.height() {
        frame.write(0, y, &padded.row(y)[..index(frame.width())]);
    }
}
