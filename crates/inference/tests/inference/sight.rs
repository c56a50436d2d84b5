// SPDX-License-Identifier: MIT OR Apache-2.0
//! The loss of a network behind the camera, and frames that are scaled for the network.

use std::path::{Path, PathBuf};

use crate::common::{RunSetup, number, rows};
use foveate_inference::{
    Computation, Detector, Framing, InferenceError, InferenceSummary, OutputAgreement,
    VisionNetwork, VisionOptions, WholeFrameAgreement, frame_format_of, parse_detector,
    parse_framing,
};
use foveate_network::{
    ExecutionMode,
    onnx::{
        AttributeProto, Dimension, GraphProto, ModelProto, NodeProto, TensorProto,
        TensorShapeProto, TensorTypeProto, TypeProto, ValueInfoProto, data_type,
    },
};
use prost::Message as _;

/// The number of channels: a score, a position, a size and two classes, as in `FastestDet`.
const CHANNELS: usize = 7;

fn value(name: &str, shape: &[i64]) -> ValueInfoProto {
    let dim = shape.iter().map(|&length| Dimension { dim_value: Some(length) }).collect();
    let shape = Some(TensorShapeProto { dim });
    let tensor = TensorTypeProto { elem_type: Some(data_type::FLOAT), shape };
    ValueInfoProto {
        name: Some(name.to_owned()),
        r#type: Some(TypeProto { tensor_type: Some(tensor) }),
    }
}

fn tensor(name: &str, dims: &[i64], values: Vec<f32>) -> TensorProto {
    TensorProto {
        name: Some(name.to_owned()),
        dims: dims.to_vec(),
        data_type: Some(data_type::FLOAT),
        float_data: values,
        ..TensorProto::default()
    }
}

/// Writes a network of one convolution that finds an object in every bright square of 8x8 pixels.
fn bright_squares(folder: &Path) -> PathBuf {
    let logit = |share: f32| (share / (1.0 - share)).ln();
    let mut weights = vec![0.0; CHANNELS * 64];
    weights[..64].fill(1.0 / 64.0);
    // The object lies in the middle of the square, has its size in frames of 64x48 pixels, and
    // class 1.
    let bias =
        vec![0.0, 0.5_f32.atanh(), 0.5_f32.atanh(), logit(1.0 / 8.0), logit(1.0 / 6.0), 0.0, 1.0];
    let ints = |name: &str, ints: &[i64]| AttributeProto {
        name: Some(name.to_owned()),
        ints: ints.to_vec(),
        ..AttributeProto::default()
    };
    let channels = i64::try_from(CHANNELS).unwrap();
    let graph = GraphProto {
        input: vec![value("picture", &[1, 1, 48, 64])],
        initializer: vec![
            tensor("weights", &[channels, 1, 8, 8], weights),
            tensor("bias", &[channels], bias),
        ],
        node: vec![NodeProto {
            op_type: Some("Conv".to_owned()),
            name: Some("squares".to_owned()),
            input: ["picture", "weights", "bias"].map(str::to_owned).to_vec(),
            output: vec!["found".to_owned()],
            attribute: vec![ints("kernel_shape", &[8, 8]), ints("strides", &[8, 8])],
            ..NodeProto::default()
        }],
        output: vec![value("found", &[])],
    };
    let model = ModelProto { ir_version: Some(8), graph: Some(graph), ..ModelProto::default() };
    let path = folder.join("squares.onnx");
    std::fs::write(&path, model.encode_to_vec()).unwrap();
    path
}

fn squares() -> Detector {
    parse_detector("fastestdet,score=0.6").unwrap()
}

fn run(folder: &Path, camera: &str, boxes: &[PathBuf]) -> Result<InferenceSummary, InferenceError> {
    let network = bright_squares(folder);
    let (network, detector) = (Some(network.as_path()), Some(squares()));
    let run = RunSetup { network, detector, boxes, camera, ..RunSetup::default() };
    RunSetup { sight: true, frames: 6, ..run }.write(folder)
}

fn sight(folder: &Path, camera: &str) -> WholeFrameAgreement {
    run(folder, camera, &[]).unwrap().sight.unwrap()
}

/// The receiver shows regions without edges as black, or as their means. This network depends only
/// on means.
#[test]
fn means_keep_objects_that_black_regions_lose() {
    let dir = tempfile::tempdir().unwrap();
    let mean = "[render]\nirrelevant = \"mean\"\n[periphery]\nblocks = 1\nlevel = 0\n[denoise]\nfilter = \"none\"\n[temporal]\nreference = \"last-sent\"\nlevel = 0\nmin_count = 1\n";
    let (nothing, means) = (sight(dir.path(), ""), sight(dir.path(), mean));
    let [lost, kept] = [&nothing, &means].map(|sight| sight.detections.clone().unwrap());
    assert!(lost.all.whole > 20 && lost.kept_share < 0.9, "{lost:?}");
    assert_eq!(lost.all.whole, kept.all.whole);
    assert!(kept.kept_share > 0.95 && kept.precision > 0.95, "{kept:?}");
    assert!((means.agreement - kept.kept_share.min(kept.precision)).abs() < 1e-12);
    assert!(means.picture_psnr.unwrap() > nothing.picture_psnr.unwrap() + 6.0);
    assert!(means.relative_rms < nothing.relative_rms);
    // A mean for each of 48 regions adds at most 48 bytes, without the pixels of the first frame.
    assert!(means.sent_bytes > 12.0 && means.sent_share < 1.0);
    // The table has the counted detections, and the sizes add up.
    let rows = rows(dir.path(), "detections.parquet");
    assert_eq!(rows.len() as u64, kept.all.whole + kept.all.seen);
    assert_eq!(kept.all.whole, kept.small.whole + kept.medium.whole + kept.large.whole);
    assert!(rows.iter().all(|row| number(row, "score") >= 0.6 && number(row, "class") == 1.0));
    let page = std::fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(page.contains("What the network loses") && page.contains("data:image/png;base64,"));
    assert!(page.matches("class=\"kept\"").count() > 10);
}

