// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `infer` without a camera: a network that is only checked, and one that runs on arrays.

use std::fs;
use std::path::Path;

use crate::common::{expect_failure, run_in, run_successfully};
use foveate_network::onnx::{
    AttributeProto, Dimension, GraphProto, ModelProto, NodeProto, OperatorSetIdProto,
    TensorShapeProto, TensorTypeProto, TypeProto, ValueInfoProto,
};
use prost::Message as _;
use serde_json::Value;

const DENOISER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../networks/denoiser.onnx");

fn value(name: &str, kind: i32, shape: &[i64]) -> ValueInfoProto {
    let dim = shape.iter().map(|&length| Dimension { dim_value: Some(length) }).collect();
    let tensor = TensorTypeProto { elem_type: Some(kind), shape: Some(TensorShapeProto { dim }) };
    ValueInfoProto {
        name: Some(name.to_owned()),
        r#type: Some(TypeProto { tensor_type: Some(tensor) }),
    }
}

fn node(kind: &str, inputs: &[&str], output: &str) -> NodeProto {
    NodeProto {
        name: Some(format!("the_{kind}")),
        op_type: Some(kind.to_owned()),
        input: inputs.iter().map(|&name| name.to_owned()).collect(),
        output: vec![output.to_owned()],
        ..NodeProto::default()
    }
}

fn write(
    path: &Path,
    inputs: Vec<ValueInfoProto>,
    nodes: Vec<NodeProto>,
    outputs: Vec<ValueInfoProto>,
) {
    let graph = GraphProto { node: nodes, input: inputs, output: outputs, ..GraphProto::default() };
    let model = ModelProto {
        ir_version: Some(8),
        graph: Some(graph),
        opset_import: vec![OperatorSetIdProto { domain: None, version: Some(20) }],
        ..ModelProto::default()
    };
    fs::write(path, model.encode_to_vec()).unwrap();
}

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
fn a_network_that_can_be_run_is_described() {
    let dir = tempfile::tempdir().unwrap();
    let text = run_successfully(dir.path(), &["infer", DENOISER, "--check"]);
    for line in [
        "denoiser.onnx: all 8 nodes can be run",
        "input      [1, 1, 224, 224], layout nchw",
        "output     clean [1, 1, 224, 224]",
        "operators  1 Conv, 3 Conv+Relu, 1 Sub",
        "MACs       140.9 M per frame",
    ] {
        assert!(text.contains(line), "{line} in {text}");
    }
    let json =
        run_successfully(dir.path(), &["infer", DENOISER, "--check", "--json", "--resize", "8x6"]);
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["network"]["input"], serde_json::json!([1, 1, 6, 8]));
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0, "nothing is written");
}

