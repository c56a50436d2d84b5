// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the visible properties of charts: lines that overlap, the subject of the chart, and
//! axes with no more precision than the data.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use foveate_output::{
    chart::{BarSeries, Chart, ChartData, ChartSeries, LineLook},
    palette::{Colour, SERIES},
};

fn chart(shape: ChartData) -> Chart {
    let [file, title, x, y, caption] =
        ["file", "title", "across", "up", "caption"].map(str::to_owned);
    Chart { file_stem: file, title, x_title: x, y_title: y, caption, shape }
}

fn line(name: &str, points: &[(f64, f64)], look: LineLook) -> ChartSeries {
    ChartSeries { name: name.to_owned(), points: points.to_vec(), look }
}

/// Counts the pixels of exactly this colour left of the legend.
fn count_pixels(chart: &Chart, colour: Colour) -> usize {
    let picture = image::load_from_memory(&chart.to_png().unwrap()).unwrap().into_rgb8();
    picture.enumerate_pixels().filter(|(x, _, dot)| *x < 780 && dot.0 == colour).count()
}

/// Returns the texts of a chart as SVG.
fn texts(chart: &Chart) -> Vec<String> {
    let svg = chart.to_svg(&[]).unwrap();
    let lines: Vec<&str> = svg.lines().collect();
    let marked = lines.windows(2).filter(|pair| pair[0].starts_with("<text"));
    marked.map(|pair| pair[1].to_owned()).collect()
}

#[test]
fn a_line_shows_through_an_open_one_on_it() {
    let layers = [(1.0, 6.5), (2.0, 7.6), (3.0, 8.7), (4.0, 9.8)];
    let frames: Vec<(f64, f64)> = (0..600).map(|at| (f64::from(at), f64::from(at % 7))).collect();
    for points in [&layers[..], &frames[..]] {
        let chart_with_look = |look| {
            chart(ChartData::Lines(vec![
                line("needed", points, LineLook::Plain),
                line("passed on", points, look),
            ]))
        };
        let (covered, open) = (chart_with_look(LineLook::Plain), chart_with_look(LineLook::Open));
        // Even where lines overlap, at least a fifth of each is visible.
        for colour in [SERIES[0], SERIES[1]] {
            let alone = count_pixels(
                &chart(ChartData::Lines(vec![line("one", points, LineLook::Plain)])),
                SERIES[0],
            );
            assert!(
                5 * count_pixels(&open, colour) > alone,
                "{} of {alone}",
                count_pixels(&open, colour)
            );
        }
        assert!(count_pixels(&covered, SERIES[0]) < count_pixels(&open, SERIES[0]) / 2);
    }
}

#[test]
fn the_target_is_in_front_and_unlike_any_line() {
    let curve = [(1e4, 20.0), (1e5, 30.0), (1e6, 40.0)];
    let names = ["a", "b", "c", "d", "e", "f", "g"];
    // The target is first, so it would be hidden by every line if it were drawn in order.
    let target = line("this design", &curve[1..2], LineLook::Target);
    let lines: Vec<ChartSeries> = std::iter::once(target)
        .chain(names.map(|name| line(name, &curve, LineLook::Plain)))
        .collect();
    let drawn = chart(ChartData::LogLines(lines.clone()));
    let svg = drawn.to_svg(&[]).unwrap();
    let circles: Vec<&str> = svg.lines().filter(|line| line.starts_with("<circle")).collect();
    // The circles of the target follow those of the curves, and precede those of the target in the
    // legend.
    let [.., disc, ring, dot, _, _, _] = circles.as_slice() else { panic!("{circles:?}") };
    for (circle, radius) in [(disc, 9), (ring, 7), (dot, 3)] {
        assert!(circle.contains(&format!("r=\"{radius}\"")), "{circles:?}");
    }
    assert!(ring.contains("fill=\"none\"") && ring.contains("stroke=\"#000000\""), "{ring}");
    // The target takes no colour from the lines: all seven are solid, and the first has the first
    // colour.
    let without = chart(ChartData::LogLines(lines[1..].to_vec()));
    let lines_of = |svg: &str| svg.lines().filter(|line| line.starts_with("<polyline")).count();
    assert_eq!(lines_of(&svg), lines_of(&without.to_svg(&[]).unwrap()));
    assert!(texts(&drawn).contains(&"this design".to_owned()));
}

#[test]
fn an_axis_of_whole_numbers_has_whole_labels() {
    for last in 1..=60 {
        let points: Vec<(f64, f64)> = (1..=last).map(|x| (f64::from(x), 1.0)).collect();
        let drawn = chart(ChartData::Lines(vec![line("layers", &points, LineLook::Plain)]));
        let svg = drawn.to_svg(&[]).unwrap();
        // The labels of the horizontal axis are below the plot.
        let below = |text: &str| {
            let y = text.split_once(" y=\"").and_then(|(_, rest)| rest.split_once('"'));
            y.is_some_and(|(y, _)| (480..510).contains(&y.parse().unwrap_or(0)))
        };
        let lines: Vec<&str> = svg.lines().collect();
        let labels: Vec<&str> = lines
            .windows(2)
            .filter(|pair| pair[0].starts_with("<text") && below(pair[0]))
            .map(|pair| pair[1])
            .collect();
        assert!(labels.len() >= 2 && labels.len() <= 11, "{last}: {labels:?}");
        assert!(labels.iter().all(|label| label.parse::<u32>().is_ok()), "{last}: {labels:?}");
    }
    // Between whole numbers there are as many digits as necessary.
    let points = [(0.0, 0.0), (0.3, 0.7)];
    let texts = texts(&chart(ChartData::Lines(vec![line("seconds", &points, LineLook::Plain)])));
    assert!(texts.iter().any(|text| text == "0.1"), "{texts:?}");
    assert!(texts.iter().all(|text| text.len() < 12), "{texts:?}");
}

/// Returns a chart of bars that all reach 100, and the height of its highest bar in pixels.
fn bars(groups: &[&str]) -> (Chart, u32) {
    let series = BarSeries {
        name: "share".to_owned(),
        colour: SERIES[0],
        values: vec![100.0; groups.len()],
        ranges: Vec::new(),
    };
    let groups = groups.iter().map(|name| (*name).to_owned()).collect();
    let drawn = chart(ChartData::Bars { groups, series: vec![series] });
    let svg = drawn.to_svg(&[]).unwrap();
    let height = |rect: &str| rect.split_once("height=\"")?.1.split_once('"')?.0.parse().ok();
    let bars = svg.lines().filter(|line| line.starts_with("<rect")).skip(1);
    let highest = bars.filter_map(height).max().unwrap();
    (drawn, highest)
}

#[test]
fn bars_are_as_high_as_the_names_below_them_allow() {
    let (_, highest) = bars(&["still (n = 4)", "slow (n = 229)", "fast (n = 16)"]);
    assert!(highest > 400, "{highest} of 560 rows");
    let short: Vec<String> = (0..30).map(|number| format!("c{number}")).collect();
    let long: Vec<String> =
        (0..30).map(|number| format!("a clip of the street {number}")).collect();
    let bars_of = |names: &[String]| bars(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let ((upright, shorter), (_, longer)) = (bars_of(&short), bars_of(&long));
    // Many names are vertical, and take as much room as the longest needs.
    assert!(highest > shorter - 10 && shorter > longer + 60, "{highest}, {shorter}, {longer}");
    assert!(longer > 260, "{longer}");
    assert!(!upright.to_png().unwrap().is_empty());
}