#[test]
fn the_table_of_a_network_that_finds_nothing_has_its_columns() {
    let dir = tempfile::tempdir().unwrap();
    let network = bright_squares(dir.path());
    let header = |detector: &str| {
        let (network, detector) = (Some(network.as_path()), parse_detector(detector));
        let run = RunSetup { network, detector: Some(detector.unwrap()), ..RunSetup::default() };
        let sight = RunSetup { sight: true, ..run }.write(dir.path()).unwrap().sight.unwrap();
        let table = std::fs::read_to_string(dir.path().join("out/detections.csv")).unwrap();
        let lines: Vec<_> = table.lines().map(str::to_owned).collect();
        assert_eq!(lines.len() == 1, sight.detections.unwrap().all.whole == 0);
        lines[0].clone()
    };
    let found = header("fastestdet,score=0.6");
    assert!(found.starts_with("clip,frame,name,whole,both,class,score,"), "{found}");
    assert_eq!(header("fastestdet,score=0.999999"), found);
    assert!(rows(dir.path(), "detections.parquet").is_empty());
}

/// Noise is added to a few frames that are spread evenly. Larger noise loses more detections. The
/// smallest noise changes nothing, so all detections are found again.
#[test]
fn detections_are_lost_under_noise() {
    let dir = tempfile::tempdir().unwrap();
    let network = bright_squares(dir.path());
    let (network, detector) = (Some(network.as_path()), Some(squares()));
    let noise = &[0.05, 4.0, 40.0, 255.0];
    let run =
        RunSetup { network, detector, noise, sight: true, frames: 120, ..RunSetup::default() };
    let sight = run.write(dir.path()).unwrap().sight.unwrap();
    let found: Vec<_> = sight.noise.iter().map(|noisy| noisy.detections.unwrap()).collect();
    // At most 48 of the 119 counted frames get noise: every fourth, from the first.
    assert!(sight.noise.iter().all(|noisy| noisy.frames == 30));
    assert!(found.iter().all(|level| level.whole == found[0].whole && level.whole > 50));
    assert_eq!((found[0].kept, found[0].added), (found[0].whole, 0));
    assert!(sight.noise.is_sorted_by(|one, next| one.agreement > next.agreement), "{found:?}");
    for noisy in &sight.noise {
        let (kept, right) = (noisy.kept_share.unwrap(), noisy.precision.unwrap());
        assert_eq!(noisy.agreement, kept.min(right));
        let [low, high] = noisy.intervals.agreement.unwrap();
        assert!(low <= noisy.agreement && noisy.agreement <= high && low < high);
    }
    assert!(sight.intervals.kept.is_some() && sight.intervals.right.is_some());
    // Fewer objects give a wider interval.
    let few = RunSetup { frames: 3, ..run }.write(dir.path()).unwrap().sight.unwrap();
    let width = |[low, high]: [f64; 2]| high - low;
    let [few, many] = [&few, &sight].map(|sight| width(sight.intervals.agreement.unwrap()));
    assert!(few > 2.0 * many, "{few} and {many}");
}

/// Without a detector the outputs are a class at every position, and positions are too alike to say
/// anything about other frames.
#[test]
fn places_have_no_interval() {
    let dir = tempfile::tempdir().unwrap();
    let network = bright_squares(dir.path());
    let run =
        RunSetup { network: Some(&network), noise: &[40.0], sight: true, ..RunSetup::default() };
    let sight = run.write(dir.path()).unwrap().sight.unwrap();
    assert!(sight.same_places.is_some_and(|share| share == sight.agreement));
    for intervals in [sight.intervals, sight.noise[0].intervals] {
        assert_eq!(intervals, foveate_inference::ConfidenceIntervals::default());
    }
}

