// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `infer` without a camera, on arrays.

use std::fs;
use std::path::Path;

use crate::common::{expect_failure, run_successfully};
use serde_json::Value;

const DENOISER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");
/// A network of a product and a comparison of `a` and `b`, and of the double of `n`.
const THREE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/commands/files/three.onnx");

/// Writes a NumPy file byte by byte.
fn npy(path: &Path, descr: &str, shape: &str, bytes: &[u8]) {
    let words = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({shape}), }}");
    let words = format!("{words:<117}\n");
    let length = u16::try_from(words.len()).unwrap().to_le_bytes();
    fs::write(path, [b"\x93NUMPY\x01\x00", &length[..], words.as_bytes(), bytes].concat()).unwrap();
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Returns the values of an output behind its header.
fn output(path: &Path, count: usize) -> Vec<f32> {
    let bytes = fs::read(path).unwrap();
    let values = &bytes[bytes.len() - 4 * count..];
    values.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect()
}

#[test]
fn arrays_take_the_place_of_a_clip() {
    let dir = tempfile::tempdir().unwrap();
    let picture: Vec<f32> = (0u8..48).map(|at| f32::from(at) / 48.0).collect();
    npy(&dir.path().join("x.npy"), "<f4", "1, 1, 6, 8", &floats(&picture));
    let text = run_successfully(dir.path(), &["infer", DENOISER, "x.npy", "-o", "out"]);
    assert!(text.contains("output     clean float32 [1, 1, 6, 8] in outputs/clean.npy"), "{text}");
    let clean = output(&dir.path().join("out/outputs/clean.npy"), 48);
    assert!(
        clean.iter().zip(&picture).all(|(clean, noisy)| (clean - noisy).abs() < 0.5),
        "{clean:?}"
    );
    let summary = fs::read_to_string(dir.path().join("out/inference.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["outputs"][0]["name"], "clean");
    expect_failure(dir.path(), 2, &["infer", DENOISER, "x.npy", "-o", "out"], &["out"]);
    run_successfully(dir.path(), &["infer", DENOISER, "x.npy", "-o", "out", "--force", "--quiet"]);
}

/// The outputs have the types that the model declares, and the expected values are calculated by
/// hand.
#[test]
fn every_input_has_its_array() {
    let dir = tempfile::tempdir().unwrap();
    npy(&dir.path().join("a.npy"), "<f4", "2, 3", &floats(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    npy(&dir.path().join("b.npy"), "<f4", "3,", &floats(&[2.0, 2.0, 0.5]));
    let many = [3i64, -(1 << 40)].map(i64::to_le_bytes).concat();
    npy(&dir.path().join("n.npy"), "<i8", "2,", &many);
    let args = ["infer", THREE, "a.npy", "b.npy", "n.npy", "-o", "out"];
    let text = run_successfully(dir.path(), &args);
    assert!(text.contains("output     is_more bool [2, 3] in outputs/is_more.npy"), "{text}");
    let folder = dir.path().join("out/outputs");
    assert_eq!(output(&folder.join("product.npy"), 6), [2.0, 4.0, 1.5, 8.0, 10.0, 3.0]);
    assert!(fs::read(folder.join("is_more.npy")).unwrap().ends_with(&[0, 0, 1, 1, 1, 1]));
    let twice = [6i64, -(1 << 41)].map(i64::to_le_bytes).concat();
    assert!(fs::read(folder.join("twice.npy")).unwrap().ends_with(&twice));
}
