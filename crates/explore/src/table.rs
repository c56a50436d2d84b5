// SPDX-License-Identifier: MIT OR Apache-2.0
//! The points as a table, with one list of columns for CSV and Parquet.

use foveate_design::FeatureKind;
use foveate_estimate::Speed;
use foveate_fidelity::Figures;
use foveate_files::tables::{Cell, Cells};

use crate::row::{DesignRow, real};

/// Returns the cells of a point.
pub(crate) fn point(row: &DesignRow, axes: &[String]) -> Cells {
    let mut cells: Cells = vec![("point".to_owned(), count(row.number as u64))];
    let settings = axes.iter().zip(&row.settings);
    cells.extend(settings.map(|(axis, value)| (axis.clone(), Cell::Text(value.clone()))));
    cells.extend(errors(&row.figures));
    let area = row.silicon.as_ref();
    let of = |take: fn(&crate::Silicon) -> u64| Cell::Count(area.map(take));
    let at = |take: fn(&Speed) -> f64| Cell::Real(row.speed.as_ref().map(take));
    cells.extend(
        [
            ("bytes_per_frame", Cell::Real(Some(row.bytes_per_frame))),
            ("clocks_per_frame", count(row.clocks_per_frame)),
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
            ("ramb36", Cell::Real(area.map(|area| real(area.array.bram18) / 2.0))),
            ("dsp", of(|area| area.array.dsp)),
            ("logic_levels", of(|area| area.levels.into())),
            ("front_speed", Cell::Flag(row.front.speed)),
            ("front_area", Cell::Flag(row.front.area)),
            ("front", Cell::Flag(row.front.all)),
            ("fingerprint", Cell::Text(row.fingerprint.clone())),
        ]
        .map(|(name, cell)| (name.to_owned(), cell)),
    );
    cells
}

/// Returns the cells that name the point and the clip of a row.
pub(crate) fn names(point: usize, clip: &str) -> Cells {
    vec![
        ("point".to_owned(), count(point as u64)),
        ("clip".to_owned(), Cell::Text(clip.to_owned())),
    ]
}

/// Returns the cells of the errors.
pub(crate) fn errors(figures: &Figures) -> Cells {
    let real = |value: f64| Cell::Real(Some(value));
    let mut cells: Cells = [
        ("frames", count(figures.frames)),
        ("active", real(figures.active)),
        ("ideal_active", real(figures.ideal_active)),
        ("srs_flips", real(figures.srs_flips)),
        ("trs_flips", real(figures.trs_flips)),
        ("action_flips", real(figures.action_flips)),
        ("missed", real(figures.missed)),
        ("false_alarms", real(figures.false_alarms)),
        ("active_iou", real(figures.active_iou)),
        ("psnr_ideal", Cell::Real(figures.psnr_ideal)),
        ("ssim_ideal", real(figures.ssim_ideal)),
        ("psnr_input", Cell::Real(figures.psnr_input)),
        ("ssim_input", real(figures.ssim_input)),
        ("stale_max", real(figures.staleness.max)),
        ("stale_mean", real(figures.staleness.mean)),
        ("stale_share", real(figures.staleness.share)),
        ("stale_frames", count(figures.staleness.longest)),
    ]
    .map(|(name, cell)| (name.to_owned(), cell))
    .into();
    for feature in score_names() {
        let score = figures.scores.iter().find(|score| score.feature == feature);
        let of = |take: fn(&foveate_fidelity::ScoreError) -> f64| Cell::Real(score.map(take));
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

fn count(value: u64) -> Cell {
    Cell::Count(Some(value))
}
