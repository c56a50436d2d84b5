// SPDX-License-Identifier: MIT OR Apache-2.0
use super::*;
use crate::computation::Macs;
use crate::cost::{AcceleratorSummary, FrameCost};
use crate::summary::{
    ClipSummary, OutputCloseness, TuningSummary, TuningTrial, WholeComputationError,
};
use crate::{
    Computation, FrameTraffic, Framing, LayerSummary, PixelMapping, RecordedOutput, TuningGoal,
};
use foveate_design::DesignConfig;
use foveate_network::ExecutionMode;
use foveate_output::page::browser::{ExpectedMark, chromium, probe_page};
use roxmltree::{Document, Node, ParsingOptions};

const BAD: &str = "\"><script>alert('&amp;')</script>";

/// A run, its counted frames and its design.
type RunSample = (InferenceSummary, Vec<FrameFigures>, Design);

/// Marks show their name and the needed share, and link to their rows.
const TIP: ExpectedMark =
    ExpectedMark { figures: r"/^(Layer|Frame|Limits).*\n.* needed/", links: 1 };

fn outputs(error: f64, psnr: Option<f64>) -> OutputCloseness {
    OutputCloseness {
        agreement: 0.75,
        cosine: 0.9,
        psnr,
        largest: 2.0 * error,
        relative_rms: error,
        rms_of_variation: 3.0 * error,
    }
}

fn cost(scale: f64) -> FrameCost {
    FrameCost {
        cycles: 1e5 * scale,
        seconds: 5e-4 * scale,
        dram_accesses: 1e6 * scale,
        dram_weights: 1e3,
        energy_mj: 0.7 * scale,
    }
}

fn layer(number: u32) -> LayerSummary {
    let part = 0.1 + f64::from(number) / 8.0;
    LayerSummary {
        name: format!("/block.{number}/Conv"),
        operator: if number == 2 { "Add".to_owned() } else { "Conv+Relu".to_owned() },
        shape: vec![1, 12, 224, 224],
        macs: if number == 2 { 0 } else { 5_419_008 },
        needed_share: part,
        scheduled_share: 1.02 * part,
        changed_share: 0.9 * part,
        weight_bytes: 480,
        output_bytes: 2_408_448,
        mask_bytes: 6_272,
        traffic: FrameTraffic {
            read_bytes: 5e5 * part,
            halo_bytes: 1e5 * part,
            written_bytes: 4e5 * part,
            seconds: 1e-3 * part,
        },
        whole_cost: Some(cost(1.0)),
        masked_cost: Some(cost(part)),
        limit: Some(0.05),
        relative_rms: Some(1e-4 * f64::from(number)),
    }
}

fn clip(name: &str, counted: u32) -> ClipSummary {
    ClipSummary {
        name: name.to_owned(),
        frames: u64::from(counted) + 1,
        counted_frames: counted.into(),
        active_share: 0.07,
        changed_share: 0.08,
        macs: Macs { whole_frame: 100.0, needed: 12.5, scheduled: 13.5, whole_blocks: 100.0 },
        problem: None,
    }
}

/// Returns a run over three clips, of which the last stopped at its first frame. Limits were chosen
/// on two other clips.
fn of_clips() -> RunSample {
    let mut sample = sample(20);
    let names = ["a", "b", "c"];
    sample.0.inputs = names.map(|name| format!("{name}.mp4")).to_vec();
    sample.0.clips = vec![clip("a", 10), clip("b", 10), clip("c", 0)];
    sample.0.clips[2].problem = Some("it was interrupted".to_owned());
    sample.0.problem = Some("`c`: it was interrupted; clips that were not begun: 2".to_owned());
    sample.0.tuning.as_mut().unwrap().clips = vec!["x".to_owned(), "y".to_owned()];
    for (place, frame) in (1..).zip(&mut sample.1) {
        let (clip, before) = if place < 11 { ("a", 0) } else { ("b", 11) };
        clip.clone_into(&mut frame.clip);
        (frame.index_in_run, frame.number) = (place + before / 11, place + before / 11 - before);
    }
    sample
}

