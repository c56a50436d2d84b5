// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `infer`, end to end, with the network that is shipped.

use std::fs;
use std::path::Path;

use crate::common::{files_below, run_successfully};
use serde_json::Value;

const DENOISER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");
const QUANTIZED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser-int8.onnx");

fn summary(folder: &Path, more: &[&str]) -> Value {
    summary_of(folder, "5", more)
}

fn summary_of(folder: &Path, frames: &str, more: &[&str]) -> Value {
    run(folder, DENOISER, frames, more)
}

fn run(folder: &Path, network: &str, frames: &str, more: &[&str]) -> Value {
    let args = [
        "infer",
        network,
        "scene:street",
        "-o",
        "out",
        "--max-frames",
        frames,
        "--json",
        "--force",
    ];
    serde_json::from_str(&run_successfully(folder, &[&args[..], more].concat())).unwrap()
}

#[test]
fn exact_modes_are_exact_and_save_most_of_the_work() {
    let dir = tempfile::tempdir().unwrap();
    for mode in ["exact", "compare"] {
        let found = summary(dir.path(), &["--mode", mode, "--reference"]);
        assert_eq!((&found["frames"], &found["counted_frames"]), (&5.into(), &4.into()));
        assert_eq!(
            (&found["error"]["different_frames"], &found["error"]["relative_rms"]),
            (&0.into(), &0.0.into())
        );
        // The network has four layers of 3x3, with 1, 12, 12 and 12 input channels.
        let dense = 224.0 * 224.0 * 9.0 * (12.0 + 144.0 + 144.0 + 12.0);
        assert_eq!(found["macs"]["dense"], dense);
        let needed = found["macs"]["needed"].as_f64().unwrap() / dense;
        assert!(0.0 < needed && needed < 0.2, "{needed}");
        assert!(found["changed_share"].as_f64().unwrap() < needed, "a change spreads");
    }
    let names: Vec<_> =
        files_below(dir.path()).into_iter().map(|(name, _)| name.display().to_string()).collect();
    for name in [
        "depth.png",
        "depth.svg",
        "frames.csv",
        "frames.parquet",
        "frames.png",
        "frames.svg",
        "inference.json",
        "layers.csv",
        "layers.parquet",
    ] {
        assert!(names.iter().any(|found| found.ends_with(name)), "{name} in {names:?}");
    }
    let layers = fs::read_to_string(dir.path().join("out/layers.csv")).unwrap();
    assert!(
        layers.lines().nth(1).unwrap().contains(",Conv+Relu,1x12x224x224,5419008,"),
        "{layers}"
    );
    assert_eq!(fs::read_to_string(dir.path().join("out/frames.csv")).unwrap().lines().count(), 6);
}

/// The table of layers has the bytes that each layer reads and writes, and the bytes of its mask.
#[test]
fn layers_say_what_they_read_and_write() {
    let dir = tempfile::tempdir().unwrap();
    // The bytes of a tensor of one channel.
    let plane = 4.0 * 224.0 * 224.0;
    let channels = [1.0, 12.0, 12.0, 12.0, 1.0];
    for mode in ["dense", "exact"] {
        let found = summary(dir.path(), &["--mode", mode]);
        let layers = found["layers"].as_array().unwrap();
        let convolutions = layers.iter().filter(|layer| layer["macs"] != 0);
        for (layer, channels) in convolutions.zip(channels.windows(2)) {
            let of = |name: &str| layer[name].as_f64().unwrap();
            let (input, output) = (plane * channels[0], plane * channels[1]);
            assert!((of("written_bytes") - of("needed_share") * output).abs() < 1.0, "{layer}");
            if mode == "dense" {
                assert_eq!((of("read_bytes"), of("halo_bytes")), (input, 0.0), "{layer}");
            } else {
                // A layer reads the needed positions and a ring of one position around them; at
                // least that ring has not changed.
                let seen = of("read_bytes") / input;
                let halo = of("halo_bytes") / input;
                assert!(of("needed_share") < seen && seen < 1.5 * of("needed_share"), "{layer}");
                assert!(seen - of("needed_share") <= halo && halo < seen, "{layer}");
            }
        }
        assert_eq!(layers[0]["mask_bytes"], 224 * 224 / 8);
    }
}

