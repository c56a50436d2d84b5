// SPDX-License-Identifier: MIT OR Apache-2.0
//! The transformation from the frame that a box file describes to the frame that a camera sees:
//! first cropped, then scaled.

use crate::{CropRect, FrameOrigin, SourceFrame};
use foveate_pixels::Rect;

/// A box is not counted if less than this share of it lies in the frame.
const LEAST_INSIDE: f64 = 0.25;

/// A part of a frame, and the size to which it is scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoxView {
    /// The column and row of the part's upper left pixel.
    pub part_origin: (u32, u32),
    /// The width and height of the part before it is scaled.
    pub part_size: (u32, u32),
    /// The width and height of the part after it is scaled.
    pub scaled_size: (u32, u32),
}

impl BoxView {
    /// Makes the view of a frame with this origin, which may have been cropped.
    #[must_use]
    pub fn from_source_frame(
        frame: &SourceFrame,
        origin: &FrameOrigin,
        crop: Option<CropRect>,
    ) -> Self {
        let CropRect { size: part, origin: at } =
            crop.unwrap_or(CropRect { size: origin.size, origin: (0, 0) });
        Self {
            part_origin: at,
            part_size: part,
            scaled_size: (frame.frame.width(), frame.frame.height()),
        }
    }

    /// Transforms a box into the coordinates of the scaled frame, without cutting it at the
    /// borders.
    #[must_use]
    pub fn transform(&self, rect: &Rect) -> Rect {
        let scale = |seen: u32, part: u32| f64::from(seen) / f64::from(part);
        rect.moved(-f64::from(self.part_origin.0), -f64::from(self.part_origin.1)).scaled(
            scale(self.scaled_size.0, self.part_size.0),
            scale(self.scaled_size.1, self.part_size.1),
        )
    }

    /// Transforms a box into the coordinates of the scaled frame and cuts it at the borders.
    /// Returns `None` if less than a quarter of its area lies inside, or if it has no area.
    #[must_use]
    pub fn transform_and_cut(&self, rect: &Rect) -> Option<Rect> {
        let whole = self.transform(rect);
        let inside = whole.cropped_to_frame(self.scaled_size);
        let enough = inside.area() >= LEAST_INSIDE * whole.area();
        (enough && inside.area() > 0.0).then_some(inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rect(corners: [f64; 4]) -> Rect {
        Rect::from_corners(corners).unwrap()
    }

    #[test]
    fn boxes_follow_the_crop_and_the_scale() {
        let view =
            BoxView { part_origin: (100, 50), part_size: (200, 100), scaled_size: (100, 100) };
        assert_eq!(
            view.transform_and_cut(&rect([110., 60., 130., 80.])),
            Some(rect([5., 10., 15., 30.]))
        );
        // A half, a quarter, and less than a quarter of the box lie inside.
        assert_eq!(
            view.transform_and_cut(&rect([90., 60., 110., 80.])),
            Some(rect([0., 10., 5., 30.]))
        );
        assert_eq!(
            view.transform_and_cut(&rect([85., 60., 105., 80.])),
            Some(rect([0., 10., 2.5, 30.]))
        );
        assert_eq!(view.transform_and_cut(&rect([84., 60., 104., 80.])), None);
        assert_eq!(view.transform_and_cut(&rect([0., 0., 50., 50.])), None);
        assert_eq!(view.transform_and_cut(&rect([110., 60., 110., 80.])), None, "it has no area");
    }
}