#[test]
fn several_clips_have_a_table_and_their_frames_names() {
    let sample = of_clips();
    let page = rendered(&sample);
    let document = tree(&page);
    assert_eq!(sorted_by(&document, "pc0")[1..7], ["a", "11", "10", "0.07", "0.08", "0.125"]);
    assert_eq!(sorted_by(&document, "pc2")[4..8], ["", "", "", ""]);
    assert!(sorted_by(&document, "pc2").contains(&"it was interrupted"));
    // The first frame of the second clip, at place 11, is not counted.
    assert!(by_id(&document, "pf11").is_none());
    assert_eq!(sorted_by(&document, "pf12")[..2], ["1", "b"]);
    for text in [
        "frame, clip after clip",
        "MACs saved [%]",
        "</span>a</li>",
        "Frame 1 of b: ",
        "2 clips to choose limits on, then 3 other clips, which are reported",
        "counted frames of x, y, in 21 runs",
        "`c`: it was interrupted; clips that were not begun: 2",
        "chosen on the first half of the clips",
    ] {
        assert!(page.contains(text), "{text}");
    }
    assert!(!rendered(&self::sample(3)).contains("id=\"clips\""), "one clip needs no table");
}

/// Returns a made-up run with everything that a page can show.
fn sample(frames: u32) -> RunSample {
    let macs =
        Macs { whole_frame: 140_894_208.0, needed: 14e6, scheduled: 15e6, whole_blocks: 141e6 };
    let tried = |relative_limit, needed_share, error| TuningTrial {
        relative_limit,
        needed_share,
        outputs: outputs(error, (error > 0.0).then_some(40.0 - error)),
        holds: error < 0.05,
    };
    let uniform: Vec<TuningTrial> = (0..12)
        .map(|power| {
            tried(
                Some(2f64.powi(power - 10)),
                0.09 - 0.007 * f64::from(power),
                1e-4 * 2f64.powi(power),
            )
        })
        .collect();
    let summary = InferenceSummary {
        format_version: 1,
        foveate_version: "0.1.0",
        complete: true,
        problem: None,
        warnings: Vec::new(),
        inputs: vec!["scene:street".to_owned()],
        luma: "coded",
        network: "networks/denoiser.onnx".to_owned(),
        layout: "nchw",
        mode: Computation::Tuned(TuningGoal::Psnr(40.0)),
        mapping: PixelMapping { mean: vec![0.0], scale: vec![1.0] },
        framing: Framing::Same,
        sight: None,
        every: std::num::NonZeroU32::MIN,
        width: 224,
        height: 224,
        frames: u64::from(frames) + 1,
        counted_frames: frames.into(),
        active_share: 0.065,
        changed_share: 0.067,
        macs,
        weight_bytes: 12_000,
        traffic: FrameTraffic {
            read_bytes: 2e6,
            halo_bytes: 5e5,
            written_bytes: 1.5e6,
            seconds: 2e-3,
        },
        kept_bytes: 7_800_000,
        mask_bytes: 25_000,
        seconds_per_frame: 0.0012,
        overhead_seconds_per_frame: 0.000_06,
        accelerator: Some(AcceleratorSummary {
            name: "eyeriss".to_owned(),
            whole: cost(4.0),
            masked: cost(0.5),
        }),
        error: Some(WholeComputationError {
            different_frames: 7,
            outputs: outputs(0.012, Some(41.5)),
            dense_seconds_per_frame: 0.0055,
        }),
        tuning: Some(TuningSummary {
            goal: "psnr=40".to_owned(),
            clips: vec!["street".to_owned()],
            frames: 14,
            runs: 21,
            exact: tried(Some(0.0), 0.1, 0.0),
            uniform,
            chosen: tried(None, 0.06, 0.02),
            frozen: tried(None, 0.0, 0.4),
            holds: true,
        }),
        outputs: vec![RecordedOutput {
            name: "output".to_owned(),
            shape: vec![1, 1, 224, 224],
            dtype: "float32",
            array: Some("outputs/output.npy".to_owned()),
            pictures: Some("outputs/output".to_owned()),
        }],
        clips: vec![clip("street", frames)],
        design: "0123456789abcdef".to_owned(),
        configuration: DesignConfig::default(),
        layers: (0..5).map(layer).collect(),
    };
    let frame = |number: u32| {
        let share = 0.05 + 0.04 * f64::from(number * 37 % 11) / 11.0;
        FrameFigures {
            index_in_run: u64::from(number) + 1,
            clip: "street".to_owned(),
            number: u64::from(number) + 1,
            name: format!("frame {number}"),
            active_share: share,
            changed_share: 1.1 * share,
            macs: Macs {
                needed: 1.5 * share * macs.whole_frame,
                scheduled: 1.6 * share * macs.whole_frame,
                ..macs
            },
            seconds: 0.001,
            relative_rms: Some(0.01 * share),
            is_counted: true,
            ..FrameFigures::default()
        }
    };
    let design = DesignConfig::default().validate_for_frames(224, 224).unwrap();
    (summary, (0..frames).map(frame).collect(), design)
}

