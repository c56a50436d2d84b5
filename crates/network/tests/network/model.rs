// SPDX-License-Identifier: MIT OR Apache-2.0
//! A builder of ONNX models for tests.

use foveate_network::{
    FrameSize, Network, NetworkError,
    onnx::{
        AttributeProto, Dimension, GraphProto, ModelProto, NodeProto, OperatorSetIdProto,
        TensorProto, TensorShapeProto, TensorTypeProto, TypeProto, ValueInfoProto, data_type,
    },
};
use prost::Message as _;
use std::path::Path;

/// A model under construction. Its input is named `picture`.
#[derive(Default)]
pub(crate) struct ModelBuilder {
    pub(crate) graph: GraphProto,
    /// The version of the operators; without one it is the newest.
    pub(crate) opset: Option<i64>,
    count: usize,
}

impl ModelBuilder {
    pub(crate) fn new(shape: &[i64]) -> Self {
        let mut model = Self::default();
        model.graph.input.push(value("picture", shape));
        model
    }

    /// Adds a constant of floating-point values, and returns its name.
    pub(crate) fn floats(&mut self, shape: &[i64], values: &[f32]) -> String {
        let tensor = TensorProto {
            data_type: Some(data_type::FLOAT),
            float_data: values.to_vec(),
            ..TensorProto::default()
        };
        self.constant(shape, tensor)
    }

    /// Adds a constant list of 64-bit integers, and returns its name.
    pub(crate) fn ints(&mut self, values: &[i64]) -> String {
        let tensor = TensorProto {
            data_type: Some(data_type::INT64),
            int64_data: values.to_vec(),
            ..TensorProto::default()
        };
        self.constant(&[values.len().cast_signed() as i64], tensor)
    }

    /// Adds a constant 64-bit integer, and returns its name.
    pub(crate) fn index(&mut self, value: i64) -> String {
        let tensor = TensorProto {
            data_type: Some(data_type::INT64),
            int64_data: vec![value],
            ..TensorProto::default()
        };
        self.constant(&[], tensor)
    }

    /// Adds a constant of integers of an ONNX type, and returns its name.
    pub(crate) fn typed(&mut self, data_type: i32, shape: &[i64], values: &[i32]) -> String {
        let tensor = TensorProto {
            data_type: Some(data_type),
            int32_data: values.to_vec(),
            ..TensorProto::default()
        };
        self.constant(shape, tensor)
    }

    fn constant(&mut self, shape: &[i64], tensor: TensorProto) -> String {
        self.count += 1;
        let name = format!("constant{}", self.count);
        self.graph.initializer.push(TensorProto {
            name: Some(name.clone()),
            dims: shape.to_vec(),
            ..tensor
        });
        name
    }

    /// Adds a node, and returns the name of its output. The operator is one of onnxruntime if
    /// `kind` begins with its domain.
    pub(crate) fn node(
        &mut self,
        kind: &str,
        inputs: &[&str],
        attributes: &[(&str, AttributeValue)],
    ) -> String {
        self.count += 1;
        let output = format!("value{}", self.count);
        let kind_alone = kind.strip_prefix("com.microsoft.");
        self.graph.node.push(NodeProto {
            op_type: Some(kind_alone.unwrap_or(kind).to_owned()),
            domain: kind_alone.map(|_| "com.microsoft".to_owned()),
            name: Some(format!("{kind}{}", self.count)),
            input: inputs.iter().map(|&name| name.to_owned()).collect(),
            output: vec![output.clone()],
            attribute: attributes.iter().map(|(name, value)| value.attribute(name)).collect(),
        });
        output
    }

    /// Declares a tensor as an output.
    pub(crate) fn output(&mut self, name: &str) {
        self.graph.output.push(value(name, &[]));
    }

    pub(crate) fn bytes(self) -> Vec<u8> {
        let own = |version| OperatorSetIdProto { domain: None, version: Some(version) };
        let opset_import = self.opset.map(own).into_iter().collect();
        ModelProto {
            ir_version: Some(8),
            graph: Some(self.graph),
            opset_import,
            ..ModelProto::default()
        }
        .encode_to_vec()
    }

    pub(crate) fn read(self, width: usize, height: usize) -> Result<Network, NetworkError> {
        Network::parse(&self.bytes(), Path::new("test.onnx"), FrameSize { width, height })
    }
}

#[derive(Clone, Debug)]
pub(crate) enum AttributeValue {
    Int(i64),
    Ints(Vec<i64>),
    Float(f32),
    Floats(Vec<f32>),
    Text(&'static str),
    Tensor(TensorProto),
}

impl AttributeValue {
    fn attribute(&self, name: &str) -> AttributeProto {
        let mut attribute =
            AttributeProto { name: Some(name.to_owned()), ..AttributeProto::default() };
        match self {
            Self::Int(value) => attribute.i = Some(*value),
            Self::Ints(values) => attribute.ints.clone_from(values),
            Self::Float(value) => attribute.f = Some(*value),
            Self::Floats(values) => attribute.floats.clone_from(values),
            Self::Tensor(tensor) => attribute.t = Some(tensor.clone()),
            Self::Text(text) => attribute.s = Some(text.as_bytes().to_vec()),
        }
        attribute
    }
}

fn value(name: &str, shape: &[i64]) -> ValueInfoProto {
    let dim = shape.iter().map(|&length| Dimension { dim_value: Some(length) }).collect();
    let tensor = TensorTypeProto {
        elem_type: Some(data_type::FLOAT),
        shape: Some(TensorShapeProto { dim }),
    };
    ValueInfoProto {
        name: Some(name.to_owned()),
        r#type: Some(TypeProto { tensor_type: Some(tensor) }),
    }
}

/// Returns pseudo-random values from -1 to 1 that are the same in every run.
pub(crate) fn noise(seed: u64, count: usize) -> Vec<f32> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        // The upper 16 bits become a value from -1 to below 1.
        (u16::try_from(state >> 48).unwrap() as f32) / 32768.0 - 1.0
    };
    (0..count).map(|_| next()).collect()
}
