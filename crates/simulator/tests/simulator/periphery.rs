// SPDX-License-Identifier: MIT OR Apache-2.0
//! With a camera whose irrelevant regions send their means, every output counts and names them.

use std::fs;

use crate::support::{NpyArray, STREET, design, outcomes, street};
use foveate_camera::RegionAction;
use foveate_media::{InputOptions, open};
use foveate_simulator::{EventTableOptions, RunOptions, explain_region};

/// Returns the configuration of the ragged street with edges alone, so that many regions are
/// irrelevant.
fn overrides() -> Vec<&'static str> {
    let more = [
        "spatial=[{feature='edge',min_score=12}]",
        "render.irrelevant='mean'",
        "temporal.reference='last-sent'",
        "periphery.level=2",
    ];
    [&STREET[..3], &more].concat()
}

#[test]
fn every_output_counts_what_regions_send() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let events = EventTableOptions { csv: true, only_active: true, ..EventTableOptions::default() };
    let options = RunOptions { events, ..RunOptions::default() };
    let summary = street(&output, &overrides(), &options);
    let (design, outcomes) = (design(&overrides()), outcomes(&overrides()));
    let sends =
        |action: &RegionAction| matches!(action, RegionAction::Forward | RegionAction::Summarize);
    let count =
        |of: RegionAction| outcomes.iter().flat_map(|o| &o.actions).filter(|&&a| a == of).count();
    let (active, summaries) =
        (count(RegionAction::Forward) as u64, count(RegionAction::Summarize) as u64);
    assert!(active > 10 && summaries > 10, "{active} {summaries}");

    assert_eq!(summary.summaries_sent, Some(summaries));
    assert_eq!(summary.means_sent, Some(4 * summaries));
    let values = summary.pixels_forwarded + 4 * summaries;
    let bits = 2 * 5 * 30 + 8 * values;
    assert_eq!(summary.bandwidth.region.bytes, bits.div_ceil(8));
    assert_eq!(summary.bandwidth.region.events, Some(active + summaries));

    // The column of summaries in frames.csv follows that of the pixels.
    let text = fs::read_to_string(output.join("frames.csv")).unwrap();
    let mut lines = text.lines();
    assert!(lines.next().unwrap().ends_with(",pixels_forwarded,summaries_sent"));
    for (line, outcome) in lines.zip(&outcomes) {
        let sent =
            outcome.actions.iter().filter(|&&action| action == RegionAction::Summarize).count();
        let pixels: u64 = (0..30)
            .filter(|&region| outcome.active[region as usize])
            .map(|region| design.pixels_inside(region))
            .sum();
        assert!(line.ends_with(&format!(",{pixels},{sent}")), "{line}");
    }

    // The table events.csv has a row for every region that sends something.
    let text = fs::read_to_string(output.join("events.csv")).unwrap();
    let told: Vec<&str> =
        text.lines().skip(1).map(|line| line.rsplit(',').next().unwrap()).collect();
    let all = outcomes.iter().flat_map(|outcome| &outcome.actions).filter(|action| sends(action));
    assert_eq!(told, all.map(|action| action.name()).collect::<Vec<_>>());

    let flags = NpyArray::read(&output.join("summary.npy"));
    assert_eq!(flags.shape, [5, 5, 6]);
    let expected = outcomes.iter().flat_map(|o| &o.actions);
    let expected: Vec<u8> = expected.map(|&a| u8::from(a == RegionAction::Summarize)).collect();
    assert_eq!(flags.data, expected);
}

#[test]
fn without_a_periphery_nothing_is_added() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let options = RunOptions { ..RunOptions::default() };
    let summary = street(&output, &STREET, &options);
    assert_eq!((summary.summaries_sent, summary.means_sent), (None, None));
    assert!(!output.join("summary.npy").exists());
    assert!(!fs::read_to_string(output.join("summary.json")).unwrap().contains("summaries_sent"));
    assert!(!fs::read_to_string(output.join("frames.csv")).unwrap().contains("summaries_sent"));
}

/// The explanation has the means, the earlier summary, and the text of the rule.
#[test]
fn an_explanation_says_why_a_summary_was_sent() {
    let design = design(&overrides());
    let outcomes = outcomes(&overrides());
    let limit = InputOptions { frames: Some(5), ..InputOptions::default() };
    let mut seen = [false; 2];
    for (number, outcome) in (0..).zip(&outcomes) {
        for region in 0..30u32 {
            let at = region as usize;
            if outcome.srs[at] || (number + u64::from(region)) % 3 > 0 {
                continue;
            }
            let config = design.config();
            let source = open(&["scene:street"], &config.camera, &limit).unwrap();
            let told = explain_region(&config, source, number, (region % 6, region / 6)).unwrap();
            let summary = told.summary.clone().unwrap();
            assert_eq!(summary.means.concat(), outcome.means[at]);
            let shown = summary.shown.map(|rows| rows.concat());
            let is_near = shown.is_some_and(|shown| {
                shown.iter().zip(&outcome.means[at]).all(|(a, b)| a.abs_diff(*b) <= 2)
            });
            let sent = outcome.actions[at] == RegionAction::Summarize;
            assert_eq!(sent, !is_near);
            assert_eq!(told.action, if sent { "summarize" } else { "hold" });
            let words = if sent { "are sent and shown" } else { "no mean differs" };
            assert!(told.rule.contains(words), "{}", told.rule);
            let text = told.to_string();
            assert!(text.contains("means ") && text.lines().all(|line| line.len() <= 80), "{text}");
            seen[usize::from(sent)] = true;
        }
    }
    assert_eq!(seen, [true; 2]);
}