fn rendered((summary, frames, design): &RunSample) -> String {
    let command =
        ["foveate", "infer", "my net.onnx", "scene:street", "-o", "out"].map(str::to_owned);
    render_page(summary, frames, None, design, &command).unwrap()
}

/// Parses the page as XML, so that every element is closed and every character is escaped.
fn tree(page: &str) -> Document<'_> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(page, options).unwrap()
}

fn classed<'a>(document: &'a Document<'_>, class: &'static str) -> Vec<Node<'a, 'a>> {
    let of = |node: &Node<'_, '_>| {
        node.attribute("class").is_some_and(|all| all.split(' ').any(|one| one == class))
    };
    document.descendants().filter(of).collect()
}

fn by_id<'a>(document: &'a Document<'_>, id: &str) -> Option<Node<'a, 'a>> {
    document.descendants().find(|node| node.attribute("id") == Some(id))
}

/// Returns the keys by which the cells of a row are sorted.
fn sorted_by<'a>(document: &'a Document<'_>, id: &str) -> Vec<&'a str> {
    let row = by_id(document, id).unwrap_or_else(|| panic!("there is no row {id}"));
    row.children().filter_map(|cell| cell.attribute("data-v")).collect()
}

#[test]
fn every_figure_is_there() {
    let sample = sample(29);
    let (summary, frames, design) = &sample;
    let page = rendered(&sample);
    let document = tree(&page);
    for (number, layer) in summary.layers.iter().enumerate() {
        let mut expected = vec![
            number.to_string(),
            layer.name.clone(),
            layer.operator.clone(),
            "1×12×224×224".to_owned(),
        ];
        let shares = [layer.needed_share, layer.scheduled_share, layer.changed_share];
        expected.push(layer.macs.to_string());
        expected.extend(shares.map(|share| share.to_string()));
        expected.extend([layer.weight_bytes, layer.output_bytes].map(|bytes| bytes.to_string()));
        expected.push((1e3 * layer.traffic.seconds).to_string());
        let (masked, whole) = (layer.masked_cost.unwrap(), layer.whole_cost.unwrap());
        expected.extend(
            [masked.cycles, whole.cycles, masked.energy_mj, whole.energy_mj]
                .map(|cost| cost.to_string()),
        );
        expected.push(f64::from(0.05f32).to_string());
        expected.push(layer.relative_rms.unwrap().to_string());
        assert_eq!(sorted_by(&document, &format!("pl{number}")), expected);
    }
    for frame in frames {
        let cells = sorted_by(&document, &format!("pf{}", frame.number));
        let shares =
            [frame.active_share, frame.changed_share, frame.macs.needed / frame.macs.whole_frame];
        assert_eq!(cells[2..5], shares.map(|share| share.to_string()));
    }
    let tuning = summary.tuning.as_ref().unwrap();
    let all = [&[tuning.exact], &tuning.uniform[..], &[tuning.frozen, tuning.chosen]].concat();
    for (number, tried) in all.iter().enumerate() {
        let cells = sorted_by(&document, &format!("pt{number}"));
        assert_eq!(
            cells[3..5],
            [tried.needed_share, tried.outputs.rms_of_variation].map(|value| value.to_string())
        );
    }
    // There are two lines over the layers with MACs, three lines over the frames, one mark per
    // frame for its savings, and one mark per trial of tuning.
    let marks = document
        .descendants()
        .filter(|node| node.tag_name().name() == "a" && node.has_attribute("data-n"));
    let marks: Vec<Node<'_, '_>> = marks.collect();
    assert_eq!(marks.len(), 2 * 4 + (3 + 1) * 29 + all.len());
    for mark in marks {
        let (row, id) = (mark.attribute("href").unwrap(), mark.attribute("data-n").unwrap());
        assert_eq!(row, format!("#p{id}"));
        let title = mark.children().find(|node| node.tag_name().name() == "title").unwrap();
        assert!(title.text().unwrap().lines().count() >= 3, "{title:?}");
    }
    let texts: Vec<&str> = document
        .descendants()
        .filter(|node| node.has_tag_name(("http://www.w3.org/1999/xhtml", "pre")))
        .filter_map(|node| node.text())
        .collect();
    assert_eq!(
        texts,
        ["foveate infer 'my net.onnx' scene:street -o out", &design.config().to_toml()]
    );
    for text in [
        "140.9 M multiplications",
        "9.94 % of them were needed",
        "41.5 dB",
        "eyeriss",
        "outputs/output.npy",
        "is reached on these frames",
    ] {
        assert!(page.contains(text), "{text}");
    }
    for table in classed(&document, "sortable") {
        let cells = |node: Node<'_, '_>| node.children().filter(Node::is_element).count();
        let rows = table.descendants().filter(|node| node.tag_name().name() == "tr");
        let counts: Vec<usize> = rows.map(cells).collect();
        assert!(counts.iter().all(|count| *count == counts[0]), "{counts:?}");
    }
}