#[test]
fn quantized_networks_keep_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let needed = |mode| {
        let found = run(dir.path(), QUANTIZED, "5", &["--mode", mode, "--reference"]);
        assert_eq!(found["error"]["different_frames"], 0);
        // The kept tensors are the input frame, its quantized form, four layers of 8 bits, and two
        // floating-point tensors.
        assert_eq!(found["kept_bytes"], 224 * 224 * (4 + 1 + 3 * 12 + 1 + 4 + 4));
        found["macs"]["needed"].as_f64().unwrap()
    };
    assert!(needed("compare") < needed("exact"));
}

#[test]
fn approximate_modes_say_how_wrong_they_are() {
    let dir = tempfile::tempdir().unwrap();
    let exact = summary(dir.path(), &[]);
    assert_eq!(exact["error"], Value::Null);
    let needed = |found: &Value| found["macs"]["needed"].as_f64().unwrap();
    for mode in ["truncate=0.05", "fixed"] {
        let found = summary(dir.path(), &["--mode", mode]);
        assert_eq!(found["mode"], mode);
        assert!(needed(&found) < needed(&exact), "{mode}");
        let error = found["error"]["relative_rms"].as_f64().unwrap();
        assert!(0.0 < error && error < 0.2, "{mode}: {error}");
    }
    let dense = summary(dir.path(), &["--mode", "dense"]);
    assert_eq!(dense["macs"]["needed"], dense["macs"]["dense"]);
}

/// Limits are chosen on the first half of the frames, and the second half is reported.
#[test]
fn tuned_limits_keep_the_goal_where_they_were_chosen_and_save_more() {
    let dir = tempfile::tempdir().unwrap();
    let found = summary_of(dir.path(), "12", &["--tune", "variation=20%"]);
    assert_eq!((&found["frames"], &found["counted_frames"]), (&6.into(), &5.into()));
    let tuning = &found["tuning"];
    let real = |value: &Value| value.as_f64().unwrap();
    assert_eq!((&tuning["goal"], &tuning["frames"]), (&"variation=20%".into(), &5.into()));
    assert_eq!(
        (&tuning["exact"]["holds"], &tuning["frozen"]["holds"]),
        (&true.into(), &false.into())
    );
    assert!(real(&tuning["chosen"]["rms_of_variation"]) <= 0.2);
    assert!(real(&tuning["chosen"]["needed_share"]) < 0.9 * real(&tuning["exact"]["needed_share"]));
    // The verdict on the second half depends on its own error.
    let error = real(&found["error"]["rms_of_variation"]);
    assert!(error > 0.0);
    assert_eq!(tuning["holds"], error <= 0.2);
    assert!(found["layers"].as_array().unwrap().iter().any(|layer| real(&layer["limit"]) > 0.0));
    let frames = fs::read_to_string(dir.path().join("out/frames.csv")).unwrap();
    assert!(frames.lines().nth(1).unwrap().starts_with("6,"), "{frames}");
    let chart = fs::read_to_string(dir.path().join("out/tuning.svg")).unwrap();
    for label in ["same relative limit", "never computed again", "chosen"] {
        assert!(chart.contains(label), "{label}");
    }
    let rows = fs::read_to_string(dir.path().join("out/tuning.csv")).unwrap();
    for limits in ["exact,0,", "uniform,0.5,", "frozen,,", "chosen,,"] {
        assert!(rows.lines().any(|row| row.starts_with(limits)), "{limits} in {rows}");
    }
}

#[test]
fn images_of_a_set_begin_with_black() {
    let dir = tempfile::tempdir().unwrap();
    // The input is two images of 16x16 pixels, of which the second is black.
    let header = [0, 0, 8, 3, 0, 0, 0, 2, 0, 0, 0, 16, 0, 0, 0, 16];
    let pixels = (0..512u32).map(|at| if at < 256 { (at * 37 % 256).to_le_bytes()[0] } else { 0 });
    fs::write(
        dir.path().join("train-images"),
        header.into_iter().chain(pixels).collect::<Vec<u8>>(),
    )
    .unwrap();
    let args = ["infer", DENOISER, "train-images", "-o", "out", "--force", "--reference"];
    let tuned = run_successfully(dir.path(), &[&args[..6], &["--tune", "psnr=40"]].concat());
    assert!(tuned.contains("tuned      on 1 counted frame before these"), "{tuned}");
    let text = run_successfully(dir.path(), &args);
    assert!(text.contains("0 of 2 differ"), "{text}");
    let frames = fs::read_to_string(dir.path().join("out/frames.csv")).unwrap();
    let needed: Vec<f64> = frames
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(6).unwrap().parse().unwrap())
        .collect();
    assert!(needed[0] > 0.0 && needed[1] == 0.0, "{frames}");
}

