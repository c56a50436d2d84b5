// SPDX-License-Identifier: MIT OR Apache-2.0
//! The points as a table, with one list of columns for CSV and Parquet.

use foveate_camera::FeatureKind;
use foveate_estimate::FrameRate;
use foveate_measure::FidelityFigures;
use foveate_output::tables::{NamedCells, TableCell};

use crate::LoadFigures;
use crate::row::{DesignRow, count_to_f64};
use crate::{ProcessEnergy, ProcessFigures};

pub(crate) fn point_cells(row: &DesignRow, axes: &[String]) -> NamedCells {
    let mut cells: NamedCells = vec![("point".to_owned(), count_cell(row.number as u64))];
    let settings = axes.iter().zip(&row.settings);
    cells.extend(settings.map(|(axis, value)| (axis.clone(), TableCell::Text(value.clone()))));
    cells.extend(error_cells(&row.figures));
    let worst = row.worst_clip.as_ref();
    let name = worst.map(|clip| clip.name.clone()).unwrap_or_default();
    cells.push(("worst_clip".to_owned(), TableCell::Text(name)));
    let flips = TableCell::Real(worst.map(|clip| clip.action_flips));
    cells.push(("worst_clip_flips".to_owned(), flips));
    let area = row.silicon.as_ref();
    let of = |take: fn(&crate::DesignArea) -> u64| TableCell::Count(area.map(take));
    let at = |take: fn(&FrameRate) -> f64| TableCell::Real(row.speed.as_ref().map(take));
    cells.extend(
        [
            ("bytes_per_frame", TableCell::Real(Some(row.bytes_per_frame))),
            ("clocks_per_frame", count_cell(row.clocks_per_frame)),
            ("clock_mhz", at(|speed| speed.clock_mhz)),
            ("low_clock_mhz", at(|speed| speed.low_clock_mhz)),
            ("high_clock_mhz", at(|speed| speed.high_clock_mhz)),
            ("frames_per_second", at(|speed| speed.frames_per_second)),
            ("unit_lut", of(|area| area.unit.lut_total_packed)),
            ("unit_ff", of(|area| area.unit.ff)),
            ("unit_lutram", of(|area| area.unit.lut_memory_packed)),
            ("units", of(|area| area.units)),
            ("lut", of(|area| area.array.lut_total_packed)),
            ("ff", of(|area| area.array.ff)),
            ("lutram", of(|area| area.array.lut_memory_packed)),
            ("ramb36", TableCell::Real(area.map(|area| count_to_f64(area.array.bram18) / 2.0))),
            ("dsp", of(|area| area.array.dsp)),
            ("device_share", TableCell::Real(row.device_share)),
            ("logic_levels", of(|area| area.logic_levels.into())),
            ("front_speed", TableCell::Flag(row.front.speed)),
            ("front_area", TableCell::Flag(row.front.area)),
            ("front_energy", TableCell::Flag(row.front.energy)),
            ("fingerprint", TableCell::Text(row.fingerprint.clone())),
        ]
        .map(|(name, cell)| (name.to_owned(), cell)),
    );
    cells
}

/// Returns the cells of the cost in a process, which are empty without one.
pub(crate) fn process_cells(row: &DesignRow) -> NamedCells {
    let (process, energy) = (row.process.as_ref(), row.energy());
    let at = |take: fn(&ProcessFigures) -> f64| TableCell::Real(process.map(take));
    let of = |take: fn(&ProcessEnergy) -> f64| TableCell::Real(energy.map(take));
    let bits = process.map(|process| process.memory_bits_without_macro);
    [
        ("unit_um2", at(|process| process.unit_um2)),
        ("mm2", TableCell::Real(process.and_then(|process| process.mm2))),
        ("memory_bits_without_macro", TableCell::Count(bits)),
        ("process_clock_mhz", at(|process| process.clock_mhz)),
        ("nj_per_region", of(|energy| energy.nj_per_region)),
        ("usual_mw", of(|energy| energy.usual_mw)),
        ("busiest_mw", of(|energy| energy.busiest_mw)),
    ]
    .map(|(name, cell)| (name.to_owned(), cell))
    .into()
}

/// Returns the cells of a load, which are empty without one.
pub(crate) fn load_cells(load: Option<&LoadFigures>) -> NamedCells {
    let of = |take: fn(&LoadFigures) -> Option<u64>| TableCell::Count(load.and_then(take));
    [
        ("needed_clock_hz", of(|load| Some(load.needed_clock_hz))),
        ("delivery_longest_ns", of(|load| load.delivery_longest_ns)),
        ("buffer_bytes", of(|load| load.buffer_bytes)),
        ("overloaded_clips", of(|load| load.overloaded_clips)),
        ("unbuffered_lost_regions", of(|load| load.unbuffered_lost_regions)),
        ("unbuffered_frames_with_losses", of(|load| load.unbuffered_frames_with_losses)),
    ]
    .map(|(name, cell)| (name.to_owned(), cell))
    .into()
}

pub(crate) fn name_cells(point: usize, clip: &str) -> NamedCells {
    vec![
        ("point".to_owned(), count_cell(point as u64)),
        ("clip".to_owned(), TableCell::Text(clip.to_owned())),
    ]
}

pub(crate) fn error_cells(figures: &FidelityFigures) -> NamedCells {
    let real = |value: f64| TableCell::Real(Some(value));
    let mut cells: NamedCells = [
        ("frames", count_cell(figures.frames)),
        ("active", real(figures.active)),
        ("ideal_active", real(figures.ideal_active)),
        ("srs_flips", real(figures.srs_flips)),
        ("trs_flips", real(figures.trs_flips)),
        ("action_flips", real(figures.action_flips)),
        ("missed", real(figures.missed)),
        ("false_alarms", real(figures.false_alarms)),
        ("active_iou", real(figures.active_iou)),
        ("psnr_ideal", TableCell::Real(figures.psnr_ideal)),
        ("ssim_ideal", real(figures.ssim_ideal)),
        ("psnr_input", TableCell::Real(figures.psnr_input)),
        ("ssim_input", real(figures.ssim_input)),
        ("stale_regions", real(figures.stale_regions)),
        ("stale_max", real(figures.staleness.max)),
        ("stale_mean", real(figures.staleness.mean)),
        ("stale_share", real(figures.staleness.share)),
        ("stale_frames", count_cell(figures.staleness.longest)),
    ]
    .map(|(name, cell)| (name.to_owned(), cell))
    .into();
    for feature in score_names() {
        let score = figures.scores.iter().find(|score| score.feature == feature);
        let of = |take: fn(&foveate_measure::ScoreError) -> f64| TableCell::Real(score.map(take));
        cells.push((format!("{feature}_max"), of(|score| score.max)));
        cells.push((format!("{feature}_mean"), of(|score| score.mean)));
        cells.push((format!("{feature}_rms"), of(|score| score.rms)));
    }
    cells
}

/// Returns the name of every score that can be compared. All spaces have the same columns, so that
/// tables can be joined.
fn score_names() -> impl Iterator<Item = &'static str> {
    FeatureKind::ALL.iter().map(|kind| kind.name()).chain(["temporal"])
}

fn count_cell(value: u64) -> TableCell {
    TableCell::Count(Some(value))
}
