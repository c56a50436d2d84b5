// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the network of a page: its results, and the messages of refusals.

use crate::cameras::SIZE;
use foveate_network::onnx::{
    AttributeProto, Dimension, GraphProto, ModelProto, NodeProto, TensorProto, TensorShapeProto,
    TensorTypeProto, TypeProto, ValueInfoProto, data_type,
};
use foveate_web::{NetworkComparison, PageCameras, PageNetwork};
use prost::Message as _;
use serde_json::{Value, json};

fn value(name: &str, shape: &[i64]) -> ValueInfoProto {
    let dim = shape.iter().map(|&length| Dimension { dim_value: Some(length) }).collect();
    let shape = Some(TensorShapeProto { dim });
    let tensor = TensorTypeProto { elem_type: Some(data_type::FLOAT), shape };
    ValueInfoProto {
        name: Some(name.to_owned()),
        r#type: Some(TypeProto { tensor_type: Some(tensor) }),
    }
}

/// Returns a network of one convolution, whose output of `[1, 6, 5, 7]` has the form of
/// `FastestDet` with one class.
fn network_file() -> Vec<u8> {
    let tensor = |name: &str, dims: &[i64], values: Vec<f32>| TensorProto {
        name: Some(name.to_owned()),
        dims: dims.to_vec(),
        data_type: Some(data_type::FLOAT),
        float_data: values,
        ..TensorProto::default()
    };
    let ints = |name: &str| AttributeProto {
        name: Some(name.to_owned()),
        ints: vec![8, 8],
        ..AttributeProto::default()
    };
    let mut weights = vec![0.0; 6 * 64];
    weights[..64].fill(1.0 / 64.0);
    let node = NodeProto {
        op_type: Some("Conv".to_owned()),
        input: ["picture", "weights", "bias"].map(str::to_owned).to_vec(),
        output: vec!["found".to_owned()],
        attribute: vec![ints("kernel_shape"), ints("strides")],
        ..NodeProto::default()
    };
    let graph = GraphProto {
        input: vec![value("picture", &[1, 1, 40, 56])],
        initializer: vec![
            tensor("weights", &[6, 1, 8, 8], weights),
            tensor("bias", &[6], vec![0.0, 0.0, 0.0, -2.0, -2.0, 1.0]),
        ],
        node: vec![node],
        output: vec![value("found", &[])],
    };
    let model = ModelProto { ir_version: Some(8), graph: Some(graph), ..ModelProto::default() };
    model.encode_to_vec()
}

fn open(desk: &mut PageNetwork, wishes: &Value, bits: u32) -> Result<Value, String> {
    let wishes = wishes.to_string();
    desk.open(wishes.as_bytes(), SIZE, bits).map_err(|error| error.to_string())
}

fn settings() -> Value {
    json!({ "name": "squares.onnx", "framing": "letterbox", "detect": "fastestdet,score=0.6" })
}

fn open_network(bits: u32) -> (PageNetwork, Value) {
    let mut desk = PageNetwork::default();
    desk.set_file(network_file()).unwrap();
    let told = open(&mut desk, &settings(), bits).unwrap();
    (desk, told)
}

fn look(
    desk: &PageNetwork,
    whole: &[u16],
    seen: &[u16],
    bits: u32,
) -> Result<NetworkComparison, String> {
    let pixels = whole.iter().chain(seen);
    let bytes: Vec<u8> = if bits <= 8 {
        pixels.map(|pixel| pixel.to_le_bytes()[0]).collect()
    } else {
        pixels.flat_map(|pixel| pixel.to_le_bytes()).collect()
    };
    desk.compare(&bytes).map_err(|error| error.to_string())
}

#[test]
fn guessed_settings_are_reported_as_the_command_takes_them() {
    let (mut desk, told) = open_network(8);
    assert_eq!(told["input"], json!({ "width": 56, "height": 40, "channels": 1 }));
    assert_eq!(told["options"], "--framing letterbox --detect fastestdet,score=0.6,overlap=0.45");
    assert_eq!((&told["likely"], &told["classes"]), (&json!("fastestdet"), &json!(1)));
    let more =
        json!({ "name": "x", "framing": "stretch", "mean": "1/2", "scale": "0.5", "detect": "" });
    let told = open(&mut desk, &more, 8).unwrap();
    assert_eq!(told["options"], "--framing stretch --mean 1/2 --scale 0.5 --whole-frames");
    assert_eq!(told["head"], Value::Null);
}

