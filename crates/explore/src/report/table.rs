// SPDX-License-Identifier: MIT OR Apache-2.0
//! The points as rows of a table.

use foveate_estimate::ramb36;
use foveate_pictures::page::number_text::{percent, real_number};
use foveate_pictures::page::{TableCell, TableColumn, TableRow};

use super::setting::{PointSettings, axes_set};
use crate::row::count_to_f64 as number;
use crate::{DesignArea, DesignRow, LoadFigures, ProcessEnergy, ProcessFigures};

/// The name, unit and meaning of every figure of the table.
const FIGURES: [(&str, &str, &str); 7] = [
    ("flipped", "%", "regions that the ideal camera shows differently on the screen"),
    ("missed", "%", "share of the ideal camera's active area that is not active here"),
    ("false", "%", "share of the active area here that is not active in the ideal camera"),
    ("PSNR", "dB", "rendered frame against that of the ideal camera; = means equal"),
    ("SSIM", "", "rendered frame against that of the ideal camera; 1 means equal"),
    (
        "stale",
        "%",
        "of the relevant regions, those whose screen differs from the design's own denoised frame",
    ),
    ("bytes", "/frame", "bytes per frame that leave the array"),
];

/// The name, unit and meaning of every part of the area.
const AREA: [(&str, &str, &str); 4] = [
    (
        "share",
        "%",
        "share of the device that the array takes: LUTs, block RAM, DSP blocks and flip-flops",
    ),
    ("LUT", "array", "LUTs of the array, those used as memory included"),
    ("FF", "array", "flip-flops of the array"),
    ("RAMB36", "array", "block RAM of the array; half of one is a RAMB18"),
];

/// The name, unit and meaning of every figure of a design in front of a link.
const LINK: [(&str, &str, &str); 4] = [
    ("needs", "MHz", "the slowest clock that keeps up with every clip"),
    ("last byte", "ms", "longest time from reading a pixel to its last byte behind the link"),
    ("buffer", "bytes", "buffer in front of the link that loses nothing of these clips"),
    ("lost", "regions", "regions that a raster core loses without this buffer"),
];

/// The name, unit and meaning of the figures in a process.
const SILICON: [(&str, &str, &str); 3] = [
    ("unit", "µm²", "area of one RPU, lane or core in the cells of the process"),
    ("array", "mm²", "area of the array in the cells of the process, with memory macros"),
    ("highest", "MHz", "highest clock in the cells of the process"),
];

/// The name, unit and meaning of the figures of energy.
const ENERGY: [(&str, &str, &str); 2] = [
    ("energy", "nJ", "energy of a region in a frame, in the usual stretches of the clips"),
    (
        "power",
        "mW",
        "power of the array in the usual stretches of the clips, even if it cannot reach the frame rate",
    ),
];

/// The groups of columns that a table has only if they were measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeasuredGroups {
    pub(crate) area: bool,
    pub(crate) silicon: bool,
    pub(crate) energy: bool,
    pub(crate) link: bool,
    /// True if there are several clips.
    pub(crate) clips: bool,
}

/// The name, unit and meaning of the worst clip.
const WORST_CLIP: (&str, &str, &str) =
    ("worst clip", "%", "the clip on which the ideal camera shows the most regions differently");

/// Returns the headings after the number.
pub(crate) fn columns(settings: &PointSettings, groups: MeasuredGroups) -> Vec<TableColumn> {
    let axis = |name: &str, title: &str| TableColumn {
        name: name.to_owned(),
        unit: "",
        title: title.to_owned(),
        numbers: false,
    };
    let axes: Vec<TableColumn> = if settings.is_one_at_a_time {
        vec![axis("changed setting", "the one setting that differs from the start")]
    } else {
        settings.names.iter().zip(&settings.keys).map(|(name, key)| axis(name, key)).collect()
    };
    let figure = |(name, unit, title): (&str, &'static str, &str)| TableColumn {
        name: name.to_owned(),
        unit,
        title: title.to_owned(),
        numbers: true,
    };
    let clock = match groups.silicon {
        true => "that of the space, or the highest clock of the cells if it is lower",
        false => "estimated from the netlist, 25 % either way, if the space gives none",
    };
    let speed = [("clock", "MHz", clock), ("frames", "/s", "frames per second at that clock")];
    let areas = if groups.area { &AREA[..] } else { &[] };
    let silicon = if groups.silicon { &SILICON[..] } else { &[] };
    let energy = if groups.energy { &ENERGY[..] } else { &[] };
    let links = if groups.link { &LINK[..] } else { &[] };
    let worst = groups.clips.then_some(WORST_CLIP);
    axes.into_iter()
        .chain(worst.into_iter().map(figure))
        .chain(FIGURES.into_iter().chain(speed).map(figure))
        .chain(areas.iter().chain(silicon).chain(energy).chain(links).copied().map(figure))
        .collect()
}

