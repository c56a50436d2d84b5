// SPDX-License-Identifier: MIT OR Apache-2.0
//! The marks of classes of regions in a picture: regions that are off are hatched, and a line in the
//! colour of the class surrounds the areas of regions that are keen or always relevant.

use foveate_camera::{Camera, RegionClass};
use foveate_output::palette::{Colour, SERIES};

use super::canvas::{BACKGROUND, PictureCanvas, PictureLayout};
use super::legend::{LegendKey, LegendMark};

/// The classes of the regions of a camera, with at least one that is not normal.
pub(super) struct ClassMarks<'a> {
    classes: &'a [RegionClass],
    columns: u32,
    rows: u32,
}

impl<'a> ClassMarks<'a> {
    /// Returns the marks of the map in a camera's configuration, or `None` if all of its regions are
    /// normal.
    pub(super) fn of_camera(camera: &'a Camera) -> Option<Self> {
        let classes = camera.zones()?.configured_classes();
        let is_marked = classes.iter().any(|&class| class != RegionClass::Normal);
        is_marked.then(|| Self { classes, columns: camera.columns(), rows: camera.rows() })
    }

    /// Draws the marks on the picture of a frame.
    pub(super) fn draw(&self, canvas: &mut PictureCanvas, cell: u32, layout: PictureLayout) {
        for (region, &class) in (0..).zip(self.classes) {
            let place = (region % self.columns, region / self.columns);
            let area = layout.region_area(cell, place);
            match class {
                RegionClass::Normal => {}
                RegionClass::Off => canvas.hatch(area, layout.dot),
                RegionClass::Keen | RegionClass::Always => {
                    self.draw_edges(canvas, place, area, layout.dot);
                }
            }
        }
    }

    /// Returns the keys of the classes that the map has.
    pub(super) fn legend_keys(&self) -> Vec<LegendKey> {
        let marked = RegionClass::ALL.iter().filter(|class| self.classes.contains(class));
        let key = |&class| {
            let mark = match class_colour(class) {
                Some(colour) => LegendMark::Border(colour),
                None if class == RegionClass::Off => LegendMark::Hatched,
                None => return None,
            };
            Some(LegendKey::new(mark, &format!("zone: {}", class.name())))
        };
        marked.filter_map(key).collect()
    }

    /// Draws a line on the sides of a region beyond which another class begins.
    fn draw_edges(
        &self,
        canvas: &mut PictureCanvas,
        (column, row): (u32, u32),
        [left, top, width, height]: [u32; 4],
        dot: u32,
    ) {
        let own = self.class_at(column, row);
        let colour = own.and_then(class_colour).unwrap_or(BACKGROUND);
        let line = dot.min(width).min(height);
        let ends =
            |x: Option<u32>, y: Option<u32>| x.zip(y).and_then(|(x, y)| self.class_at(x, y)) != own;
        let mut draw = |is_edge: bool, [left, top, width, height]: [u32; 4]| {
            if is_edge {
                canvas.fill_rectangle(left, top, width, height, colour);
            }
        };
        let (x, y) = (Some(column), Some(row));
        draw(ends(column.checked_sub(1), y), [left, top, line, height]);
        draw(ends(column.checked_add(1), y), [left + width - line, top, line, height]);
        draw(ends(x, row.checked_sub(1)), [left, top, width, line]);
        draw(ends(x, row.checked_add(1)), [left, top + height - line, width, line]);
    }

    fn class_at(&self, column: u32, row: u32) -> Option<RegionClass> {
        let is_inside = column < self.columns && row < self.rows;
        is_inside.then(|| self.classes[(row * self.columns + column) as usize])
    }
}

/// Returns the colour of the line around regions of a class.
fn class_colour(class: RegionClass) -> Option<Colour> {
    match class {
        RegionClass::Keen => Some(SERIES[0]),
        RegionClass::Always => Some(SERIES[1]),
        RegionClass::Normal | RegionClass::Off => None,
    }
}
