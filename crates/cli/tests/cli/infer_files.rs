// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `infer`, end to end: its page, and the outputs of the network as files.

use std::fs;
use std::path::Path;

use crate::common::{expect_failure, run_successfully};
use serde_json::Value;

const DENOISER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");
const SIDE: usize = 224;

/// Runs the denoiser over a few frames of a street.
fn denoise(folder: &Path, frames: &str, more: &[&str]) -> Value {
    let args =
        ["infer", DENOISER, "scene:street", "-o", "out", "--json", "--force", "--max-frames"];
    serde_json::from_str(&run_successfully(folder, &[&args[..], &[frames], more].concat())).unwrap()
}

/// Returns the shape in the header of an array of 32-bit floating-point values, and the values.
fn array(path: &Path) -> (String, Vec<f32>) {
    let bytes = fs::read(path).unwrap();
    let header = std::str::from_utf8(&bytes[10..128]).unwrap();
    let (_, rest) =
        header.split_once("'descr': '<f4', 'fortran_order': False, 'shape': (").unwrap();
    let values = bytes[128..].chunks(4).map(|four| f32::from_le_bytes(four.try_into().unwrap()));
    (rest.split_once(')').unwrap().0.to_owned(), values.collect())
}

/// Returns a column of a table by its name.
fn column(folder: &Path, file: &str, name: &str) -> Vec<String> {
    let text = fs::read_to_string(folder.join("out").join(file)).unwrap();
    let mut lines = text.lines();
    let at = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(at).unwrap().to_owned()).collect()
}

/// The outputs of exact modes are bit for bit those of a dense run. The error of another mode
/// follows from the files.
#[test]
fn outputs_of_every_mode_are_files() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let of = |mode: &str| {
        let found = denoise(dir.path(), "4", &["--mode", mode, "--outputs", "npy"]);
        assert_eq!(found["outputs"][0]["name"], "clean", "{mode}");
        assert_eq!(found["outputs"][0]["array"], "outputs/clean.npy", "{mode}");
        assert_eq!(found["outputs"][0]["pictures"], Value::Null, "{mode}");
        let (shape, values) = array(&out.join("outputs/clean.npy"));
        assert_eq!(shape, "4, 1, 1, 224, 224", "{mode}");
        assert_eq!(values.len(), 4 * SIDE * SIDE, "{mode}");
        values
    };
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    let dense = of("dense");
    assert!(dense.iter().any(|&value| value > 0.1));
    for mode in ["exact", "compare"] {
        assert!(bits(&of(mode)) == bits(&dense), "{mode}");
    }
    for mode in ["truncate=0.05", "fixed"] {
        let found = of(mode);
        let told = column(dir.path(), "frames.csv", "relative_rms");
        for (frame, told) in told.iter().enumerate() {
            let part = frame * SIDE * SIDE..(frame + 1) * SIDE * SIDE;
            let (mut difference, mut right) = (0.0, 0.0);
            for (&one, &other) in dense[part.clone()].iter().zip(&found[part]) {
                difference += (f64::from(one) - f64::from(other)).powi(2);
                right += f64::from(one).powi(2);
            }
            let told: f64 = told.parse().unwrap();
            assert!(
                ((difference / right).sqrt() - told).abs() < 1e-12,
                "{mode}, frame {frame}: {told}"
            );
        }
        assert!(bits(&found) != bits(&dense), "{mode}");
    }
}

