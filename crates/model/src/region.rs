// SPDX-License-Identifier: MIT OR Apache-2.0
//! The areas of regions in the padded frame, and the padding itself.

use foveate_camera::Camera;

use crate::ModelError;
use crate::conversions::index;
use foveate_pixels::Frame;

/// The square of pixels of a region, in coordinates of the padded frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RegionArea {
    pub(crate) left: u32,
    pub(crate) top: u32,
    pub(crate) side: u32,
}

impl RegionArea {
    /// Returns the area of region `region`. Regions are numbered row by row.
    pub(crate) fn from_region(camera: &Camera, region: u32) -> Self {
        let side = camera.region_size();
        let (column, row) = (region % camera.columns(), region / camera.columns());
        Self { left: column * side, top: row * side, side }
    }

    /// Returns the rows of the frame that the region covers.
    pub(crate) fn rows(self) -> std::ops::Range<u32> {
        self.top..self.top + self.side
    }

    /// Returns the columns of the frame that the region covers.
    pub(crate) fn columns(self) -> std::ops::Range<u32> {
        self.left..self.left + self.side
    }

    /// Returns every position of the region in row-major order.
    pub(crate) fn positions(self) -> impl Iterator<Item = (u32, u32)> {
        self.rows().flat_map(move |y| self.columns().map(move |x| (x, y)))
    }

    /// Returns the part of row `y` of a frame that belongs to the region.
    pub(crate) fn row(self, frame: &Frame, y: u32) -> &[u16] {
        &frame.row(y)[index(self.left)..][..index(self.side)]
    }

    /// Returns every pixel of the region in row-major order.
    pub(crate) fn pixels(self, frame: &Frame) -> impl Iterator<Item = u16> {
        self.rows().flat_map(move |y| self.row(frame, y).iter().copied())
    }

    /// Copies the region from one frame to another of the same size.
    pub(crate) fn copy(self, from: &Frame, to: &mut Frame) {
        for y in self.rows() {
            to.write_row(self.left, y, self.row(from, y));
        }
    }

    /// Makes the region black.
    pub(crate) fn blank(self, frame: &mut Frame) {
        let black = vec![0; index(self.side)];
        for y in self.rows() {
            frame.write_row(self.left, y, &black);
        }
    }
}

/// Returns a black frame of the size of the camera.
pub(crate) fn black_frame(camera: &Camera) -> Frame {
    black_frame_of_size(camera, camera.width(), camera.height())
}

/// Returns a black frame of the size of the padded frame of the camera.
pub(crate) fn black_padded_frame(camera: &Camera) -> Frame {
    let side = camera.region_size();
    black_frame_of_size(camera, camera.columns() * side, camera.rows() * side)
}

fn black_frame_of_size(camera: &Camera, width: u32, height: u32) -> Frame {
    Frame::filled(width, height, camera.pixel_bits(), 0).expect("a camera has a size and a depth")
}

/// Appends the pixels of one region of a padded frame to `out`, in row-major order.
///
/// # Panics
/// Panics if the frame does not have the size of the padded frame of the camera, or has no such
/// region.
pub fn region_pixels(camera: &Camera, padded: &Frame, region: u32, out: &mut Vec<u16>) {
    out.extend(RegionArea::from_region(camera, region).pixels(padded));
}

/// Returns the padded frame: its last column and row are repeated until its sides are multiples of
/// N.
///
/// # Errors
/// Returns an error if the frame does not have the size and depth of the camera.
pub fn pad(camera: &Camera, frame: &Frame) -> Result<Frame, ModelError> {
    check_frame_kind(camera, frame)?;
    let mut padded = black_padded_frame(camera);
    pad_into(frame, &mut padded);
    Ok(padded)
}

/// Refuses a frame that does not have the size and depth of the camera.
pub(crate) fn check_frame_kind(camera: &Camera, frame: &Frame) -> Result<(), ModelError> {
    let expected = (camera.width(), camera.height(), camera.pixel_bits());
    if (frame.width(), frame.height(), frame.bits()) == expected {
        return Ok(());
    }
    let (width, height, bits) = expected;
    let expected = format!("{width}x{height} pixels of {bits} bits");
    Err(ModelError::FrameKind { given: frame.size_and_depth(), expected })
}

/// Writes a frame and its padding to `padded`.
pub(crate) fn pad_into(frame: &Frame, padded: &mut Frame) {
    for y in 0..padded.height() {
        let own = frame.row(y.min(frame.height() - 1));
        padded.write_row(0, y, own);
        let last = frame.get(frame.width() - 1, y.min(frame.height() - 1));
        padded.write_row(frame.width(), y, &vec![last; index(padded.width()) - own.len()]);
    }
}

/// Copies the part of `padded` that is not padding to `frame`.
pub(crate) fn crop_into(padded: &Frame, frame: &mut Frame) {
    for y in 0..frame.height() {
        frame.write_row(0, y, &padded.row(y)[..index(frame.width())]);
    }
}
