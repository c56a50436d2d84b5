// SPDX-License-Identifier: MIT OR Apache-2.0
//! The text of a summary of co-simulations.

use foveate_cosim::CosimReport;

use super::CosimOutput;
use super::end_to_end::EndToEndReport;

/// Returns the text in lines of at most `width` columns; longer words are not broken.
pub(super) fn summary_text(told: &CosimOutput<'_>, width: usize) -> String {
    let CosimOutput { summary, end_to_end } = told;
    // Paragraphs, each with its indent.
    let mut all = Vec::new();
    for report in &summary.runs {
        all.push(("", report.to_string()));
        if let Some(mismatch) = &report.mismatch {
            let heading =
                "ports that differ before the end of the sequence, each with its first clock:";
            all.push(("  ", heading.to_owned()));
            all.extend(mismatch.ports.iter().map(|port| ("    ", port.to_string())));
        }
        all.push(("  ", run_line(report)));
        let script = report.replay.as_ref().map(|replay| replay.join("replay.sh"));
        let replay = script.map(|script| format!("replay it with {}", script.display()));
        let waves = report.waves.as_ref().map(|waves| format!("waves in {}", waves.display()));
        all.extend(replay.into_iter().chain(waves).map(|line| ("  ", line)));
    }
    // Situations are counted only without a mismatch, which ends a run before it reaches all of
    // them.
    let all_agree = summary.runs.iter().all(CosimReport::passed);
    let situations = (all_agree && !summary.situations.0.is_empty())
        .then(|| format!("situations  {}", summary.situations));
    let not_run = summary.not_run.iter();
    let not_run = not_run.map(|name| format!("{name}: not run, because of the mismatch above"));
    let not_simulated = summary.not_simulated.iter().map(|left| format!("not simulated: {left}"));
    let not_elaborated =
        summary.not_elaborated.iter().map(|left| format!("not elaborated: {left}"));
    let end_to_end = end_to_end.as_ref().map(EndToEndReport::text);
    let rest = situations.into_iter().chain(not_run).chain(not_simulated);
    all.extend(rest.chain(not_elaborated).chain(end_to_end).map(|line| ("", line)));
    all.iter().map(|(indent, text)| paragraph(text, indent, width)).collect()
}

fn run_line(report: &CosimReport) -> String {
    let (seconds, (columns, rows)) = (report.seconds, report.grid);
    format!(
        "design {}, {columns} x {rows} regions, {}, seed {}; {:.1} s vectors, {:.1} s build, {:.1} s run",
        report.design,
        report.simulator_version,
        report.seed,
        seconds.vectors,
        seconds.build,
        seconds.run
    )
}

/// Returns a paragraph. Its later lines are indented by two more columns.
fn paragraph(text: &str, indent: &str, width: usize) -> String {
    let further = format!("{indent}  ");
    // A path or a number is not broken, even if it is longer than the line.
    let options = textwrap::Options::new(width)
        .initial_indent(indent)
        .subsequent_indent(&further)
        .break_words(false)
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    text.lines().map(|line| textwrap::fill(line, &options) + "\n").collect()
}
