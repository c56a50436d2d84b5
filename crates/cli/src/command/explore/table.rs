// SPDX-License-Identifier: MIT OR Apache-2.0
//! The points of an exploration as text and as Markdown.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use foveate_camera::{FeatureKind, ScoreUnit};
use foveate_estimate::ramb36;
use foveate_explore::{DesignRow, Exploration, ProcessEnergy};
use foveate_output::report::ReportTable;
use foveate_tools::escaping::shell_word;

/// A column: its name, and the function that writes its cells.
type PointColumn = (&'static str, fn(&DesignRow) -> String);

const COLUMNS: [PointColumn; 25] = [
    ("flips %", |row| percent(row.figures.action_flips)),
    ("missed %", |row| percent(row.figures.missed)),
    ("false %", |row| percent(row.figures.false_alarms)),
    ("stale %", |row| percent(row.figures.stale_regions)),
    ("worst clip", |row| {
        let clip = row.worst_clip.as_ref();
        clip.map_or_else(String::new, |clip| {
            format!("{} {}", percent(clip.action_flips), clip.name)
        })
    }),
    ("SRS %", |row| percent(row.figures.srs_flips)),
    ("TRS %", |row| percent(row.figures.trs_flips)),
    ("IoU", |row| format!("{:.3}", row.figures.active_iou)),
    ("active %", |row| percent(row.figures.active)),
    ("score errors", score_errors),
    ("PSNR ideal", |row| decibels(row.figures.psnr_ideal)),
    ("SSIM ideal", |row| format!("{:.3}", row.figures.ssim_ideal)),
    ("PSNR input", |row| decibels(row.figures.psnr_input)),
    ("stale", |row| {
        let stale = &row.figures.staleness;
        format!("{:.0}/{:.2}/{}", stale.max, stale.mean, stale.longest)
    }),
    ("bytes", |row| format!("{:.0}", row.bytes_per_frame)),
    ("clocks", |row| row.clocks_per_frame.to_string()),
    ("MHz", |row| row.speed.map_or_else(String::new, |speed| speed.clock_text())),
    ("frames/s", |row| row.speed.map_or_else(String::new, |speed| speed.rate_text())),
    ("LUT/FF/mem", unit_cell),
    ("array LUT", array_cell),
    ("device %", |row| {
        row.device_share.map_or_else(String::new, |share| format!("{:.3}", 100.0 * share))
    }),
    ("unit um2", |row| {
        row.process.as_ref().map_or_else(String::new, |process| format!("{:.0}", process.unit_um2))
    }),
    ("mm2", |row| {
        let mm2 = row.process.as_ref().and_then(|process| process.mm2);
        mm2.map_or_else(String::new, |mm2| format!("{mm2:.3}"))
    }),
    ("nJ/region", |row| energy_cell(row, |energy| energy.nj_per_region)),
    ("mW", |row| energy_cell(row, |energy| energy.usual_mw)),
];

fn percent(share: f64) -> String {
    format!("{:.2}", share * 100.0)
}

fn decibels(value: Option<f64>) -> String {
    value.map_or_else(|| "same".to_owned(), |value| format!("{value:.1}"))
}

/// Returns the largest, mean and RMS error of every score that can be compared.
fn score_errors(row: &DesignRow) -> String {
    let score = |score: &foveate_explore::ScoreError| {
        let digits = |value: f64| {
            format!("{value:.3}").trim_end_matches('0').trim_end_matches('.').to_owned()
        };
        format!(
            "{} {}/{}/{}",
            score.feature,
            digits(score.max),
            digits(score.mean),
            digits(score.rms)
        )
    };
    row.figures.scores.iter().map(score).collect::<Vec<_>>().join(", ")
}

fn unit_cell(row: &DesignRow) -> String {
    let figures = row.silicon.as_ref().map(|silicon| &silicon.unit);
    figures.map_or_else(String::new, |unit| {
        format!("{}/{}/{}", unit.lut_total_packed, unit.ff, unit.lut_memory_packed)
    })
}

fn array_cell(row: &DesignRow) -> String {
    let figures = row.silicon.as_ref().map(|silicon| &silicon.array);
    figures.map_or_else(String::new, |array| match array.bram18 {
        0 => array.lut_total_packed.to_string(),
        bram => format!("{} + {} RAMB36", array.lut_total_packed, ramb36(bram)),
    })
}

fn energy_cell(row: &DesignRow, take: fn(&ProcessEnergy) -> f64) -> String {
    row.energy().map_or_else(String::new, |energy| format!("{:.4}", take(energy)))
}

/// Returns the columns that have a figure for a point.
fn measured_columns(found: &Exploration) -> Vec<PointColumn> {
    let has_figure = |(_, cell): &PointColumn| found.rows.iter().any(|row| !cell(row).is_empty());
    COLUMNS.into_iter().filter(has_figure).collect()
}

/// Returns the note on the columns of a table.
fn column_note() -> String {
    let with_unit = |unit: ScoreUnit, others: &[&'static str]| {
        let kinds = FeatureKind::ALL.iter().filter(|kind| kind.score_unit() == unit);
        let names: Vec<_> = kinds.map(|kind| kind.name()).chain(others.iter().copied()).collect();
        match names.split_last() {
            Some((last, [_, ..])) => format!("{} and {last}", names[..names.len() - 1].join(", ")),
            _ => names.concat(),
        }
    };
    format!(
        "flips, SRS, TRS: regions whose decision differs from that of the ideal camera. missed: of its active regions, \
         not active in the design; false: of the design's active regions, not active in the ideal camera; both without \
         the first frame of every clip. stale %: of the relevant regions, those whose screen differs from the design's \
         own denoised frame. worst clip: the clip with the most flips. IoU: of the active areas. score errors: largest, \
         mean, RMS; {counts} as share of a region's pixels, {levels} in grey levels, {squares} in their squares. PSNR \
         and SSIM of the screen against the ideal's, and against the input. stale: largest and mean difference of the \
         screen from the scene in relevant regions in grey levels, and frames in a row that a region was stale. MHz: the \
         clock, with its range if it is estimated. frames/s: at that clock. LUT/FF/mem: one RPU or lane. device %: the \
         share of an XCVU9P.",
        counts = with_unit(ScoreUnit::Pixels, &["temporal"]),
        levels = with_unit(ScoreUnit::Levels, &[]),
        squares = with_unit(ScoreUnit::SquaredLevels, &[]),
    )
}

const PROCESS_NOTE: &str = "unit um2, mm2, nJ/region, mW: in the cells of the process; they are lower bounds. MHz is \
     not above the highest clock of the cells.";

pub(super) fn markdown(found: &Exploration) -> String {
    let columns = measured_columns(found);
    let names = std::iter::once("").chain(columns.iter().map(|(name, _)| *name));
    let mut table = ReportTable::of_words(names);
    table.rows.extend(found.rows.iter().map(|row| {
        let cells = columns.iter().map(|(_, cell)| cell(row));
        std::iter::once(found.settings_text(row)).chain(cells).collect()
    }));
    let note = found.library.is_some().then(|| format!("\n{PROCESS_NOTE}"));
    table.notes.push(column_note() + &note.unwrap_or_default());
    // The first heading is one space.
    table.markdown().replacen("|  |", "| |", 1)
}

/// Returns a short text: at most eight points of every front with a line that generates each, and
/// the files with all points.
pub(super) fn text(folder: &Path, found: &Exploration, width: usize) -> String {
    let plural = if found.rows.len() == 1 { "" } else { "s" };
    let mut text = format!("{} design{plural}\n", found.rows.len());
    for finding in found.findings() {
        let _ = writeln!(text, "{}", textwrap::fill(&finding, width));
    }
    let mut seen = BTreeSet::new();
    for front in found.fronts() {
        let _ = writeln!(text, "\n{}: {} on the front", front.title, front.rows.len());
        for row in front.named_rows() {
            let settings = format!("{}: {}", row.number, found.settings_text(row));
            let _ = writeln!(text, "\n{}", textwrap::fill(&settings, width));
            if !seen.insert(row.number) {
                let _ = writeln!(text, "  as above");
                continue;
            }
            for line in row.figure_lines() {
                for line in textwrap::wrap(&line, width.saturating_sub(2)) {
                    let _ = writeln!(text, "  {line}");
                }
            }
            let design = folder.join("designs").join(format!("{}.toml", row.number));
            let design = design.display().to_string();
            let design = shell_word(&design);
            let _ = writeln!(text, "  foveate generate --config {design} -o core-{}", row.number);
        }
    }
    let _ = writeln!(
        text,
        "\n{}: report.html, points.csv, points.parquet, clips.csv, designs/",
        folder.display()
    );
    text
}
