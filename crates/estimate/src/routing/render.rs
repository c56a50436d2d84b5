// SPDX-License-Identifier: MIT OR Apache-2.0
//! Renders the placed design as text for a terminal and as Markdown.

use foveate_output::number_text::grouped;

use super::critical_path::{CriticalPath, PathEnd};
use super::report::{DeviceResult, PlacementResult, ResourceUse, RouteReport};
use crate::table::{ReportTable, header, wrap};

const COLUMNS: [&str; 8] =
    ["logic", "FF", "block RAM", "SPRAM", "DSP", "fmax MHz", "slowest", "fastest"];

/// Returns the report as a table for a terminal of `width` columns, with a sentence on each device.
#[must_use]
pub fn render_routes_text(report: &RouteReport, width: usize) -> String {
    let sentences = sentences(report).map(|sentence| wrap(&sentence, width));
    table(report).stacked_text(width) + "\n" + &sentences.collect::<String>()
}

/// Returns the report as Markdown.
#[must_use]
pub fn render_routes_markdown(report: &RouteReport) -> String {
    let sentences = sentences(report).map(|sentence| format!("* {sentence}\n"));
    table(report).markdown() + "\n" + &sentences.collect::<String>()
}

fn table(report: &RouteReport) -> ReportTable {
    ReportTable {
        title: format!("{} placed and routed by nextpnr", report.top),
        header: header("device", &COLUMNS),
        rows: report.devices.iter().map(row).collect(),
        note: Some(
            "logic: LUT4 of ECP5 and Gowin, logic cells of iCE40. fmax: the clock of the median seed, the slowest and \
             the fastest one. Flip-flops at the ports are left out."
                .to_owned(),
        ),
    }
}

fn row(routed: &DeviceResult) -> Vec<String> {
    let cells = match &routed.placed {
        None => vec!["-".to_owned(); COLUMNS.len()],
        Some(PlacementResult { logic, ff, block_ram, spram, dsp, fmax, .. }) => {
            let used =
                [logic, ff, block_ram, spram, dsp].map(|ResourceUse { used, .. }| grouped(*used));
            let clocks = [fmax.median_mhz, fmax.min_mhz, fmax.max_mhz];
            used.into_iter().chain(clocks.map(|mhz| format!("{mhz:.1}"))).collect()
        }
    };
    std::iter::once(routed.device.clone()).chain(cells).collect()
}

fn sentences(report: &RouteReport) -> impl Iterator<Item = String> {
    let misfits = report.shortage_sentences().into_iter().map(|misfit| misfit + ".");
    report.devices.iter().filter_map(sentence).chain(misfits)
}

fn sentence(routed: &DeviceResult) -> Option<String> {
    let placed = routed.placed.as_ref()?;
    let DeviceResult { device, part, .. } = routed;
    let seeds = placed.fmax.seeds_mhz.len();
    let path = placed.critical.as_ref().map_or_else(String::new, critical);
    let seeds = if seeds == 1 { "1 seed".to_owned() } else { format!("{seeds} seeds") };
    let estimate = placed.estimate.as_ref().map_or_else(String::new, |estimate| {
        format!(" Expected by the netlist alone: {:.1} MHz.", estimate.mhz)
    });
    Some(format!("{device} is {part}; {seeds}.{path}{estimate}"))
}

fn critical(path: &CriticalPath) -> String {
    let end = |PathEnd { module, name }: &PathEnd| format!("{name} (module {module})");
    let share = 100.0 * path.wire_ns / path.ns;
    format!(
        " Longest path: {:.1} ns, {share:.0}% of it on {} wires, from {} to {}.",
        path.ns,
        path.wires,
        end(&path.from),
        end(&path.to)
    )
}