#[test]
fn what_a_user_wrote_is_text() {
    let (mut summary, mut frames, design) = sample(3);
    summary.network = format!("folder/{}", BAD.replace('/', "\\"));
    for text in [
        &mut summary.inputs[0],
        &mut summary.layers[1].name,
        &mut summary.outputs[0].name,
        &mut frames[0].name,
    ] {
        BAD.clone_into(text);
    }
    summary.warnings.push(BAD.to_owned());
    summary.problem = Some(BAD.to_owned());
    summary.tuning.as_mut().unwrap().goal = BAD.to_owned();
    summary.accelerator.as_mut().unwrap().name = BAD.to_owned();
    let page = render_page(&summary, &frames, None, &design, &[BAD.to_owned()]).unwrap();
    assert!(!page.contains("<script>alert"));
    let document = tree(&page);
    let scripts = document.descendants().filter(|node| node.tag_name().name() == "script");
    assert_eq!(scripts.count(), 1);
    assert!(
        sorted_by(&document, "pl1").contains(&BAD) && sorted_by(&document, "pf1").contains(&BAD)
    );
}

#[test]
fn nothing_is_loaded_from_elsewhere() {
    let page = rendered(&sample(9));
    let document = tree(&page);
    for node in document.descendants() {
        assert!(!["link", "img", "iframe", "object"].contains(&node.tag_name().name()));
        assert_eq!(node.attribute("src"), None);
        let target = node.attribute("href").unwrap_or("#layers");
        let known = target.strip_prefix('#').and_then(|id| by_id(&document, id));
        assert!(known.is_some(), "{target}");
        let card = node.attribute("data-copy").map(|card| by_id(&document, &format!("c{card}")));
        assert!(!matches!(card, Some(None)), "{node:?}");
    }
    assert!(!page.contains("@import") && !page.contains("url("));
    let urls = page.matches("://").count();
    assert_eq!(urls, page.matches("xmlns=\"http://www.w3.org/1999/xhtml\"").count());
}

/// Returns runs that are hard to show on a page.
fn hard() -> Vec<(&'static str, RunSample)> {
    let mut none = sample(0);
    none.0.tuning = None;
    let mut dense = sample(4);
    dense.0.mode = Computation::Mode(ExecutionMode::Dense);
    (dense.0.tuning, dense.0.error, dense.0.accelerator) = (None, None, None);
    dense.0.macs.needed = dense.0.macs.whole_frame;
    for layer in &mut dense.0.layers {
        (layer.whole_cost, layer.masked_cost, layer.limit, layer.relative_rms) =
            (None, None, None, None);
        (layer.needed_share, layer.scheduled_share, layer.changed_share) = (1.0, 1.04, 1.0);
    }
    let mut exact = sample(6);
    exact.0.tuning = None;
    exact.0.error = Some(WholeComputationError {
        different_frames: 0,
        outputs: outputs(0.0, None),
        dense_seconds_per_frame: 0.005,
    });
    let mut odd = sample(5);
    odd.0.warnings.push("outputs hold values that are infinite or not a number".to_owned());
    odd.0.problem = Some("it was interrupted".to_owned());
    odd.0.error = Some(WholeComputationError {
        different_frames: 5,
        outputs: outputs(f64::NAN, Some(f64::NAN)),
        dense_seconds_per_frame: 0.0,
    });
    odd.0.layers[1].relative_rms = Some(f64::NAN);
    odd.0.layers[2].limit = Some(f32::INFINITY);
    odd.1[2].relative_rms = Some(f64::INFINITY);
    let tuning = odd.0.tuning.as_mut().unwrap();
    tuning.frozen.outputs = outputs(f64::NAN, Some(f64::NAN));
    tuning.uniform[3].outputs = outputs(f64::INFINITY, Some(f64::NEG_INFINITY));
    let mut flat = sample(1);
    flat.0.macs = Macs::default();
    flat.0.layers.truncate(1);
    flat.1[0].macs = Macs::default();
    let mut empty = sample(2);
    empty.0.layers.clear();
    vec![
        ("none", none),
        ("dense", dense),
        ("exact", exact),
        ("odd", odd),
        ("one", flat),
        ("no-layers", empty),
        ("many", sample(5000)),
        ("clips", of_clips()),
        ("all", sample(29)),
    ]
}

