// SPDX-License-Identifier: MIT OR Apache-2.0
use roxmltree::{Document, Node, ParsingOptions};

use super::sample::sample_exploration;
use super::*;
use crate::objective::mark_fronts;
use crate::{FrontMembership, RefusedCombination};

/// A space with two organizations, and with folds, depths and a threshold that vary.
const GRID: &str = r#"
[ideal]
region.neighborhood = "shared"
[vary]
hardware.organization = ["pipelined", "serial"]
hardware.fold = [1, 16]
frame.pixel_bits = [8, 6, 4]
spatial.0.level = [80, 90, 100, 110, 120]
"#;

/// Parses the page as XML, so that every element is closed and every character is escaped.
fn tree(page: &str) -> Document<'_> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(page, options).unwrap()
}

fn named<'a>(document: &'a Document<'_>, name: &'static str) -> Vec<Node<'a, 'a>> {
    let all = document.descendants();
    all.filter(|node| node.tag_name().name() == name).collect()
}

fn classed<'a>(document: &'a Document<'_>, class: &'static str) -> Vec<Node<'a, 'a>> {
    let of = |node: &Node<'_, '_>| {
        node.attribute("class").is_some_and(|all| all.split(' ').any(|one| one == class))
    };
    document.descendants().filter(of).collect()
}

/// Checks that the rows of a table have one number of cells. Returns that of the first table.
fn check_columns(document: &Document<'_>) -> usize {
    let tables = classed(document, "sortable").into_iter().map(|table| {
        let cells = |node: &Node<'_, '_>| node.children().filter(Node::is_element).count();
        let rows = table
            .descendants()
            .filter(|node| node.has_tag_name("tr") || node.tag_name().name() == "tr");
        let counts: Vec<usize> = rows.map(|row| cells(&row)).collect();
        assert!(counts.iter().all(|count| *count == counts[0]), "{counts:?}");
        counts[0]
    });
    let columns: Vec<usize> = tables.collect();
    columns[0]
}

#[test]
fn every_point_is_there_with_its_configuration_rows_and_marks() {
    let sample = sample_exploration(GRID, true);
    let page = render_page(&sample).unwrap();
    let document = tree(&page);
    let texts: Vec<&str> = named(&document, "pre").iter().filter_map(Node::text).collect();
    let marks = classed(&document, "mark").len();
    assert!(marks > 4 * sample.rows.len(), "{marks}");
    for row in &sample.rows {
        assert!(texts.contains(&row.config.to_toml().as_str()), "point {}", row.number);
        for id in [format!("p{}", row.number), format!("c{}", row.number)] {
            let found = document.descendants().filter(|node| node.attribute("id") == Some(&id));
            assert_eq!(found.count(), 1, "{id}");
        }
    }
    check_columns(&document);
    for text in [
        "hall.mp4: frame 300 of 450 is damaged",
        "for example region.size = 65: &#60;65&#62; is more than 64",
        "48 to 56 MHz",
        "224×224",
    ] {
        assert!(page.contains(text), "{text}");
    }
}

/// A point may have no load, or only the clock that it needs.
#[test]
fn a_link_adds_columns() {
    let mut sample = sample_exploration(GRID, true);
    let without = render_page(&sample).unwrap();
    let columns = check_columns(&tree(&without));
    sample.link_bits_per_second = Some(2_500_000);
    let load = crate::LoadFigures {
        needed_clock_hz: 2_313_864,
        delivery_longest_ns: Some(1_451_000),
        buffer_bytes: Some(28_901),
        overloaded_clips: Some(0),
        unbuffered_lost_regions: Some(77_777),
        unbuffered_frames_with_losses: Some(3),
    };
    sample.rows[0].load = Some(load);
    sample.rows[1].load = Some(crate::LoadFigures { buffer_bytes: None, ..load });
    let page = render_page(&sample).unwrap();
    assert_eq!(check_columns(&tree(&page)), columns + 4);
    for text in ["2.5 Mbit/s", "2.314", "1.451", "28,901", "77,777"] {
        assert!(page.contains(text) && !without.contains(text), "{text}");
    }
}

#[test]
fn what_a_user_wrote_is_text() {
    let mut sample = sample_exploration(GRID, true);
    let bad = "\"><script>alert('&amp;')</script>";
    sample.axes[0] = bad.to_owned();
    sample.rows[1].settings[1] = bad.to_owned();
    sample.rows[2].fingerprint = bad.to_owned();
    sample.rows[3].figures.scores[0].feature = bad.to_owned();
    sample.problems.push(bad.to_owned());
    sample.refused.push(RefusedCombination { settings: bad.to_owned(), reason: bad.to_owned() });
    sample.ideal = bad.to_owned();
    sample.program = bad.to_owned();
    sample.clips.truncate(1);
    let page = render_page(&sample).unwrap();
    assert!(!page.contains("<script>alert"));
    let document = tree(&page);
    assert_eq!(named(&document, "script").len(), 1);
    let title = named(&document, "h1")[0].text().unwrap();
    assert!(title.ends_with("street <script>alert(1)</script> & \"night\""), "{title}");
}

