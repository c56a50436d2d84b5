// SPDX-License-Identifier: MIT OR Apache-2.0
//! The way from a box in a file to regions. A [`BoxView`] transforms it from the frame that the
//! file describes to the frame that a camera sees: first cropped, then scaled. A [`RegionGrid`]
//! finds the regions that belong to it.
//!
//! A column of regions belongs to a box if at least half of the column's width lies between the
//! left and the right side of the box. The same rule holds for rows. The regions of the box are
//! those in its columns and its rows. So a box is rounded to whole regions, and regions that
//! are mostly background do not count. If a narrow box covers no column by half, it has the
//! column in which most of it lies, or the first of two equal ones. So every box has at least
//! one region in each direction.

use crate::{CropRect, FrameOrigin, SourceFrame};
use foveate_pixels::Rect;
use std::ops::Range;

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

/// A box, and the track of its object if the file has tracks.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelledBox {
    /// The position of the object, in pixels of the frame before it is cropped and scaled.
    pub rect: Rect,
    /// The number of the object, which is the same in all frames.
    pub track: Option<u64>,
}

/// The boxes of an image, and its width and height, if the file states them.
#[derive(Debug, Default)]
pub(crate) struct ImageBoxes {
    pub(crate) size: Option<(u32, u32)>,
    pub(crate) boxes: Vec<LabelledBox>,
}

/// The grid of regions of a frame. Regions are squares from the upper left corner, cut at the right
/// and lower border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RegionGrid {
    /// The side of a region in pixels.
    pub side: u32,
    /// The width of the frame in pixels.
    pub width: u32,
    /// The height of the frame in pixels.
    pub height: u32,
}

impl RegionGrid {
    /// Returns how many regions of a box have their vote set, and how many regions the box has.
    #[must_use]
    pub fn count_votes(&self, rect: &Rect, votes: &[bool]) -> (u64, u64) {
        self.regions(rect)
            .fold((0, 0), |(yes, all), region| (yes + u64::from(votes[region]), all + 1))
    }

    /// Returns the regions of a box, numbered row by row. The box must lie in the frame and have an
    /// area.
    pub fn regions(&self, rect: &Rect) -> impl Iterator<Item = usize> + use<> {
        let columns = covered_lines((rect.x0, rect.x1), self.side, self.width);
        let rows = covered_lines((rect.y0, rect.y1), self.side, self.height);
        let per_row = self.width.div_ceil(self.side) as usize;
        rows.flat_map(move |row| {
            columns.clone().map(move |column| row as usize * per_row + column as usize)
        })
    }
}

/// Returns the columns of a box from its left and right side, or the rows from its upper and lower
/// side, in a frame of this size.
fn covered_lines((from, to): (f64, f64), side: u32, size: u32) -> Range<u32> {
    let begin = |line: u32| f64::from(line * side);
    let end = |line: u32| f64::from((line * side).saturating_add(side).min(size));
    let inside = |line: u32| to.min(end(line)) - from.max(begin(line));
    let count = size.div_ceil(side);
    let touched = line_at(from, side, count)..line_at(to, side, count) + 1;
    let half = |line: &u32| 2.0 * inside(*line) >= end(*line) - begin(*line);
    let first = touched.clone().find(half);
    match first.zip(touched.clone().rfind(half)) {
        Some((first, last)) => first..last + 1,
        None => {
            let larger = |best, line| if inside(line) > inside(best) { line } else { best };
            let most = touched.clone().fold(touched.start, larger);
            most..most + 1
        }
    }
}

/// Returns the row or column in which a coordinate lies. A coordinate at the far border belongs to
/// the last one.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the frame")]
fn line_at(at: f64, side: u32, count: u32) -> u32 {
    ((at / f64::from(side)).floor() as u32).min(count - 1)
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

    const GRID: RegionGrid = RegionGrid { side: 8, width: 36, height: 20 };

    fn of(corners: [f64; 4]) -> Vec<usize> {
        GRID.regions(&Rect::from_corners(corners).unwrap()).collect()
    }

    #[test]
    fn regions_of_known_boxes() {
        // The grid has five columns, the last 4 pixels wide, and three rows, the last 4 pixels
        // high.
        assert_eq!(of([0., 0., 8., 8.]), [0]);
        assert_eq!(of([4., 0., 12., 8.]), [0, 1], "half of two columns");
        assert_eq!(of([5., 0., 12., 8.]), [1], "less than half of the first");
        assert_eq!(of([0., 0., 36., 20.]), (0..15).collect::<Vec<_>>());
        assert_eq!(of([34., 18., 36., 20.]), [14], "half of what is there of the last region");
        assert_eq!(of([1., 1., 2., 2.]), [0], "smaller than a region");
        assert_eq!(of([7., 7., 10., 10.]), [6], "most of it is in the fourth of four regions");
        assert_eq!(of([6., 6., 10., 10.]), [0], "the first of four equal ones");
        assert_eq!(of([9., 0., 11., 20.]), [1, 6, 11], "a narrow one has a line of regions");
    }
}