/// The whole frame is bright on the left, and the screen only in the upper left: half of the
/// detections are kept. The depth changes nothing.
#[test]
fn whole_frame_and_screen_are_compared() {
    for bits in [1, 8, 12] {
        let (desk, _) = open_network(bits);
        let bright = (1 << bits) - 1;
        let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
        let frame = |is: &dyn Fn(usize, usize) -> bool| -> Vec<u16> {
            let pixel = |at: usize| if is(at % width, at / width) { bright } else { 0 };
            (0..width * height).map(pixel).collect()
        };
        let whole = frame(&|x, _| x < width / 2);
        let seen = frame(&|x, y| x < width / 2 && y < height / 2);
        let looked = look(&desk, &whole, &seen, bits).unwrap();
        let found = looked.found.unwrap();
        assert!(found.whole > found.kept && found.kept > 0, "{found:?}");
        assert_eq!((found.added, found.seen), (0, found.kept));
        assert_eq!(looked.whole.len() as u64, found.whole);
        assert_eq!(looked.whole.iter().filter(|one| one.both).count() as u64, found.kept);
        let same = look(&desk, &whole, &whole, bits).unwrap();
        assert_eq!((same.agreement, same.relative_rms), (1.0, 0.0));
    }
}

#[test]
fn what_is_refused_has_a_message() {
    let refused = |problem: Result<Value, String>, says: &str| {
        let problem = problem.unwrap_err();
        assert!(problem.contains(says), "{problem}");
    };
    let mut desk = PageNetwork::default();
    refused(open(&mut desk, &settings(), 8), "there is no network");
    desk.set_file(b"no network".to_vec()).unwrap();
    refused(open(&mut desk, &settings(), 8), "`squares.onnx` is not an ONNX model");
    desk.set_file(network_file()).unwrap();
    for (key, wrong, says) in [
        ("framing", "fill", "letterbox=416x416"),
        ("mean", "1,x", "`x`: expected a number"),
        ("mean", "1,2", "--mean has 2 values, but the network's input has 1 channel;"),
        ("scale", "0", "above 0"),
        ("detect", "yolo", "is not a format of detections"),
        ("detect", "ssd", "`found` [1, 6, 5, 7]"),
        ("colour", "red", "unknown field `colour`"),
    ] {
        let mut wishes = settings();
        wishes[key] = json!(wrong);
        refused(open(&mut desk, &wishes, 8), says);
        assert!(desk.compare(&[]).unwrap_err().to_string().contains("there is no network"));
    }
    refused(open(&mut desk, &settings(), 17), "pixels of 17 bits");
    let pixels = (SIZE.0 * SIZE.1) as usize;
    let (desk, _) = open_network(5);
    let problem = look(&desk, &vec![0; pixels], &[], 5).unwrap_err();
    assert!(problem.contains("bytes are not a frame"), "{problem}");
    let problem = look(&desk, &vec![0; pixels], &vec![32; pixels], 5).unwrap_err();
    assert!(problem.contains("larger than 5 bits"), "{problem}");
}

/// The network takes the pixels that a camera gives.
#[test]
fn planes_of_a_camera_are_those_of_its_depth() {
    for bits in [5, 8, 12] {
        let mut cameras = PageCameras::default();
        let toml = format!("[frame]\npixel_bits = {bits}\n");
        let (handle, _) = cameras.configure(toml.as_bytes(), SIZE).unwrap();
        let grey = cameras.scene_frame(b"street", SIZE, 8, 0).unwrap().to_vec();
        let camera = cameras.camera(handle).unwrap();
        camera.step_grey(&grey, None).unwrap();
        let planes = [camera.pixels(), camera.engine().rendered()].map(|plane| plane.to_words());
        let (desk, _) = open_network(bits);
        assert!(look(&desk, &planes[0], &planes[1], bits).is_ok());
    }
}
