// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing diagram of a core, read from its WaveJSON and compared with the numbers of the design
//! and the models.

use foveate_cosim::timing_diagram;
use foveate_design::{Design, DesignConfig, PipelinedTiming, SerialTiming};
use foveate_model::{PipelinedRpu, RpuInput, ThresholdInputs};
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

fn design(toml: &str) -> Design {
    DesignConfig::from_toml(toml).unwrap().validate().unwrap()
}

/// A parsed diagram: the value of each signal at each shown edge, or `None` if it is not valid.
struct ParsedDiagram {
    edges: Vec<u64>,
    signals: BTreeMap<String, Vec<Option<u64>>>,
    svg: String,
}

fn diagram(design: &Design) -> ParsedDiagram {
    let [json, svg] = timing_diagram(design, &AtomicBool::new(false)).unwrap();
    assert_eq!((json.path.as_str(), svg.path.as_str()), ("timing.json", "timing.svg"));
    let wave: Value = serde_json::from_str(&json.contents).unwrap();
    let rows = wave["signal"].as_array().unwrap();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let values = |row: &Value| {
        let mut data = row["data"].as_array().map_or(&[][..], Vec::as_slice).iter();
        let mut now = None;
        let mut values = Vec::new();
        for shown in text(&row["wave"]).chars() {
            match shown {
                '0' | '1' => now = Some(u64::from(shown == '1')),
                'x' => now = None,
                '=' => now = Some(text(data.next().unwrap()).parse().unwrap()),
                '.' => {}
                '|' => continue,
                other => panic!("{other}"),
            }
            values.push(now);
        }
        assert_eq!(data.next(), None, "{row}");
        values
    };
    let edges: Vec<u64> = values(&rows[0]).into_iter().map(Option::unwrap).collect();
    let signals: BTreeMap<_, _> =
        rows[1..].iter().map(|row| (text(&row["name"]), values(row))).collect();
    assert!(signals.values().all(|values| values.len() == edges.len()));
    assert!(edges.windows(2).all(|pair| pair[0] < pair[1]), "{edges:?}");
    ParsedDiagram { edges, signals, svg: svg.contents }
}

impl ParsedDiagram {
    /// Returns the edges after which a line rises.
    fn rising_edges(&self, name: &str) -> Vec<u64> {
        let values = &self.signals[name];
        let rises = |at: &usize| values[*at] == Some(1) && (*at == 0 || values[at - 1] == Some(0));
        (0..values.len()).filter(rises).map(|at| self.edges[at]).collect()
    }
}

#[test]
fn a_pipelined_decision_comes_when_the_timing_says() {
    for toml in [
        "",
        "denoise.filter = 'none'",
        "region.neighborhood = 'shared'\nregion.size = 5",
        "spatial = [{ feature = 'mad', min_score = 5 }]",
        "spatial = [{ feature = 'variance', min_score = 5 }]\nregion.size = 20",
    ] {
        let design = design(toml);
        let timing = PipelinedTiming::from_design(design.as_pipelined().unwrap());
        let diagram = diagram(&design);
        let frame = u64::from(timing.cycles_per_frame);
        let behind = u64::from(timing.decision_frames);
        let first = frame * (1 + behind) - 1 + u64::from(timing.decision_latency);
        assert_eq!(diagram.rising_edges("decision_valid_o").first(), Some(&first), "{toml}");
        assert_eq!(diagram.rising_edges("active_o"), [first], "sent once, then held: {toml}");
        assert!(!diagram.rising_edges("forward_valid_o").is_empty(), "{toml}");
        assert!(diagram.edges.contains(&(frame - 1)) && diagram.edges.contains(&frame), "{toml}");
    }
}

