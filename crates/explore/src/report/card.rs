// SPDX-License-Identifier: MIT OR Apache-2.0
//! The card of a point, with all its figures.

use foveate_estimate::ramb36;
use foveate_output::number_text::{grouped, percent, real_number};
use foveate_output::page::TableCell;

use super::setting::PointSettings;
use crate::objective::Objective;
use crate::{DesignRow, ProcessFigures};

/// The card of a point on the page.
pub(crate) struct PointCard {
    pub(crate) number: usize,
    pub(crate) front: bool,
    pub(crate) settings: String,
    /// The figures, each with its name and value.
    pub(crate) facts: Vec<(String, String)>,
    /// The configuration as TOML.
    pub(crate) toml: String,
}

impl PointCard {
    pub(crate) fn new(row: &DesignRow, settings: &PointSettings) -> Self {
        let figures = &row.figures;
        let share = |value: f64| format!("{} %", percent(value));
        let mut facts = vec![
            (
                "Flipped actions, SRS, TRS",
                [figures.action_flips, figures.srs_flips, figures.trs_flips].map(share).join(", "),
            ),
            (
                "Active, of the ideal, IoU",
                format!(
                    "{}, {}",
                    [figures.active, figures.ideal_active].map(share).join(", "),
                    real_number(figures.active_iou, 4)
                ),
            ),
            (
                "PSNR and SSIM to the input",
                format!(
                    "{} dB, {}",
                    TableCell::psnr(figures.psnr_input).text,
                    real_number(figures.ssim_input, 4)
                ),
            ),
            (
                "Stale",
                format!(
                    "{} of the relevant regions; the scene by up to {} grey levels, for up to {} frames",
                    share(figures.stale_regions),
                    real_number(figures.staleness.max, 0),
                    grouped(figures.staleness.longest)
                ),
            ),
            ("Clocks per frame", grouped(row.clocks_per_frame)),
        ];
        facts.extend(row.speed.map(|speed| ("Speed", speed.text())));
        if let Some(silicon) = &row.silicon {
            let array = &silicon.array;
            facts.push((
                "Area",
                format!(
                    "{} units; unit {} LUTs, {} FF; array {} LUTs, {} FF, {} DSP, {} RAMB36; {} logic levels",
                    grouped(silicon.units),
                    grouped(silicon.unit.lut_total_packed),
                    grouped(silicon.unit.ff),
                    grouped(array.lut_total_packed),
                    grouped(array.ff),
                    grouped(array.dsp),
                    ramb36(array.bram18),
                    silicon.logic_levels
                ),
            ));
        }
        facts.extend(row.process.as_ref().map(|process| ("Silicon", process_text(process))));
        let facts = facts.into_iter().map(|(name, text)| (name.to_owned(), text));
        let scores = figures.scores.iter().map(|score| {
            let [max, mean, rms] = [score.max, score.mean, score.rms].map(error_text);
            let text = format!("max {max}, mean {mean}, rms {rms} ({})", score.unit);
            (format!("Error of {}", score.feature), text)
        });
        let fingerprint = ("Fingerprint".to_owned(), row.fingerprint.clone());
        Self {
            number: row.number,
            front: row.front.any(),
            settings: settings.settings_text(row, None),
            facts: facts.chain(scores).chain([fingerprint]).collect(),
            toml: row.config.to_toml(),
        }
    }
}

pub(crate) fn mark_title(row: &DesignRow, settings: &PointSettings) -> String {
    let [errors, costs] = row.figure_lines();
    format!("Point {}: {}\n{errors}\n{costs}", row.number, settings.settings_text(row, None))
}

impl DesignRow {
    /// Returns the figures of the decisions in a line, and the speed and the known costs in another
    /// one.
    #[must_use]
    pub fn figure_lines(&self) -> [String; 2] {
        let figures = &self.figures;
        let mut errors = format!(
            "{} % flipped, {} % missed, {} % false alarms, {} % stale",
            percent(figures.action_flips),
            percent(figures.missed),
            percent(figures.false_alarms),
            percent(figures.stale_regions)
        );
        if let Some(clip) = &self.worst_clip {
            errors +=
                &format!("; worst clip: {}, {} % flipped", clip.name, percent(clip.action_flips));
        }
        let speed = match self.speed {
            Some(speed) => speed.text(),
            None => format!("{} clocks per frame", grouped(self.clocks_per_frame)),
        };
        let share = self.silicon.as_ref().zip(self.device_share).map(|(silicon, share)| {
            let area = &silicon.array;
            let blocks = match area.bram18 {
                0 => String::new(),
                blocks => format!(" and {} RAMB36", ramb36(blocks)),
            };
            format!(
                ", {} LUTs{blocks}, {:.3} % of the device",
                grouped(area.lut_total_packed),
                100.0 * share
            )
        });
        let mm2 = Objective::Mm2.value_of(self).map(|mm2| format!(", {mm2:.3} mm²"));
        let energy = Objective::Energy.value_of(self).map(|nj| format!(", {nj:.3} nJ per region"));
        let costs: String = [share, mm2, energy].into_iter().flatten().collect();
        [errors, format!("{speed}, {} bytes/frame{costs}", real_number(self.bytes_per_frame, 0))]
    }
}

/// Returns the cost of a design in a process.
fn process_text(process: &ProcessFigures) -> String {
    let mut text = match process.mm2 {
        Some(mm2) => format!("{mm2:.3} mm²"),
        None => {
            let bits = grouped(process.memory_bits_without_macro);
            format!("no area, because no macro fits {bits} bits of memory")
        }
    };
    text += &format!(
        "; unit {} µm²; {:.1} MHz at most",
        real_number(process.unit_um2, 0),
        process.clock_mhz
    );
    if let Some(energy) = &process.energy {
        text += &format!(
            "; {:.3} nJ per region and frame; {:.4} mW at a rate of {}/s, in the busiest stretch {:.4} mW",
            energy.nj_per_region, energy.usual_mw, energy.frame_rate, energy.busiest_mw
        );
    }
    text
}

/// Formats the error of a score with two or three significant digits.
fn error_text(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if size < 0.001 => format!("{value:.1e}"),
        size if size < 1.0 => real_number(value, 4),
        size if size < 100.0 => real_number(value, 2),
        _ => real_number(value, 0),
    }
}
