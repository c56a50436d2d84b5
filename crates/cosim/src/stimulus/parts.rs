// SPDX-License-Identifier: MIT OR Apache-2.0
//! The caller's frames, as the simulated array or core sees them.

use crate::error::CosimError;
use foveate_design::{Design, SerialDesign};
use foveate_frame::Frame;

/// Clocks of all the parts that go through a single lane or core, at most; they are spread over the frame.
pub(super) const MAX_CLOCKS: u64 = 1 << 21;

/// The first regions of the lanes of a design whose frames go through one lane: all, or as many, evenly
/// spread, as `clocks` per part allow.
pub(super) fn first_regions(design: SerialDesign<'_>, clocks: u64) -> Vec<u32> {
    let lanes = u64::from(design.lanes());
    let affordable = (MAX_CLOCKS / clocks.max(1)).clamp(1, lanes);
    let nth = |number: u64| u32::try_from(number * lanes / affordable).expect("it is a lane");
    (0..affordable).map(|number| nth(number) * design.fold()).collect()
}

/// What one lane sees of a frame: its regions, side by side. What is beyond them repeats their border, as at
/// the border of a frame.
pub(super) fn of_lane(
    design: SerialDesign<'_>,
    frame: &Frame,
    first: u32,
) -> Result<Frame, CosimError> {
    let (side, fold) = (design.region_size(), design.fold());
    cut(&design, frame, (fold * side, side), |x, y| {
        let region = (first + x / side).min(design.regions() - 1);
        let (column, row) = (region % design.columns(), region / design.columns());
        (column * side + x % side, row * side + y)
    })
}

/// The upper left of a frame, as much as a design takes.
pub(super) fn upper_left(design: &Design, frame: &Frame) -> Result<Frame, CosimError> {
    cut(design, frame, (design.width(), design.height()), |x, y| (x, y))
}

/// The part of a frame of which `place` says where its pixels are; beyond the frame they repeat its border.
pub(super) fn cut(
    design: &Design,
    frame: &Frame,
    (width, height): (u32, u32),
    place: impl Fn(u32, u32) -> (u32, u32),
) -> Result<Frame, CosimError> {
    let pixel = |x, y| {
        let (x, y) = place(x, y);
        frame.clamped(x.into(), y.into())
    };
    Frame::from_fn(width, height, design.pixel_bits(), pixel)
        .map_err(|error| CosimError::Model { reason: error.to_string() })
}