/// An accelerator does less work where the masks allow it, and reads all weights.
#[test]
fn accelerators_count_what_the_masks_save() {
    let dir = tempfile::tempdir().unwrap();
    let real = |value: &Value| value.as_f64().unwrap();
    for name in ["systolic-ws", "systolic-os", "eyeriss"] {
        let found = summary(dir.path(), &["--accelerator", name]);
        let (whole, masked) = (&found["accelerator"]["whole"], &found["accelerator"]["masked"]);
        let saved = |key: &str| real(&masked[key]) / real(&whole[key]);
        assert_eq!(found["accelerator"]["name"], name);
        assert!(saved("cycles") < 0.5 && saved("energy_mj") < 0.6, "{name}: {found}");
        assert!(
            saved("cycles") >= real(&found["macs"]["needed"]) / real(&found["macs"]["dense"]),
            "{name}"
        );
        let of_layers: f64 = found["layers"]
            .as_array()
            .unwrap()
            .iter()
            .map(|layer| real(&layer["masked_cost"]["cycles"]))
            .sum();
        assert!((of_layers - real(&masked["cycles"])).abs() < 1e-6 * of_layers, "{name}");
        let dense = summary(dir.path(), &["--accelerator", name, "--mode", "dense"]);
        assert_eq!(dense["accelerator"]["whole"], dense["accelerator"]["masked"], "{name}");
        assert_eq!(&dense["accelerator"]["whole"], whole, "{name}");
    }
}

/// A bias that is not a number is named, and so is the first node whose outputs are not numbers.
#[test]
fn values_that_are_not_numbers_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    let mut model = fs::read(DENOISER).unwrap();
    // The field `raw_data` of 48 bytes is the bias of twelve channels.
    let bias = model.windows(2).position(|bytes| bytes == [0x4a, 48]).unwrap() + 2;
    model[bias..bias + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    fs::write(dir.path().join("odd.onnx"), model).unwrap();
    let args = ["infer", "odd.onnx", "scene:street", "-o", "out", "--max-frames", "3", "--json"];
    let found: Value = serde_json::from_str(&run_successfully(dir.path(), &args)).unwrap();
    let warnings: Vec<_> = found["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|warning| warning.as_str().unwrap())
        .collect();
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    assert!(
        warnings[0].contains("bias` hold 1 values that are infinite or not a number"),
        "{warnings:?}"
    );
    assert!(
        warnings[1].contains("in 3 frames; in the first, frame 0, these begin at node"),
        "{warnings:?}"
    );
    assert_eq!(summary(dir.path(), &[])["warnings"], Value::Array(Vec::new()));
}

/// The loss of the network is printed, written and drawn.
#[test]
fn the_loss_behind_the_camera_is_reported() {
    let dir = tempfile::tempdir().unwrap();
    let infer = ["infer", DENOISER, "scene:street", "-o", "out", "--max-frames", "4", "--force"];
    let infer = [&infer[..], &["--whole-frames", "--preset", "fovea"]].concat();
    let text = run_successfully(dir.path(), &infer);
    for part in ["sent  ", " bytes per frame, ", "PSNR of the receiver's screen", "agreement  "] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let rows = fs::read_to_string(dir.path().join("out/frames.csv")).unwrap();
    let heading = rows.lines().next().unwrap();
    assert!(heading.ends_with("agreement,whole_detections,kept_detections,added_detections"));
    let found = summary_of(dir.path(), "4", &["--whole-frames", "--framing", "letterbox=96x96"]);
    assert_eq!(found["framing"], "letterbox=96x96");
    let sight = &found["sight"];
    let agreement = sight["agreement"].as_f64().unwrap();
    assert!((agreement + sight["relative_rms"].as_f64().unwrap() - 1.0).abs() < 1e-12);
    assert!(sight["detections"].is_null() && sight["truth"].is_null());
}