#[test]
fn nothing_is_loaded_from_elsewhere() {
    let page = render_page(&sample_exploration(GRID, true)).unwrap();
    let document = tree(&page);
    for node in document.descendants() {
        assert!(!["link", "img", "iframe", "object"].contains(&node.tag_name().name()));
        assert_eq!(node.attribute("src"), None);
        for attribute in ["href", "data-copy"] {
            let target = node.attribute(attribute).unwrap_or("#front-dot");
            let target = target.trim_start_matches('#');
            let known = document.descendants().any(|node| {
                node.attribute("id")
                    .is_some_and(|id| id == target || id.strip_prefix('c') == Some(target))
            });
            assert!(known, "{target}");
        }
    }
    assert!(!page.contains("@import") && !page.contains("url("));
}

/// Returns explorations whose plots are hard to draw.
fn hard() -> Vec<(&'static str, Exploration)> {
    let each = sample_exploration(crate::BUILT_IN_SPACES[0].toml, false);
    let one = sample_exploration("", false);
    let mut equal = sample_exploration(GRID, true);
    let first = equal.rows[0].clone();
    for row in &mut equal.rows {
        row.figures = first.figures.clone();
        row.device_share = first.device_share;
        row.clocks_per_frame = first.clocks_per_frame;
        row.bytes_per_frame = first.bytes_per_frame;
    }
    let mut faultless = sample_exploration(GRID, true);
    for row in &mut faultless.rows {
        row.figures.action_flips = 0.0;
        row.figures.psnr_ideal = None;
        row.figures.psnr_input = None;
        row.figures.active = 0.0;
        row.figures.ideal_active = 0.0;
        row.figures.stale_regions = 0.0;
    }
    let mut broken = sample_exploration(GRID, true);
    broken.rows[0].figures.action_flips = f64::NAN;
    broken.rows[1].figures.stale_regions = f64::INFINITY;
    broken.rows[2].bytes_per_frame = f64::NEG_INFINITY;
    broken.rows[3].clocks_per_frame = 0;
    broken.rows[4].silicon = None;
    broken.rows[4].device_share = None;
    let mut none = sample_exploration(GRID, false);
    none.rows.clear();
    none.clips.clear();
    let mut all = vec![
        ("one at a time", each),
        ("one point", one),
        ("all equal", equal),
        ("no errors", faultless),
        ("no numbers", broken),
        ("nothing", none),
    ];
    all.iter_mut().for_each(|(_, exploration)| mark_fronts(&mut exploration.rows, false));
    all
}

#[test]
fn pictures_have_numbers_whatever_the_data() {
    for (name, sample) in hard() {
        let page = render_page(&sample).unwrap();
        let document = tree(&page);
        let pictures = named(&document, "svg");
        for node in pictures.iter().flat_map(Node::descendants) {
            for attribute in ["d", "x", "y", "transform"] {
                let value = node.attribute(attribute).unwrap_or_default();
                assert!(!value.contains("NaN") && !value.contains("inf"), "{name}: {value}");
                if ["x", "y"].contains(&attribute) && !value.is_empty() {
                    let value: f64 = value.parse().unwrap();
                    assert!((-10.0..=560.0).contains(&value), "{name}: {value}");
                }
            }
        }
        let ticks = classed(&document, "ticks");
        assert!(ticks.iter().all(|ticks| ticks.children().count() >= 4), "{name}");
        let areas = sample.rows.iter().any(|row| row.silicon.is_some());
        assert_eq!(page.contains("There are no areas"), !areas, "{name}");
    }
}

/// The direction of the better corner of each plot as a reader sees it: right is 1 and left is -1;
/// down is 1 and up is -1.
const BETTER: [(&str, f64, f64); 4] = [
    ("plot-speed", 1.0, 1.0),
    ("plot-area", -1.0, 1.0),
    ("plot-stale", -1.0, 1.0),
    ("plot-picture", -1.0, -1.0),
];