/// Every value of the diagram equals that of the model for the input pixels that the diagram shows,
/// up to the first gap.
#[test]
fn a_pipelined_diagram_shows_what_the_model_says() {
    let design = design(
        "region.size = 2\ndenoise.filter = 'none'\nspatial = [{ feature = 'edge', min_score = 1 }]\ntemporal.min_count = 1",
    );
    let diagram = diagram(&design);
    // The regions are so small that no clock is left out before the end.
    let mut rpu = PipelinedRpu::new(design.as_pipelined().unwrap());
    let mut checked = 0;
    for (at, &edge) in diagram.edges.iter().enumerate() {
        if edge != at as u64 {
            break;
        }
        let shows = |name: &str| diagram.signals[name][at];
        let pixel = u16::try_from(shows("pixel_i").unwrap_or(0)).unwrap();
        let valid = shows("valid_i") == Some(1);
        let input = RpuInput { reset: false, valid, pixel, border: 15 };
        let output = rpu.step(&input, &ThresholdInputs::from_camera(&design));
        for (name, value) in [
            ("decision_valid_o", u64::from(output.decision_valid)),
            ("srs_o", u64::from(output.srs)),
            ("trs_o", u64::from(output.trs)),
            ("active_o", u64::from(output.active)),
            ("edge_score_o", output.scores[0]),
            ("temporal_count_o", output.temporal_count.into()),
            ("forward_valid_o", u64::from(output.forward_valid)),
            ("forward_pixel_o", output.forward_pixel.into()),
        ] {
            assert_eq!(shows(name), Some(value), "{name} after edge {edge}");
            checked += 1;
        }
    }
    assert!(checked >= 8 * 10, "{checked}");
}

#[test]
fn a_serial_array_is_ready_and_shows_scores_when_the_timing_says() {
    for toml in [
        "hardware = { organization = 'serial' }",
        "hardware = { organization = 'serial', fold = 28, feed = 'raster' }\nspatial = [{ feature = 'mad', min_score = 5 }, { feature = 'edge' }]",
        "hardware = { organization = 'serial', fold = 3 }\nregion.neighborhood = 'shared'\ntemporal.reference = 'last-sent'",
        "hardware = { organization = 'serial', feed = 'raster' }\nregion.neighborhood = 'shared'\nframe = { width = 24, height = 16 }",
    ] {
        let design = design(toml);
        let timing = SerialTiming::from_design(design.as_serial().unwrap());
        let diagram = diagram(&design);
        let start = timing.load_clocks() - 1;
        let ready = diagram.rising_edges("ready_o");
        assert_eq!(ready.last(), Some(&(start + timing.edges_to_ready())), "{toml}");
        let before: u64 = timing
            .phases()
            .iter()
            .take_while(|(phase, _)| !phase.to_string().starts_with("rotate"))
            .map(|&(_, steps)| steps)
            .sum();
        let scores = diagram.rising_edges("score_valid_o");
        assert_eq!(scores.first(), Some(&(start + timing.edges_to_step(before))), "{toml}");
        assert_eq!(
            diagram.rising_edges("active_o").len(),
            1,
            "the first region is active alone: {toml}"
        );
        for (name, values) in &diagram.signals {
            if name.starts_with("score_o") || name.starts_with("region_o") {
                let valid = diagram.signals["score_valid_o"].iter();
                assert!(values.iter().zip(valid).all(|(v, &is)| v.is_some() == (is == Some(1))));
            }
        }
    }
}

#[test]
fn a_diagram_is_drawn_with_every_name_and_number() {
    for toml in ["", "hardware = { organization = 'serial', fold = 784 }"] {
        let design = design(toml);
        let ParsedDiagram { edges, signals, svg } = diagram(&design);
        assert_eq!(svg, diagram(&design).svg, "equal designs have equal pictures");
        for text in signals.keys().cloned().chain(edges.iter().map(u64::to_string)) {
            assert!(svg.contains(&format!(">{text}<")), "{text}");
        }
        assert!(edges.len() <= 80 && svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert_eq!(svg.matches('<').count(), svg.matches('>').count());
    }
}