/// There is a picture for each frame of the array. In a tuned run these are the frames of the
/// second half.
#[test]
fn pictures_are_those_of_the_arrays() {
    let dir = tempfile::tempdir().unwrap();
    let found = denoise(dir.path(), "8", &["--outputs", "npy,png", "--tune", "variation=20%"]);
    assert_eq!(found["outputs"][0]["pictures"], "outputs/clean");
    let outputs = dir.path().join("out/outputs");
    let (shape, values) = array(&outputs.join("clean.npy"));
    assert_eq!(shape, "4, 1, 1, 224, 224");
    assert_eq!(column(dir.path(), "frames.csv", "frame"), ["4", "5", "6", "7"]);
    let mut names: Vec<_> = fs::read_dir(outputs.join("clean"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    assert_eq!(names, ["000000.png", "000001.png", "000002.png", "000003.png"]);
    let picture = fs::read(outputs.join("clean/000000.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
    assert_eq!(picture[16..24], [0, 0, 0, 224, 0, 0, 0, 224], "width and height");
    assert!(values.iter().all(|value| value.is_finite()));
}

/// Returns a field of Protocol Buffers that holds bytes.
fn field(number: u8, bytes: &[u8]) -> Vec<u8> {
    [&[number << 3 | 2, u8::try_from(bytes.len()).unwrap()], bytes].concat()
}

/// Returns a field that holds a small number.
fn small(number: u8, value: u8) -> Vec<u8> {
    vec![number << 3, value]
}

/// Returns an ONNX model of some nodes, from `x` to an output.
fn model(nodes: &[Vec<u8>], input: [u8; 4], output: (&str, [u8; 4])) -> Vec<u8> {
    let dimension = |length: u8| field(1, &small(1, length));
    let value = |name: &str, shape: [u8; 4]| {
        let shape: Vec<u8> = shape.into_iter().flat_map(dimension).collect();
        let tensor = [small(1, 1), field(2, &shape)].concat();
        [field(1, name.as_bytes()), field(2, &field(1, &tensor))].concat()
    };
    let graph = [
        nodes.iter().flat_map(|node| field(1, node)).collect(),
        field(2, b"g"),
        field(11, &value("x", input)),
        field(12, &value(output.0, output.1)),
    ];
    // The version of the file is 8, and that of the operators is 13.
    let graph = graph.concat();
    let length = u8::try_from(graph.len() % 128).unwrap() | 0x80;
    let graph =
        [&[7 << 3 | 2, length, u8::try_from(graph.len() / 128).unwrap()], &graph[..]].concat();
    [small(1, 8), field(8, &small(2, 13)), graph].concat()
}

/// Returns a node with one input.
fn node(kind: &str, from: &str, to: &str) -> Vec<u8> {
    let name = format!("node {to}");
    let fields = [(1, from), (2, to), (3, &name), (4, kind)];
    fields.into_iter().flat_map(|(number, text)| field(number, text.as_bytes())).collect()
}

/// Returns an ONNX model of one global pooling, with names that need escapes.
fn pooling(name: &str) -> Vec<u8> {
    model(&[node("GlobalAveragePool", "x", name)], [1, 1, 32, 32], (name, [1; 4]))
}

/// A network that was exported from TensorFlow is read with channels first, and the output says so.
#[test]
fn channels_may_be_last() {
    let dir = tempfile::tempdir().unwrap();
    let order: Vec<u8> = [0, 3, 1, 2].into_iter().flat_map(|axis| small(8, axis)).collect();
    // The last field says that the attribute holds integers.
    let attribute = field(5, &[field(1, b"perm"), order, vec![0xa0, 1, 7]].concat());
    let turn = [node("Transpose", "x", "y"), attribute].concat();
    let last =
        model(&[turn, node("GlobalAveragePool", "y", "z")], [1, 48, 64, 3], ("z", [1, 3, 1, 1]));
    fs::write(dir.path().join("last.onnx"), last).unwrap();
    let first = model(&[node("GlobalAveragePool", "x", "z")], [1, 3, 48, 64], ("z", [1, 3, 1, 1]));
    fs::write(dir.path().join("first.onnx"), first).unwrap();
    let run = |name: &str| {
        let args = ["infer", name, "scene:street", "-o", "out", "--force", "--outputs", "npy"];
        let more = ["--max-frames", "3", "--set", "frame={width=64,height=48}"];
        let text = run_successfully(dir.path(), &[&args[..], &more].concat());
        let found = fs::read(dir.path().join("out/inference.json")).unwrap();
        let found: Value = serde_json::from_slice(&found).unwrap();
        (text, found["layout"].clone(), array(&dir.path().join("out/outputs/z.npy")))
    };
    let ((first, last), more) = ((run("first.onnx"), run("last.onnx")), ", layout nhwc\n");
    assert!(!first.0.contains(more) && last.0.contains(more), "{}", last.0);
    assert_eq!((first.1, last.1), ("nchw".into(), "nhwc".into()));
    assert_eq!(first.2, last.2);
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(page.contains("(layout nhwc); its Transpose to channels first is left out"));
    let relu = model(&[node("Relu", "x", "z")], [1, 48, 64, 3], ("z", [1, 48, 64, 3]));
    fs::write(dir.path().join("relu.onnx"), relu).unwrap();
    let args = ["infer", "relu.onnx", "scene:street", "-o", "out", "--force"];
    let parts = ["`node z` (Relu) takes it in this order", "--inputs-as-nchw x"];
    expect_failure(dir.path(), 2, &args, &parts);
}

/// A network whose output is its input costs nothing.
#[test]
fn a_network_without_nodes_costs_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let shape = [1, 1, 32, 32];
    fs::write(dir.path().join("none.onnx"), model(&[], shape, ("x", shape))).unwrap();
    let args = ["infer", "none.onnx", "scene:street", "--resize", "32x32", "-o", "out"];
    let args = [&args[..], &["--accelerator", "eyeriss", "--max-frames"]].concat();
    let text = run_successfully(dir.path(), &[&args[..], &["3"]].concat());
    assert!(text.contains("MACs       0.0 M per frame; needed 0.0 %"), "{text}");
    let alone = run_successfully(dir.path(), &[&args[..], &["1", "--force"]].concat());
    assert!(alone.starts_with("out: 1 frame of 32 x 32 pixels"), "{alone}");
    for file in ["inference.json", "report.html", "frames.csv"] {
        let text = fs::read_to_string(dir.path().join("out").join(file)).unwrap();
        assert!(!text.contains("-0.0"), "{file}: {text}");
    }
}

#[test]
fn names_of_a_model_are_safe_in_files_and_text_on_the_page() {
    let dir = tempfile::tempdir().unwrap();
    let name = "../<b>&\"out\"";
    fs::write(dir.path().join("it's.onnx"), pooling(name)).unwrap();
    let args = [
        "infer",
        "it's.onnx",
        "scene:street",
        "--resize",
        "32x32",
        "--max-frames",
        "3",
        "-o",
        "out",
    ];
    run_successfully(dir.path(), &[&args[..], &["--outputs", "npy"]].concat());
    let (shape, values) = array(&dir.path().join("out/outputs/____b___out_.npy"));
    assert_eq!((shape.as_str(), values.len()), ("3, 1, 1, 1, 1", 3));
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(!page.contains("<b>&\"") && !page.contains(name));
    assert!(page.contains("../&#60;b&#62;&#38;&#34;out&#34;"), "its node and its output are named");
    assert!(
        page.contains(
            "foveate infer &#39;it&#39;\\&#39;&#39;s.onnx&#39; scene:street --resize 32x32"
        )
    );
    // A single mean is no picture.
    let png = [&args[..], &["--outputs", "png", "--force"]].concat();
    expect_failure(dir.path(), 2, &png, &["no output is a picture", "1x1x1x1", "leave out png"]);
    assert!(dir.path().join("out/outputs/____b___out_.npy").is_file(), "what was there stays");
}

/// The page has the figures of the tables, and is replaced together with them.
#[test]
fn the_page_shows_the_figures_of_the_tables() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("out/report.html");
    for (frames, more) in [
        ("3", &["--reference", "--accelerator", "eyeriss"][..]),
        ("8", &["--tune", "variation=20%"]),
        ("2", &["--mode", "dense"]),
        ("1", &[]),
    ] {
        let found = denoise(dir.path(), frames, more);
        let page = fs::read_to_string(&file).unwrap();
        let is_counted = found["counted_frames"] != 0;
        for name in ["needed_share", "whole_cycles", "relative_rms", "limit"] {
            let values = column(dir.path(), "layers.csv", name);
            let known = values.iter().filter(|value| !value.is_empty() && is_counted);
            known.for_each(|value| {
                assert!(page.contains(&format!("data-v=\"{value}\"")), "{more:?}: {name} {value}");
            });
        }
        // The first frame of a clip is not counted; in a tuned run, the first frame of the second
        // half is not counted.
        let numbers = column(dir.path(), "frames.csv", "frame");
        for number in &numbers[1..] {
            assert!(page.contains(&format!("<tr id=\"pf{number}\"")), "{more:?}: frame {number}");
        }
        assert!(!page.contains(&format!("<tr id=\"pf{}\"", numbers[0])), "{more:?}");
        assert_eq!(page.contains("nothing is saved"), more.contains(&"dense"));
        assert_eq!(page.contains("id=\"tuning\""), more.contains(&"--tune"));
        assert_eq!(page.contains("The only frame was computed whole"), frames == "1");
        assert!(
            page.contains("--max-frames") && page.contains("[region]") && page.ends_with("</html>")
        );
    }
    // Files of other programs keep a folder from being replaced.
    denoise(dir.path(), "2", &["--outputs", "png"]);
    fs::write(dir.path().join("out/outputs/mine.txt"), "mine").unwrap();
    let args = ["infer", DENOISER, "scene:street", "-o", "out", "--max-frames", "2", "--force"];
    expect_failure(dir.path(), 2, &args, &["`out`", "outputs/mine.txt"]);
}

/// The files that remain after Ctrl-C are complete.
#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_whole_outputs_and_a_page_that_says_so() {
    use std::process::Stdio;
    let dir = tempfile::tempdir().unwrap();
    let args = [
        "infer",
        DENOISER,
        "scene:street",
        "-o",
        "out",
        "--max-frames",
        "100000",
        "--outputs",
        "npy,png",
    ];
    let child = crate::common::foveate_with_signals()
        .args(args)
        .current_dir(dir.path())
        .env("FOVEATE_PROGRESS", "0")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let begun = || {
        let mut entries = fs::read_dir(dir.path()).unwrap().flatten();
        entries.any(|entry| entry.path().join("work/outputs/clean/000002.png").exists())
    };
    let patience = std::time::Instant::now() + std::time::Duration::from_secs(120);
    while !begun() && std::time::Instant::now() < patience {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
    let out = dir.path().join("out");
    let found: Value =
        serde_json::from_slice(&fs::read(out.join("inference.json")).unwrap()).unwrap();
    assert_eq!(found["complete"], false);
    let frames = usize::try_from(found["frames"].as_u64().unwrap()).unwrap();
    assert!(frames >= 3);
    let (shape, values) = array(&out.join("outputs/clean.npy"));
    assert_eq!((shape, values.len()), (format!("{frames}, 1, 1, 224, 224"), frames * SIDE * SIDE));
    assert_eq!(fs::read_dir(out.join("outputs/clean")).unwrap().count(), frames);
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(
        page.contains("Not complete")
            && page.contains("it was interrupted")
            && page.ends_with("</html>")
    );
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1, "nothing else is left");
}