/// Returns the row of a point, with as many cells as there are headings.
pub(crate) fn point_row(
    row: &DesignRow,
    settings: &PointSettings,
    groups: MeasuredGroups,
) -> TableRow {
    let figures = &row.figures;
    let setting = |text: String, set: bool| {
        let class = if set { "" } else { "start" };
        TableCell { class, ..TableCell::text(text) }
    };
    let is_set = |axis: usize| row.settings.get(axis).is_some_and(|text| !text.is_empty());
    let mut cells: Vec<TableCell> = if settings.is_one_at_a_time {
        vec![setting(settings.settings_text(row, None), axes_set(row).next().is_some())]
    } else {
        let axes = 0..settings.names.len();
        axes.map(|axis| setting(settings.value(row, axis), is_set(axis))).collect()
    };
    if groups.clips {
        let worst = row.worst_clip.as_ref().map(|clip| {
            let name: String = clip.name.chars().take(12).collect();
            let more = if name == clip.name { "" } else { "…" };
            let text = format!("{} {name}{more}", percent(clip.action_flips));
            TableCell::number(text, Some(clip.action_flips))
        });
        cells.push(worst.unwrap_or_else(TableCell::missing));
    }
    cells.extend([
        TableCell::share(figures.action_flips),
        TableCell::share(figures.missed),
        TableCell::share(figures.false_alarms),
        psnr_cell(figures.psnr_ideal),
        TableCell::number(real_number(figures.ssim_ideal, 4), Some(figures.ssim_ideal)),
        TableCell::share(figures.stale_regions),
        TableCell::number(real_number(row.bytes_per_frame, 0), Some(row.bytes_per_frame)),
    ]);
    cells.extend(match row.speed {
        Some(speed) => [
            TableCell::number(real_number(speed.clock_mhz, 0), Some(speed.clock_mhz)),
            TableCell::number(speed.rate_text(), Some(speed.frames_per_second)),
        ],
        None => [TableCell::missing(), TableCell::missing()],
    });
    if groups.area {
        let of = |take: fn(&DesignArea) -> u64| match &row.silicon {
            Some(silicon) => TableCell::count(take(silicon)),
            None => TableCell::missing(),
        };
        cells.push(row.device_share().map_or_else(TableCell::missing, |share| {
            TableCell::number(format!("{:.3}", 100.0 * share), Some(share))
        }));
        cells.extend([
            of(|silicon| silicon.array.lut_total_packed),
            of(|silicon| silicon.array.ff),
            match &row.silicon {
                Some(DesignArea { array, .. }) => {
                    TableCell::number(ramb36(array.bram18), Some(number(array.bram18)))
                }
                None => TableCell::missing(),
            },
        ]);
    }
    if groups.silicon {
        cells.extend(silicon_cells(row.process.as_ref()));
    }
    if groups.energy {
        cells.extend(energy_cells(row.energy()));
    }
    if groups.link {
        cells.extend(link_cells(row.load.as_ref()));
    }
    TableRow { id: row.number.to_string(), number: row.number as u64, best: row.front.any(), cells }
}

/// Returns the cells of the figures in a process, in the order of [`SILICON`].
fn silicon_cells(process: Option<&ProcessFigures>) -> [TableCell; SILICON.len()] {
    [
        real_cell(process.map(|process| process.unit_um2), 0),
        real_cell(process.and_then(|process| process.mm2), 3),
        real_cell(process.map(|process| process.clock_mhz), 1),
    ]
}

/// Returns the cells of the figures of energy, in the order of [`ENERGY`].
fn energy_cells(energy: Option<&ProcessEnergy>) -> [TableCell; ENERGY.len()] {
    [
        real_cell(energy.map(|energy| energy.nj_per_region), 3),
        real_cell(energy.map(|energy| energy.usual_mw), 4),
    ]
}

fn real_cell(value: Option<f64>, digits: usize) -> TableCell {
    let cell = |value| TableCell::number(real_number(value, digits), Some(value));
    value.map_or_else(TableCell::missing, cell)
}

/// Returns the cells of a load on the link, in the order of [`LINK`].
fn link_cells(load: Option<&LoadFigures>) -> [TableCell; LINK.len()] {
    let scaled = |value: Option<u64>, unit: f64| match value.map(|value| number(value) / unit) {
        Some(value) => TableCell::number(real_number(value, 3), Some(value)),
        None => TableCell::missing(),
    };
    let count = |value: Option<u64>| value.map_or_else(TableCell::missing, TableCell::count);
    [
        scaled(load.map(|load| load.needed_clock_hz), 1e6),
        scaled(load.and_then(|load| load.delivery_longest_ns), 1e6),
        count(load.and_then(|load| load.buffer_bytes)),
        count(load.and_then(|load| load.unbuffered_lost_regions)),
    ]
}

/// Formats a PSNR. Equal frames have no PSNR and are the best.
pub(crate) fn psnr_cell(psnr: Option<f64>) -> TableCell {
    match psnr {
        Some(psnr) => TableCell::number(real_number(psnr, 1), Some(psnr)),
        None => TableCell { text: "=".to_owned(), sort: "1e9".to_owned(), class: "number" },
    }
}
