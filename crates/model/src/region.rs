// SPDX-License-Identifier: MIT OR Apache-2.0
//! A region as all models see it: its place in the padded frame ([`RegionArea`]), the pixels
//! that every score is computed from ([`RegionView`]), and its action, which follows from
//! votes, SRS and TRS ([`region_action`]). A new score can use all of a view: its pixels, the
//! windows around them, and its reference.

use crate::ModelError;
use crate::conversions::index;
use crate::window::{PixelWindow, WindowBounds};
use foveate_camera::{Camera, IrrelevantRendering, Neighborhood, RegionAction, VoteCombination};
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

/// The denoised pixels of a region and of its reference, in row-major order.
pub trait RegionView {
    /// Returns the number of pixels of the region, n.
    fn pixel_count(&self) -> u64;
    /// Returns the pixels of the region.
    fn pixels(&self) -> impl Iterator<Item = u16>;
    /// Returns the window around each pixel of the region.
    fn windows(&self) -> impl Iterator<Item = PixelWindow>;
    /// Returns the pixels of the reference, or `None` if there is no valid one.
    fn reference(&self) -> Option<impl Iterator<Item = u16>>;
}

/// A region in its padded frame, with its reference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameRegion<'a> {
    frame: &'a Frame,
    area: RegionArea,
    bounds: WindowBounds,
    reference: Option<&'a Frame>,
}

impl<'a> FrameRegion<'a> {
    /// Makes a view of region `region` of a padded frame, without a reference.
    pub(crate) fn new(camera: &Camera, frame: &'a Frame, region: u32) -> Self {
        let area = RegionArea::from_region(camera, region);
        let bounds = match camera.neighborhood() {
            Neighborhood::Isolated => WindowBounds {
                left: area.left,
                top: area.top,
                right: area.left + area.side - 1,
                bottom: area.top + area.side - 1,
            },
            Neighborhood::Shared => WindowBounds {
                left: 0,
                top: 0,
                right: frame.width() - 1,
                bottom: frame.height() - 1,
            },
        };
        Self { frame, area, bounds, reference: None }
    }

    /// Adds the padded frame that holds the reference of the region.
    pub(crate) fn with_reference(self, reference: Option<&'a Frame>) -> Self {
        Self { reference, ..self }
    }

    /// Returns the window around one pixel of the region.
    pub(crate) fn window(self, x: u32, y: u32) -> PixelWindow {
        let (columns, rows) = self.bounds.neighbors(x, y);
        let mut window = [0; 9];
        for (line, y) in window.chunks_exact_mut(3).zip(rows) {
            let row = self.frame.row(y);
            for (pixel, x) in line.iter_mut().zip(columns) {
                *pixel = row[index(x)];
            }
        }
        window
    }
}

impl RegionView for FrameRegion<'_> {
    fn pixel_count(&self) -> u64 {
        u64::from(self.area.side).pow(2)
    }

    fn pixels(&self) -> impl Iterator<Item = u16> {
        self.area.pixels(self.frame)
    }

    fn windows(&self) -> impl Iterator<Item = PixelWindow> {
        let region = *self;
        region.area.positions().map(move |(x, y)| region.window(x, y))
    }

    fn reference(&self) -> Option<impl Iterator<Item = u16>> {
        self.reference.map(|frame| self.area.pixels(frame))
    }
}

/// Returns SRS for the votes of the features.
pub(crate) fn combine_votes(
    combine: VoteCombination,
    mut votes: impl Iterator<Item = bool>,
) -> bool {
    match combine {
        VoteCombination::Any => votes.any(|vote| vote),
        VoteCombination::All => votes.all(|vote| vote),
    }
}

/// Returns the action on a region for its SRS and TRS. `is_summary_due` is called only if
/// irrelevant regions send their means.
pub fn region_action(
    irrelevant: IrrelevantRendering,
    srs: bool,
    trs: bool,
    is_summary_due: impl FnOnce() -> bool,
) -> RegionAction {
    match (trs, srs) {
        (true, true) => RegionAction::Forward,
        (false, true) => RegionAction::Hold,
        (_, false) => match irrelevant {
            IrrelevantRendering::Zero => RegionAction::Blank,
            IrrelevantRendering::Hold => RegionAction::Hold,
            IrrelevantRendering::Mean if is_summary_due() => RegionAction::Summarize,
            IrrelevantRendering::Mean => RegionAction::Hold,
        },
    }
}
