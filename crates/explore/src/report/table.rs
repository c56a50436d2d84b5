// SPDX-License-Identifier: MIT OR Apache-2.0
//! The points as rows of a table.

use foveate_estimate::ramb36;
use foveate_pictures::page::number::real;
use foveate_pictures::page::{Cell, Column, Row};

use super::setting::{Settings, set};
use crate::row::real as number;
use crate::{DesignRow, Silicon};

/// The name, unit and meaning of every figure of the table.
const FIGURES: [(&str, &str, &str); 8] = [
    ("flipped", "%", "regions that the ideal camera treats differently on the screen"),
    ("missed", "%", "share of the ideal camera's active area that is not active here"),
    ("false", "%", "share of the active area here that is not active in the ideal camera"),
    ("IoU", "", "overlap of the active areas; 1 means equal"),
    ("PSNR", "dB", "rendered frame against that of the ideal camera; = means equal"),
    ("SSIM", "", "rendered frame against that of the ideal camera; 1 means equal"),
    ("stale", "levels", "mean difference of screen and scene in relevant regions, in grey levels"),
    ("bytes", "/frame", "bytes per frame that leave the array"),
];

/// The name, unit and meaning of every part of the area.
const AREA: [(&str, &str, &str); 5] = [
    ("LUT", "unit", "LUTs of one RPU, of one lane of a serial design, or of a raster core"),
    ("LUT", "array", "LUTs of the array, those used as memory included"),
    ("FF", "array", "flip-flops of the array"),
    ("LUTRAM", "array", "LUTs of the array used as memory, two SRL16 in one"),
    ("RAMB36", "array", "block RAM of the array; half of one is a RAMB18"),
];

/// Returns the headings after the number; with `area` also those of the area.
pub(crate) fn columns(settings: &Settings, area: bool) -> Vec<Column> {
    let axis = |name: &str, title: &str| Column {
        name: name.to_owned(),
        unit: "",
        title: title.to_owned(),
        numbers: false,
    };
    let axes: Vec<Column> = if settings.one_at_a_time {
        vec![axis("what is changed", "the one setting that differs from the start")]
    } else {
        settings.names.iter().zip(&settings.keys).map(|(name, key)| axis(name, key)).collect()
    };
    let figure = |(name, unit, title): (&str, &'static str, &str)| Column {
        name: name.to_owned(),
        unit,
        title: title.to_owned(),
        numbers: true,
    };
    let speed = [
        ("clock", "MHz", "estimated from the netlist, 25 % either way, if the space gives none"),
        ("frames", "/s", "frames per second at that clock"),
    ];
    let areas = if area { &AREA[..] } else { &[] };
    axes.into_iter()
        .chain(FIGURES.into_iter().chain(speed).map(figure))
        .chain(areas.iter().copied().map(figure))
        .collect()
}

/// Returns the row of a point, with as many cells as there are headings.
pub(crate) fn line(row: &DesignRow, settings: &Settings, area: bool) -> Row {
    let figures = &row.figures;
    let setting = |text: String, set: bool| {
        let class = if set { "" } else { "start" };
        Cell { class, ..Cell::words(text) }
    };
    let is_set = |axis: usize| row.settings.get(axis).is_some_and(|text| !text.is_empty());
    let mut cells: Vec<Cell> = if settings.one_at_a_time {
        vec![setting(settings.described(row, None), set(row).next().is_some())]
    } else {
        let axes = 0..settings.names.len();
        axes.map(|axis| setting(settings.value(row, axis), is_set(axis))).collect()
    };
    cells.extend([
        Cell::share(figures.action_flips),
        Cell::share(figures.missed),
        Cell::share(figures.false_alarms),
        Cell::number(real(figures.active_iou, 4), Some(figures.active_iou)),
        decibels(figures.psnr_ideal),
        Cell::number(real(figures.ssim_ideal, 4), Some(figures.ssim_ideal)),
        Cell::number(real(figures.staleness.mean, 2), Some(figures.staleness.mean)),
        Cell::number(real(row.bytes_per_frame, 0), Some(row.bytes_per_frame)),
    ]);
    cells.extend(match row.speed {
        Some(speed) => [
            Cell::number(real(speed.clock_mhz, 0), Some(speed.clock_mhz)),
            Cell::number(speed.rate_text(), Some(speed.frames_per_second)),
        ],
        None => [Cell::none(), Cell::none()],
    });
    if area {
        let of = |take: fn(&Silicon) -> u64| match &row.silicon {
            Some(silicon) => Cell::count(take(silicon)),
            None => Cell::none(),
        };
        cells.extend([
            of(|silicon| silicon.unit.lut_total_packed),
            of(|silicon| silicon.array.lut_total_packed),
            of(|silicon| silicon.array.ff),
            of(|silicon| silicon.array.lut_memory_packed),
            match &row.silicon {
                Some(Silicon { array, .. }) => {
                    Cell::number(ramb36(array.bram18), Some(number(array.bram18)))
                }
                None => Cell::none(),
            },
        ]);
    }
    Row { id: row.number.to_string(), number: row.number as u64, best: row.front.all, cells }
}

/// Formats a PSNR. Equal frames have no PSNR and are the best.
pub(crate) fn decibels(psnr: Option<f64>) -> Cell {
    match psnr {
        Some(psnr) => Cell::number(real(psnr, 1), Some(psnr)),
        None => Cell { text: "=".to_owned(), sort: "1e9".to_owned(), class: "number" },
    }
}
