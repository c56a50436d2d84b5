// SPDX-License-Identifier: MIT OR Apache-2.0
//! The text of a summary of co-simulations.

use foveate_cosim::CosimReport;

use super::CosimOutput;

/// Returns the text in lines of at most `width` columns; longer words are not broken.
pub(super) fn summary_text(told: &CosimOutput<'_>, width: usize) -> String {
    let CosimOutput { summary, end_to_end } = told;
    let mut text = String::new();
    for report in &summary.runs {
        push_paragraph(&mut text, &report.to_string(), "", width);
        if let Some(mismatch) = &report.mismatch {
            push_paragraph(
                &mut text,
                "ports that differ before the end of the sequence, each with its first clock:",
                "  ",
                width,
            );
            for port in &mismatch.ports {
                push_paragraph(&mut text, &port.to_string(), "    ", width);
            }
        }
        push_paragraph(&mut text, &run_line(report), "  ", width);
        if let Some(replay) = &report.replay {
            let script = replay.join("replay.sh");
            push_paragraph(&mut text, &format!("replay it with {}", script.display()), "  ", width);
        }
        if let Some(waves) = &report.waves {
            push_paragraph(&mut text, &format!("waves in {}", waves.display()), "  ", width);
        }
    }
    // Situations are counted only without a mismatch, which ends a run before it reaches all of
    // them.
    let all_agree = summary.runs.iter().all(CosimReport::passed);
    if all_agree && !summary.situations.0.is_empty() {
        push_paragraph(&mut text, &format!("situations  {}", summary.situations), "", width);
    }
    for name in &summary.not_run {
        push_paragraph(
            &mut text,
            &format!("{name}: not run, because of the mismatch above"),
            "",
            width,
        );
    }
    for left_out in &summary.not_simulated {
        push_paragraph(&mut text, &format!("not simulated: {left_out}"), "", width);
    }
    for left_out in &summary.not_elaborated {
        push_paragraph(&mut text, &format!("not elaborated: {left_out}"), "", width);
    }
    if let Some(found) = end_to_end {
        push_paragraph(&mut text, &found.text(), "", width);
    }
    text
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

/// Appends a paragraph. Its later lines are indented by two more columns.
fn push_paragraph(text: &mut String, paragraph: &str, indent: &str, width: usize) {
    let further = format!("{indent}  ");
    for line in paragraph.lines() {
        // A path or a number is not broken, even if it is longer than the line.
        let options = textwrap::Options::new(width)
            .initial_indent(indent)
            .subsequent_indent(&further)
            .break_words(false)
            .word_splitter(textwrap::WordSplitter::NoHyphenation);
        text.push_str(&textwrap::fill(line, options));
        text.push('\n');
    }
}