/// The ground truth is what the network finds in whole frames, so its precision there is 1.
#[test]
fn precision_is_against_ground_truth() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), "", &[]).unwrap();
    // In the format of MOT, frames and coordinates begin at 1.
    let mut table = String::new();
    for (track, row) in rows(dir.path(), "detections.parquet").iter().enumerate() {
        let [x0, y0, x1, y1] = ["x0", "y0", "x1", "y1"].map(|name| number(row, name));
        if row["whole"] == parquet::record::Field::Bool(true) {
            let (frame, width, height) = (number(row, "frame") + 1.0, x1 - x0, y1 - y0);
            let place = format!("{},{},{width},{height}", x0 + 1.0, y0 + 1.0);
            table += &format!("{frame},{},{place},1,1,1\n", track + 1);
        }
    }
    let boxes = dir.path().join("gt.txt");
    std::fs::write(&boxes, table).unwrap();
    let found = run(dir.path(), "", std::slice::from_ref(&boxes));
    let summary = found.unwrap();
    let truth = summary.sight.unwrap().truth.unwrap();
    assert!(truth.objects > 20);
    assert_eq!((truth.whole_ap50, truth.whole_recall), (1.0, 1.0));
    assert!(truth.seen_ap50 < 0.95 && truth.seen_recall < 0.9, "{truth:?}");
}

/// The findings in two frames are compared. Equal frames agree fully, and a frame with half of the
/// objects agrees by 0.5. Frames of another size and a detector that does not fit are refused.
#[test]
fn half_of_the_objects_give_an_agreement_of_one_half() {
    let dir = tempfile::tempdir().unwrap();
    let network = bright_squares(dir.path());
    let vision_options = VisionOptions {
        framing: Framing::Same,
        mapping: foveate_inference::PixelMapping { mean: vec![0.0], scale: vec![1.0] },
        detector: Some(squares()),
    };
    let vision_network =
        VisionNetwork::read(&network, foveate_tools::open_file, (64, 48), &vision_options).unwrap();
    let mut config = foveate_camera::CameraConfig::default();
    (config.frame.width, config.frame.height) = (Some(64), Some(48));
    let camera = config.validate().unwrap();
    let bright: Vec<u8> = (0..64 * 48).map(|at| if at % 64 < 16 { 250 } else { 10 }).collect();
    let half: Vec<u8> = (0..64 * 48).map(|at| if at % 64 < 8 { 250 } else { 10 }).collect();
    let mut looking = vision_network.start_run(frame_format_of(&camera));
    let [whole, other] =
        [&bright, &half].map(|pixels| looking.outcome(foveate_pixels::FramePixels::Bytes(pixels)));
    let same = vision_network.compare(&whole, &whole);
    assert_eq!((same.share(), same.detection_counts().unwrap().whole), (1.0, 12));
    let less = vision_network.compare(&whole, &other);
    assert_eq!((less.share(), less.detection_counts().unwrap().kept), (0.5, 6));
    let both: OutputAgreement = [&less, &same].into_iter().sum();
    assert_eq!(both.share(), 0.75);
    assert!(
        VisionNetwork::read(&network, foveate_tools::open_file, (32, 48), &vision_options)
            .unwrap_err()
            .to_string()
            .contains("letterbox")
    );
    let vision_options =
        VisionOptions { detector: Some(parse_detector("ssd").unwrap()), ..vision_options };
    assert!(
        VisionNetwork::read(&network, foveate_tools::open_file, (64, 48), &vision_options)
            .unwrap_err()
            .to_string()
            .contains("`found` [1, 7, 6, 8]")
    );
}

/// Frames that are scaled behind the camera are also computed exactly: the mask covers every input
/// that changed.
#[test]
fn scaled_frames_are_exact() {
    let dir = tempfile::tempdir().unwrap();
    for text in ["letterbox=48x48", "stretch=40x56", "stretch=96x72"] {
        let framing = parse_framing(text).unwrap();
        let computed = Computation::Mode(ExecutionMode::Exact);
        let run = RunSetup { framing, computed, reference: true, frames: 4, ..RunSetup::default() };
        let summary = run.write(dir.path()).unwrap();
        assert_eq!(summary.error.unwrap().different_frames, 0, "{text}");
        assert!(summary.macs.needed < summary.macs.whole_frame, "{text}");
        let (width, height) = (summary.layers[0].shape[3], summary.layers[0].shape[2]);
        assert!(text.ends_with(&format!("{width}x{height}")), "{text}");
        assert_eq!(serde_json::to_value(&summary).unwrap()["framing"], text);
    }
    // The denoiser takes any size, so the user must name one.
    let problem =
        RunSetup { framing: Framing::Letterbox(None), ..RunSetup::default() }.write(dir.path());
    assert!(problem.unwrap_err().to_string().contains("letterbox=416x416"));
}

/// Nothing is lost behind a camera that leaves nothing out.
#[test]
fn whole_frames_agree_with_themselves() {
    let dir = tempfile::tempdir().unwrap();
    let camera = "[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"mad\"\nmin_score = 0\n[temporal]\nlevel = 0\nmin_count = 0\n";
    let run = RunSetup { sight: true, camera, ..RunSetup::default() };
    let sight = run.write(dir.path()).unwrap().sight.unwrap();
    assert_eq!((sight.agreement, sight.relative_rms, sight.picture_psnr), (1.0, 0.0, None));
    assert!((sight.sent_share - 1.0 - 12.0 / 3072.0).abs() < 1e-9, "{}", sight.sent_share);
    assert!(sight.detections.is_none() && sight.classes.is_none() && sight.same_places.is_none());
}