/// Each node that cannot be run is named once. A node that only depends on such a node is not
/// named.
#[test]
fn all_nodes_that_cannot_be_run_are_named_at_once() {
    let dir = tempfile::tempdir().unwrap();
    let mut odd = node("Elu", &["picture"], "d");
    odd.attribute = vec![AttributeProto {
        name: Some("beta".to_owned()),
        f: Some(1.0),
        ..AttributeProto::default()
    }];
    let nodes = vec![
        node("Einsum", &["picture"], "a"),
        node("Relu", &["a"], "b"),
        node("NonZero", &["b"], "c"),
        odd,
        node("Add", &["b", "d"], "e"),
    ];
    let picture = value("picture", 1, &[1, 1, 4, 4]);
    write(&dir.path().join("m.onnx"), vec![picture], nodes, vec![value("e", 1, &[])]);
    let done = run_in(dir.path(), &["infer", "m.onnx", "--check"]);
    assert_eq!(done.code, 1);
    let text = done.stdout;
    let listed: Vec<&str> = text.lines().filter(|line| line.starts_with("- ")).collect();
    assert_eq!(
        listed,
        [
            "- node `the_Einsum` has the operator `Einsum`, which is not supported",
            "- node `the_NonZero` has the operator `NonZero`, which is not supported",
            "- node `the_Elu` (Elu): it has no attribute `beta` in version 20 of the operators; it has alpha",
        ]
    );
    assert!(text.starts_with("m.onnx: 3 of 5 nodes cannot be run\n"), "{text}");
    assert!(text.contains("operators that can be run: Abs, Add, "), "{text}");
    assert!(done.stderr.contains("3 of the 5 nodes of `m.onnx` cannot be run"), "{}", done.stderr);
    let args = ["infer", "m.onnx", "scene:street", "-o", "out", "--resize", "4x4"];
    expect_failure(dir.path(), 2, &args, &["`foveate infer --check MODEL` lists all"]);
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
    let inputs = vec![value("a", 1, &[2, 3]), value("b", 1, &[3]), value("n", 7, &[2])];
    let nodes = vec![
        node("Mul", &["a", "b"], "product"),
        node("Greater", &["a", "b"], "is_more"),
        node("Add", &["n", "n"], "twice"),
    ];
    let outputs =
        vec![value("product", 1, &[2, 3]), value("is_more", 9, &[2, 3]), value("twice", 7, &[2])];
    write(&dir.path().join("m.onnx"), inputs, nodes, outputs);
    npy(&dir.path().join("a.npy"), "<f4", "2, 3", &floats(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    npy(&dir.path().join("b.npy"), "<f4", "3,", &floats(&[2.0, 2.0, 0.5]));
    let many = [3i64, -(1 << 40)].map(i64::to_le_bytes).concat();
    npy(&dir.path().join("n.npy"), "<i8", "2,", &many);
    let args = ["infer", "m.onnx", "a.npy", "b.npy", "n.npy", "-o", "out"];
    let text = run_successfully(dir.path(), &args);
    assert!(text.contains("output     is_more bool [2, 3] in outputs/is_more.npy"), "{text}");
    let folder = dir.path().join("out/outputs");
    assert_eq!(output(&folder.join("product.npy"), 6), [2.0, 4.0, 1.5, 8.0, 10.0, 3.0]);
    assert!(fs::read(folder.join("is_more.npy")).unwrap().ends_with(&[0, 0, 1, 1, 1, 1]));
    let twice = [6i64, -(1 << 41)].map(i64::to_le_bytes).concat();
    assert!(fs::read(folder.join("twice.npy")).unwrap().ends_with(&twice));
    let few = [&args[..4], &["-o", "two"]].concat();
    expect_failure(dir.path(), 2, &few, &["it has 3 inputs (a, b, n), but 2 arrays are given"]);
}

#[test]
fn arrays_that_do_not_fit_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let picture = value("picture", 1, &[1, 1, 2, 2]);
    let nodes = vec![node("Relu", &["picture"], "out")];
    write(&dir.path().join("m.onnx"), vec![picture], nodes, vec![value("out", 1, &[])]);
    let array = |descr: &str, shape: &str, count: usize| {
        npy(&dir.path().join("x.npy"), descr, shape, &vec![0; count]);
    };
    let says = |more: &[&str], text: &str| {
        let args = [&["infer", "m.onnx"], more, &["-o", "out"]].concat();
        expect_failure(dir.path(), 2, &args, &[text]);
        assert!(!dir.path().join("out").exists());
    };
    array("<f4", "1, 1, 2, 3", 24);
    says(&["x.npy"], "takes an array of shape [1, 1, 2, 2], but the array has [1, 1, 2, 3]");
    array("<f8", "1, 1, 2, 2", 32);
    says(&["x.npy"], "its input `picture` takes FLOAT, but the array holds DOUBLE");
    array("<u2", "1, 1, 2, 2", 8);
    says(&["x.npy"], "holds values of type <u2, which no network here takes");
    array("<f4", "1, 1, 2, 2", 15);
    says(&["x.npy"], "cannot read the array `x.npy`: it ends after 15 of 16 bytes");
    says(&["y.npy"], "cannot read the array `y.npy`: No such file");
    array("<f4", "1, 1, 2, 2", 16);
    says(&["x.npy", "scene:street"], "`scene:street` is not an array (.npy), but other inputs are");
    says(&["x.npy", "--preset", "fovea"], "--preset has no meaning with arrays");
    says(&["x.npy", "--mode", "dense"], "--mode has no meaning with arrays");
    let odd = ["infer", "m.onnx", "--check", "--mode", "dense"];
    expect_failure(dir.path(), 2, &odd, &["--mode has no meaning with --check"]);
}