#[test]
fn pictures_have_numbers_whatever_the_data() {
    for (name, sample) in hard() {
        let page = rendered(&sample);
        let document = tree(&page);
        for node in document.descendants() {
            for attribute in ["d", "x", "y", "transform", "data-v"] {
                let value = node.attribute(attribute).unwrap_or_default();
                assert!(
                    !value.contains("NaN") && !value.contains("inf") || value.ends_with("Conv"),
                    "{name}: {value}"
                );
                if ["x", "y"].contains(&attribute) && !value.is_empty() {
                    let value: f64 = value.parse().unwrap();
                    assert!((-10.0..=560.0).contains(&value), "{name}: {value}");
                }
            }
            let text = if node.is_text() { node.text().unwrap_or_default() } else { "" };
            let is_script =
                node.parent().is_some_and(|parent| parent.tag_name().name() == "script");
            assert!(
                is_script || !text.contains("NaN") && !text.split(' ').any(|word| word == "inf"),
                "{name}: {text}"
            );
        }
        assert_eq!(page.contains("id=\"plots\""), name != "none");
        assert_eq!(page.contains("nothing is saved"), name == "dense");
        assert_eq!(page.contains("Not complete"), ["odd", "clips"].contains(&name));
        assert_eq!(page.contains("<small>PSNR infinite</small>"), name == "exact");
        assert_eq!(page.contains("The only frame was computed whole"), name == "none");
    }
}

#[test]
fn without_a_counted_frame_no_share_is_told() {
    let mut none = sample(0);
    none.0.tuning = None;
    let page = rendered(&none);
    let document = tree(&page);
    let cells = sorted_by(&document, "pl1");
    assert_eq!(cells[5..8], ["", "", ""], "{cells:?}");
    assert!(!page.contains("were needed"), "nothing was needed of nothing");
}

#[test]
fn of_very_many_frames_the_peaks_are_shown() {
    let mut sample = sample(5000);
    sample.1[4321].macs.needed *= 3.0;
    let shown = most_expensive_frames(&counted_frames(&sample.1), 13);
    assert_eq!(shown.len(), 385);
    assert!(shown.iter().any(|frame| frame.number == 4322));
    assert!(shown.is_sorted_by_key(|frame| frame.number));
    let page = rendered(&sample);
    assert!(page.contains("id=\"pf4322\"") && page.contains("Of every 13 frames in a row"));
    assert!(page.len() < 1_000_000, "{}", page.len());
}

#[test]
fn how_pixels_become_inputs_is_told() {
    let mut sample = sample(3);
    assert!(rendered(&sample).contains("the same in all channels.</p>"));
    sample.0.mapping = PixelMapping { mean: vec![0.485, -0.5, 0.0], scale: vec![0.25] };
    sample.0.layout = "nhwc";
    assert!(rendered(&sample).contains("The model takes them as [1, height, width, channels]"));
    let told = "in all channels, less the mean (0.485, -0.5, 0) and divided by the scale (0.25) of the channel.";
    assert!(rendered(&sample).contains(told));
}

#[test]
fn pages_are_the_same_every_time() {
    let sample = sample(29);
    assert_eq!(rendered(&sample), rendered(&sample));
}

/// A reader with a mouse and a reader with a finger both reach all figures.
#[test]
fn columns_fit_rows_are_in_sight_and_fingers_get_figures() {
    let Some(program) = chromium() else {
        eprintln!("skipped: there is no Chromium in PATH");
        return;
    };
    let page = rendered(&sample(29));
    for width in [1600, 1280, 500] {
        let found = probe_page(&program, &page, width, TIP);
        // The rows are those of the layers, the tuning trials and the frames.
        assert_eq!(found["rows"], 5 + 15 + 29, "{width}: {found}");
        assert_eq!((&found["hidden"], &found["wider"]), (&0.into(), &0.into()), "{width}: {found}");
        assert_eq!((&found["told"], &found["plots"]), (&4.into(), &4.into()), "{width}: {found}");
        assert!(found["mark"].as_f64().unwrap() > 7.0, "{width}: {found}");
        // The tables of narrower windows scroll, and show that they do.
        assert_eq!(found["cut"] == 0, width >= 1280, "{width}: {found}");
    }
}

/// Writes the samples to the folder `FOVEATE_PAGES`, so that a person can look at them in a
/// browser.
#[test]
fn samples_can_be_looked_at() {
    let Some(folder) = std::env::var_os("FOVEATE_PAGES").map(std::path::PathBuf::from) else {
        return;
    };
    for (name, sample) in hard() {
        std::fs::write(folder.join(format!("infer-{name}.html")), rendered(&sample)).unwrap();
    }
}
