// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report of a bench as a table: in lines as wide as the terminal, or in Markdown.

use foveate_cosim::{BenchmarkLevel, BenchmarkReport, LevelMeasurement, LevelRow};
use foveate_output::report::ReportTable;

use crate::output::paragraph;

const HEADINGS: [&str; 7] = ["frames", "clocks", "pixels", "x RTL", "memory", "build", "differ"];
/// The number of leading headings that count per second.
const RATE_COLUMNS: usize = 3;
/// The widths of the first cell and of the other cells, in columns of the terminal.
const FIRST_COLUMN_WIDTH: usize = 23;
const OTHER_COLUMN_WIDTH: usize = 8;
const TABLE_WIDTH: usize = FIRST_COLUMN_WIDTH + HEADINGS.len() * OTHER_COLUMN_WIDTH;

/// Returns a table if it fits into `width` columns, and otherwise a paragraph per level.
pub(super) fn text(report: &BenchmarkReport, width: usize) -> String {
    let mut text = if width < TABLE_WIDTH {
        String::new()
    } else {
        line("per second:", &HEADINGS.map(String::from))
    };
    for row in &report.rows {
        let title = row_title(row);
        text += &match (&row.measured, &row.missing) {
            (Some(measured), _) if width >= TABLE_WIDTH => line(&title, &cells(measured)),
            (Some(measured), _) => {
                let pairs = HEADINGS.iter().zip(cells(measured));
                let pairs: Vec<_> = pairs.map(|(name, cell)| format!("{name} {cell}")).collect();
                let (rates, rest) = pairs.split_at(RATE_COLUMNS);
                let (rates, rest) = (rates.join(", "), rest.join(", "));
                paragraph(&format!("{title}: per second {rates}; {rest}"), width)
            }
            (None, why) => paragraph(&format!("{title}: {}", why.as_deref().unwrap_or("")), width),
        };
    }
    text.push('\n');
    for note in notes(report) {
        text += &paragraph(&note, width);
    }
    text
}

pub(super) fn markdown(report: &BenchmarkReport) -> String {
    let mut table = ReportTable::of_words(std::iter::once("per second:").chain(HEADINGS));
    table.rows.extend(report.rows.iter().map(|row| {
        let missing = || vec![row.missing.clone().unwrap_or_default()];
        let cells = row.measured.as_ref().map_or_else(missing, |found| cells(found).to_vec());
        std::iter::once(row_title(row)).chain(cells).collect()
    }));
    table.notes.push(notes(report).join("\n"));
    table.markdown()
}

fn row_title(row: &LevelRow) -> String {
    format!("{} {}", level_name(row.level), row.name)
}

fn level_name(level: BenchmarkLevel) -> &'static str {
    match level {
        BenchmarkLevel::FunctionalClear | BenchmarkLevel::FunctionalFast => "functional",
        BenchmarkLevel::Transactions => "transactions",
        BenchmarkLevel::Cycle => "cycle",
        BenchmarkLevel::Rtl => "RTL",
        BenchmarkLevel::Netlist => "netlist",
    }
}

fn cells(row: &LevelMeasurement) -> [String; 7] {
    let or_nothing = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
    [
        three_digits(row.frames_per_second),
        or_nothing(row.clocks_per_second.map(three_digits)),
        three_digits(row.pixels_per_second),
        or_nothing(row.times_rtl.map(|times| format!("{times:.*}", usize::from(times < 9.95)))),
        or_nothing(row.peak_bytes.map(megabytes)),
        or_nothing(row.build_seconds.map(|seconds| match row.is_cached {
            true => "cached".to_owned(),
            false => format!("{seconds:.0} s"),
        })),
        or_nothing(row.compared_with.map(|_| row.differing.to_string())),
    ]
}

/// Returns the notes below the table: which levels are compared, and what the figures include.
fn notes(report: &BenchmarkReport) -> Vec<String> {
    let BenchmarkReport {
        design,
        organization,
        regions,
        size,
        frames,
        streamed_frames: streamed,
        clocks,
        ..
    } = report;
    let mut notes = vec![format!(
        "design {design}, {organization}, {regions} regions, {} x {} pixels, {frames} frames; with clocks \
         {streamed} frames in {clocks} clocks; one thread, {}",
        size.0, size.1, report.instructions
    )];
    let compared = |row: &LevelRow| {
        let measured = row.measured.as_ref()?;
        let with = report.rows.iter().find(|other| Some(other.level) == measured.compared_with)?;
        Some(format!("{} with {} ({} values)", row.name, with.name, measured.compared))
    };
    let compared: Vec<_> = report.rows.iter().filter_map(compared).collect();
    notes.push(format!("compared: {}", compared.join(", ")));
    notes.push(
        "memory: what the process of a simulator takes at most; of a level in this process what Linux says \
         it took beyond memory that was free already, a lower bound"
            .to_owned(),
    );
    let rtl = report.rows.iter().find(|row| row.level == BenchmarkLevel::Rtl);
    if let Some(LevelMeasurement {
        files_clocks_per_second: Some(files),
        unpacking_share: Some(unpacking),
        ..
    }) = rtl.and_then(|row| row.measured.as_ref())
    {
        notes.push(format!(
            "times are from memory, without files and without a comparison of the outputs; RTL \
             with its files: {} clocks/s; unpacking its inputs takes {:.1} % of its time",
            three_digits(*files),
            unpacking * 100.0
        ));
    }
    notes
}

fn line(first: &str, cells: &[String; 7]) -> String {
    let mut line = format!("{first:<FIRST_COLUMN_WIDTH$}");
    for cell in cells {
        line += &format!("{cell:>OTHER_COLUMN_WIDTH$}");
    }
    line + "\n"
}

/// Returns a number with three digits and the prefix of its unit.
fn three_digits(value: f64) -> String {
    let units = [(1e9, " G"), (1e6, " M"), (1e3, " k")];
    let (scale, unit) = units.into_iter().find(|(scale, _)| value >= *scale).unwrap_or((1.0, ""));
    let scaled = value / scale;
    let digits = if scaled < 9.995 { 2 } else { usize::from(scaled < 99.95) };
    format!("{scaled:.digits$}{unit}")
}

/// Returns a size in megabytes of 10^6 bytes.
#[allow(clippy::cast_precision_loss, reason = "three digits are shown")]
fn megabytes(bytes: u64) -> String {
    let megabytes = bytes as f64 / 1e6;
    format!("{megabytes:.*} MB", usize::from(megabytes < 9.95))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.5, 12.34, 999.0, 4_830_000.0, 56_700.0, 2.5e9].map(three_digits);
        assert_eq!(shown, ["0.50", "12.3", "999", "4.83 M", "56.7 k", "2.50 G"]);
        assert_eq!([megabytes(1_240_000), megabytes(123_000_000)], ["1.2 MB", "123 MB"]);
    }
}
