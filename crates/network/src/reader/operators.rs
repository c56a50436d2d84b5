// SPDX-License-Identifier: MIT OR Apache-2.0
//! The supported ONNX operators, and the function that reads each ([`OPERATORS`]).

use super::node::{NodeOutput, NodeReader, output_of_tensors};
use super::transposed_conv::conv;
use super::{pointwise_operators, quantized_operators, reductions, reshaping};
use crate::activation::Activation;
use crate::operator::{ArithmeticKind, ComparisonKind, PoolKind, ReductionKind};

type OperatorReader = fn(&NodeReader<'_>) -> Result<Vec<NodeOutput>, String>;

/// All supported operators in alphabetical order.
const OPERATORS: &[(&str, OperatorReader)] = &[
    ("Abs", |node| pointwise_operators::activation(node, Activation::Abs)),
    ("Add", |node| pointwise_operators::binary(node, ArithmeticKind::Add)),
    ("ArgMax", |node| reductions::arg_max(node, false)),
    ("ArgMin", |node| reductions::arg_max(node, true)),
    ("AveragePool", |node| {
        let with_padding = node.int("count_include_pad", 0) != 0;
        output_of_tensors(
            reductions::pool(node, PoolKind::Average { with_padding })?,
            vec![node.tensor_input(0)?],
        )
    }),
    ("BatchNormalization", pointwise_operators::batch_normalization),
    ("Cast", pointwise_operators::cast),
    ("CastLike", pointwise_operators::cast_like),
    ("Ceil", |node| pointwise_operators::activation(node, Activation::Ceil)),
    ("Celu", |node| {
        pointwise_operators::activation(node, Activation::Celu { alpha: node.float("alpha", 1.0) })
    }),
    ("Clip", pointwise_operators::clip),
    ("Concat", reshaping::concat),
    ("Constant", |_| Err("it has no value".to_owned())),
    ("ConstantOfShape", |_| Err("it is supported only for constants".to_owned())),
    ("Conv", reductions::conv),
    ("ConvInteger", quantized_operators::conv_integer),
    ("ConvTranspose", conv),
    ("Cos", |node| pointwise_operators::activation(node, Activation::Cos)),
    ("DepthToSpace", reshaping::depth_to_space),
    ("DequantizeLinear", quantized_operators::dequantize),
    ("Div", |node| pointwise_operators::binary(node, ArithmeticKind::Div)),
    ("Dropout", pointwise_operators::dropout),
    ("Elu", |node| {
        pointwise_operators::activation(node, Activation::Elu { alpha: node.float("alpha", 1.0) })
    }),
    ("Equal", |node| pointwise_operators::compare(node, ComparisonKind::Equal)),
    ("Erf", |node| pointwise_operators::activation(node, Activation::Erf)),
    ("Exp", |node| pointwise_operators::activation(node, Activation::Exp)),
    ("Expand", reshaping::expand),
    ("Flatten", reshaping::flatten),
    ("Floor", |node| pointwise_operators::activation(node, Activation::Floor)),
    ("Gather", reshaping::gather),
    ("Gelu", pointwise_operators::gelu),
    ("Gemm", reductions::gemm),
    ("GlobalAveragePool", |node| reductions::global_pool(node, ReductionKind::Mean)),
    ("GlobalMaxPool", |node| reductions::global_pool(node, ReductionKind::Max)),
    ("Greater", |node| pointwise_operators::compare(node, ComparisonKind::Greater)),
    ("GreaterOrEqual", |node| pointwise_operators::compare(node, ComparisonKind::GreaterOrEqual)),
    ("GroupNormalization", reductions::group_normalization),
    ("HardSigmoid", |node| {
        pointwise_operators::activation(
            node,
            Activation::HardSigmoid {
                alpha: node.float("alpha", 0.2),
                beta: node.float("beta", 0.5),
            },
        )
    }),
    ("HardSwish", |node| pointwise_operators::activation(node, Activation::HardSwish)),
    ("Identity", pointwise_operators::identity),
    ("InstanceNormalization", reductions::instance_normalization),
    ("LRN", reductions::local_response_norm),
    ("LayerNormalization", reductions::layer_normalization),
    ("LeakyRelu", |node| {
        pointwise_operators::activation(
            node,
            Activation::LeakyRelu { alpha: node.float("alpha", 0.01) },
        )
    }),
    ("Less", |node| pointwise_operators::compare(node, ComparisonKind::Less)),
    ("LessOrEqual", |node| pointwise_operators::compare(node, ComparisonKind::LessOrEqual)),
    ("Log", |node| pointwise_operators::activation(node, Activation::Log)),
    ("LogSoftmax", |node| reductions::softmax(node, true)),
    ("MatMul", reductions::matmul),
    ("MatMulInteger", quantized_operators::matmul_integer),
    ("Max", |node| pointwise_operators::binary(node, ArithmeticKind::Max)),
    ("MaxPool", |node| {
        output_of_tensors(reductions::pool(node, PoolKind::Max)?, vec![node.tensor_input(0)?])
    }),
    ("Min", |node| pointwise_operators::binary(node, ArithmeticKind::Min)),
    ("Mish", |node| pointwise_operators::activation(node, Activation::Mish)),
    ("Mul", |node| pointwise_operators::binary(node, ArithmeticKind::Mul)),
    ("Neg", |node| pointwise_operators::activation(node, Activation::Neg)),
    ("PRelu", |node| pointwise_operators::binary(node, ArithmeticKind::PRelu)),
    ("Pad", reshaping::pad),
    ("Pow", pointwise_operators::power),
    ("QLinearConv", quantized_operators::conv),
    ("QLinearMatMul", quantized_operators::matmul),
    ("QuantizeLinear", quantized_operators::quantize),
    ("Range", |_| Err("it is supported only for constants".to_owned())),
    ("Reciprocal", |node| pointwise_operators::activation(node, Activation::Reciprocal)),
    ("ReduceL1", |node| reductions::reduce(node, ReductionKind::L1)),
    ("ReduceL2", |node| reductions::reduce(node, ReductionKind::L2)),
    ("ReduceMax", |node| reductions::reduce(node, ReductionKind::Max)),
    ("ReduceMean", |node| reductions::reduce(node, ReductionKind::Mean)),
    ("ReduceMin", |node| reductions::reduce(node, ReductionKind::Min)),
    ("ReduceProd", |node| reductions::reduce(node, ReductionKind::Prod)),
    ("ReduceSum", |node| reductions::reduce(node, ReductionKind::Sum)),
    ("ReduceSumSquare", |node| reductions::reduce(node, ReductionKind::SumSquare)),
    ("Relu", pointwise_operators::relu),
    ("Reshape", reshaping::reshape),
    ("Resize", reshaping::resize),
    ("Round", |node| pointwise_operators::activation(node, Activation::Round)),
    ("Selu", |node| {
        pointwise_operators::activation(
            node,
            Activation::Selu {
                alpha: node.float("alpha", 1.673_263_2),
                gamma: node.float("gamma", 1.050_701),
            },
        )
    }),
    ("Shape", |_| Err("it has no input".to_owned())),
    ("Sigmoid", |node| pointwise_operators::activation(node, Activation::Sigmoid)),
    ("Sign", |node| pointwise_operators::activation(node, Activation::Sign)),
    ("Sin", |node| pointwise_operators::activation(node, Activation::Sin)),
    ("Slice", reshaping::slice),
    ("Softmax", |node| reductions::softmax(node, false)),
    ("Softplus", |node| pointwise_operators::activation(node, Activation::Softplus)),
    ("Softsign", |node| pointwise_operators::activation(node, Activation::Softsign)),
    ("SpaceToDepth", reshaping::space_to_depth),
    ("Split", reshaping::split),
    ("Sqrt", |node| pointwise_operators::activation(node, Activation::Sqrt)),
    ("Squeeze", reshaping::squeeze),
    ("Sub", |node| pointwise_operators::binary(node, ArithmeticKind::Sub)),
    ("Sum", pointwise_operators::sum),
    ("Swish", |node| {
        pointwise_operators::activation(node, Activation::Swish { alpha: node.float("alpha", 1.0) })
    }),
    ("Tanh", |node| pointwise_operators::activation(node, Activation::Tanh)),
    ("ThresholdedRelu", |node| {
        pointwise_operators::activation(
            node,
            Activation::ThresholdedRelu { alpha: node.float("alpha", 1.0) },
        )
    }),
    ("Transpose", reshaping::transpose),
    ("Unsqueeze", reshaping::unsqueeze),
    ("Upsample", reshaping::resize),
    ("Where", pointwise_operators::select),
    ("com.microsoft.QGemm", quantized_operators::gemm),
    ("com.microsoft.QLinearAdd", |node| quantized_operators::binary(node, ArithmeticKind::Add)),
    ("com.microsoft.QLinearAveragePool", quantized_operators::average_pool),
    ("com.microsoft.QLinearConcat", quantized_operators::concat),
    ("com.microsoft.QLinearGlobalAveragePool", quantized_operators::global_average_pool),
    ("com.microsoft.QLinearLeakyRelu", |node| {
        quantized_operators::activation(
            node,
            Activation::LeakyRelu { alpha: node.float("alpha", 0.01) },
        )
    }),
    ("com.microsoft.QLinearMul", |node| quantized_operators::binary(node, ArithmeticKind::Mul)),
    ("com.microsoft.QLinearSigmoid", |node| {
        quantized_operators::activation(node, Activation::Sigmoid)
    }),
    ("com.microsoft.QLinearSoftmax", quantized_operators::softmax),
];

/// Returns the names of the supported operators in alphabetical order. An operator that is not of
/// the ONNX standard has its domain in front.
pub fn operators() -> impl Iterator<Item = &'static str> {
    OPERATORS.iter().map(|&(name, _)| name)
}

pub(super) fn is_supported(kind: &str) -> bool {
    operators().any(|name| name == kind)
}

pub(super) fn read_outputs(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let (_, maker) = OPERATORS
        .iter()
        .find(|&&(name, _)| name == node.full_operator_name())
        .expect("the operator is known");
    maker(node)
}