#[test]
fn large_marks_are_those_that_no_full_mark_beats_on_the_picture() {
    let page = render_page(&sample_exploration(GRID, true)).unwrap();
    let document = tree(&page);
    for (id, right, down) in BETTER {
        let figure = document.descendants().find(|node| node.attribute("id") == Some(id)).unwrap();
        let marks = figure
            .descendants()
            .filter(|node| node.attribute("class").is_some_and(|class| class.starts_with("mark")))
            .filter(|node| !node.attribute("class").is_some_and(|class| class.contains("hollow")));
        let marks: Vec<(f64, f64, bool)> = marks
            .map(|mark| {
                let of = |name| mark.attribute(name).unwrap().parse::<f64>().unwrap();
                let best = mark.attribute("class").unwrap().contains("best");
                (of("x") * right, of("y") * down, best)
            })
            .collect();
        let best = marks.iter().filter(|mark| mark.2).count();
        assert!(best > 1 && best < marks.len(), "{id}: {best} of {}", marks.len());
        for (x, y, on_front) in &marks {
            // Positions are rounded to tenths, so they may be equal although the figures differ.
            let beaten = marks.iter().any(|(a, b, _)| *a > x + 0.11 && *b > y + 0.11);
            let not_above =
                marks.iter().any(|(a, b, best)| *best && *a >= x - 0.11 && *b >= y - 0.11);
            assert!(!(*on_front && beaten), "{id}: a large mark at {x}, {y} is beaten");
            assert!(not_above, "{id}: no large mark is as good as that at {x}, {y}");
        }
    }
}

/// The ends of a front with more than eight points, and six points between them, are numbered, and
/// each has a line below.
#[test]
fn numbered_points_have_lines_and_hollow_ones_are_on_no_front() {
    let mut sample = sample_exploration(GRID, true);
    for (row, index) in sample.rows.iter_mut().zip(0_u32..) {
        row.figures.false_alarms = 0.0;
        row.figures.missed = if index % 4 == 0 { 0.11 } else { 0.1 };
        row.figures.action_flips = f64::from(index) / 100.0;
        row.device_share = Some(f64::from(10_000 - index));
    }
    mark_fronts(&mut sample.rows, false);
    let page = render_page(&sample).unwrap();
    let document = tree(&page);
    let plot = document.descendants().find(|node| node.attribute("id") == Some("plot-area"));
    let texts: Vec<Node<'_, '_>> = plot.unwrap().descendants().collect();
    let class = |node: &Node<'_, '_>, class: &str| {
        node.attribute("class").is_some_and(|all| all.split(' ').any(|one| one == class))
    };
    let labels = texts.iter().filter(|node| class(node, "label"));
    let mut labels: Vec<usize> = labels.map(|node| node.text().unwrap().parse().unwrap()).collect();
    labels.sort_unstable();
    // All points that qualify are on the front of area; point 1 does not qualify.
    let front: Vec<usize> = (2..=sample.rows.len()).filter(|number| number % 4 != 1).collect();
    let last = front.len() - 1;
    let expected: Vec<usize> = (0..8).map(|index| front[index * last / 7]).collect();
    assert_eq!(labels, expected);
    for number in expected {
        let id = format!("carea-{number}");
        let line = document.descendants().find(|node| node.attribute("id") == Some(&id)).unwrap();
        let line = line.descendants().find(|node| node.tag_name().name() == "pre").unwrap();
        let expected = format!("foveate generate --config designs/{number}.toml -o core-{number}");
        assert_eq!(line.text(), Some(expected.as_str()));
    }
    for mark in texts.iter().filter(|node| class(node, "mark")) {
        let number = mark.parent().unwrap().attribute("data-n").unwrap().parse::<usize>().unwrap();
        assert_eq!(class(mark, "hollow"), number % 4 == 1, "point {number}");
        assert!(!(class(mark, "hollow") && class(mark, "best")), "point {number}");
    }
    assert!(
        page.contains(" designs with more than 10 % of the active regions missed")
            && page.contains("hall.mp4")
    );
}

#[test]
fn pages_are_the_same_every_time() {
    let sample = sample_exploration(GRID, true);
    assert_eq!(render_page(&sample).unwrap(), render_page(&sample).unwrap());
}

#[test]
fn of_very_many_points_the_fronts_are_shown() {
    let mut sample = sample_exploration(GRID, true);
    let row = sample.rows[0].clone();
    let fronts: usize = sample.rows.iter().map(|row| usize::from(row.front.any())).sum();
    let more = (0..5000).map(|index| {
        let front = FrontMembership::default();
        DesignRow { number: 1000 + index, front, ..row.clone() }
    });
    sample.rows.extend(more);
    let rows = points_shown(&sample.rows);
    assert!((1000..=MAX_POINTS_SHOWN).contains(&rows.len()), "{}", rows.len());
    assert_eq!(rows.iter().filter(|row| row.front.any()).count(), fronts);
}

/// Writes the samples to the folder `FOVEATE_PAGES`, so that a person can look at them in a
/// browser.
#[test]
fn samples_can_be_looked_at() {
    let Some(folder) = std::env::var_os("FOVEATE_PAGES").map(std::path::PathBuf::from) else {
        return;
    };
    let designs = ("designs", sample_exploration(crate::BUILT_IN_SPACES[1].toml, true));
    for (name, sample) in
        hard().into_iter().chain([("grid", sample_exploration(GRID, true)), designs])
    {
        let name = name.replace(' ', "-") + ".html";
        std::fs::write(folder.join(name), render_page(&sample).unwrap()).unwrap();
    }
}
