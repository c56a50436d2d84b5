// SPDX-License-Identifier: MIT OR Apache-2.0
//! The supported ONNX operators, and the function that reads each.

use super::made::{Made, one};
use super::node::NodeReader;
use super::{moves, normal, parts, pointwise, quantized, sizes, sums, transposed};
use crate::operator::{Activation, Arithmetic, Comparison, PoolKind, Reduction};

type Maker = fn(&NodeReader<'_>) -> Result<Vec<Made>, String>;

/// All supported operators in alphabetical order.
const OPERATORS: &[(&str, Maker)] = &[
    ("Abs", |node| pointwise::finish(node, Activation::Abs)),
    ("Add", |node| pointwise::binary(node, Arithmetic::Add)),
    ("ArgMax", |node| sums::arg_max(node, false)),
    ("ArgMin", |node| sums::arg_max(node, true)),
    ("AveragePool", |node| {
        let with_padding = node.int("count_include_pad", 0) != 0;
        one(sums::pool(node, PoolKind::Average { with_padding })?, vec![node.value(0)?])
    }),
    ("BatchNormalization", pointwise::normalization),
    ("Cast", pointwise::cast),
    ("CastLike", pointwise::cast_like),
    ("Ceil", |node| pointwise::finish(node, Activation::Ceil)),
    ("Celu", |node| pointwise::finish(node, Activation::Celu { alpha: node.float("alpha", 1.0) })),
    ("Clip", pointwise::clip),
    ("Concat", moves::concat),
    ("Constant", |_| Err("it has no value".to_owned())),
    ("ConstantOfShape", |_| Err("it is supported only for constants".to_owned())),
    ("Conv", sums::conv),
    ("ConvInteger", quantized::conv_integer),
    ("ConvTranspose", transposed::conv),
    ("Cos", |node| pointwise::finish(node, Activation::Cos)),
    ("DepthToSpace", sizes::depth_to_space),
    ("DequantizeLinear", quantized::dequantize),
    ("Div", |node| pointwise::binary(node, Arithmetic::Div)),
    ("Dropout", pointwise::dropout),
    ("Elu", |node| pointwise::finish(node, Activation::Elu { alpha: node.float("alpha", 1.0) })),
    ("Equal", |node| pointwise::compare(node, Comparison::Equal)),
    ("Erf", |node| pointwise::finish(node, Activation::Erf)),
    ("Exp", |node| pointwise::finish(node, Activation::Exp)),
    ("Expand", moves::expand),
    ("Flatten", moves::flatten),
    ("Floor", |node| pointwise::finish(node, Activation::Floor)),
    ("Gather", parts::gather),
    ("Gelu", pointwise::gelu),
    ("Gemm", sums::gemm),
    ("GlobalAveragePool", |node| sums::global(node, Reduction::Mean)),
    ("GlobalMaxPool", |node| sums::global(node, Reduction::Max)),
    ("Greater", |node| pointwise::compare(node, Comparison::Greater)),
    ("GreaterOrEqual", |node| pointwise::compare(node, Comparison::GreaterOrEqual)),
    ("GroupNormalization", normal::group),
    ("HardSigmoid", |node| {
        pointwise::finish(
            node,
            Activation::HardSigmoid {
                alpha: node.float("alpha", 0.2),
                beta: node.float("beta", 0.5),
            },
        )
    }),
    ("HardSwish", |node| pointwise::finish(node, Activation::HardSwish)),
    ("Identity", pointwise::same),
    ("InstanceNormalization", normal::instance),
    ("LRN", normal::local_response),
    ("LayerNormalization", normal::layer),
    ("LeakyRelu", |node| {
        pointwise::finish(node, Activation::LeakyRelu { alpha: node.float("alpha", 0.01) })
    }),
    ("Less", |node| pointwise::compare(node, Comparison::Less)),
    ("LessOrEqual", |node| pointwise::compare(node, Comparison::LessOrEqual)),
    ("Log", |node| pointwise::finish(node, Activation::Log)),
    ("LogSoftmax", |node| normal::softmax(node, true)),
    ("MatMul", sums::matmul),
    ("MatMulInteger", quantized::matmul_integer),
    ("Max", |node| pointwise::binary(node, Arithmetic::Max)),
    ("MaxPool", |node| one(sums::pool(node, PoolKind::Max)?, vec![node.value(0)?])),
    ("Min", |node| pointwise::binary(node, Arithmetic::Min)),
    ("Mish", |node| pointwise::finish(node, Activation::Mish)),
    ("Mul", |node| pointwise::binary(node, Arithmetic::Mul)),
    ("Neg", |node| pointwise::finish(node, Activation::Neg)),
    ("PRelu", |node| pointwise::binary(node, Arithmetic::Slope)),
    ("Pad", parts::pad),
    ("Pow", pointwise::power),
    ("QLinearConv", quantized::conv),
    ("QLinearMatMul", quantized::matmul),
    ("QuantizeLinear", quantized::quantize),
    ("Range", |_| Err("it is supported only for constants".to_owned())),
    ("Reciprocal", |node| pointwise::finish(node, Activation::Reciprocal)),
    ("ReduceL1", |node| sums::reduce(node, Reduction::L1)),
    ("ReduceL2", |node| sums::reduce(node, Reduction::L2)),
    ("ReduceMax", |node| sums::reduce(node, Reduction::Max)),
    ("ReduceMean", |node| sums::reduce(node, Reduction::Mean)),
    ("ReduceMin", |node| sums::reduce(node, Reduction::Min)),
    ("ReduceProd", |node| sums::reduce(node, Reduction::Prod)),
    ("ReduceSum", |node| sums::reduce(node, Reduction::Sum)),
    ("ReduceSumSquare", |node| sums::reduce(node, Reduction::SumSquare)),
    ("Relu", pointwise::relu),
    ("Reshape", moves::reshape),
    ("Resize", sizes::resize),
    ("Round", |node| pointwise::finish(node, Activation::Round)),
    ("Selu", |node| {
        pointwise::finish(
            node,
            Activation::Selu {
                alpha: node.float("alpha", 1.673_263_2),
                gamma: node.float("gamma", 1.050_701),
            },
        )
    }),
    ("Shape", |_| Err("it has no input".to_owned())),
    ("Sigmoid", |node| pointwise::finish(node, Activation::Sigmoid)),
    ("Sign", |node| pointwise::finish(node, Activation::Sign)),
    ("Sin", |node| pointwise::finish(node, Activation::Sin)),
    ("Slice", parts::slice),
    ("Softmax", |node| normal::softmax(node, false)),
    ("Softplus", |node| pointwise::finish(node, Activation::Softplus)),
    ("Softsign", |node| pointwise::finish(node, Activation::Softsign)),
    ("SpaceToDepth", sizes::space_to_depth),
    ("Split", parts::split),
    ("Sqrt", |node| pointwise::finish(node, Activation::Sqrt)),
    ("Squeeze", moves::squeeze),
    ("Sub", |node| pointwise::binary(node, Arithmetic::Sub)),
    ("Sum", pointwise::sum),
    ("Swish", |node| {
        pointwise::finish(node, Activation::Swish { alpha: node.float("alpha", 1.0) })
    }),
    ("Tanh", |node| pointwise::finish(node, Activation::Tanh)),
    ("ThresholdedRelu", |node| {
        pointwise::finish(node, Activation::ThresholdedRelu { alpha: node.float("alpha", 1.0) })
    }),
    ("Transpose", moves::transpose),
    ("Unsqueeze", moves::unsqueeze),
    ("Upsample", sizes::resize),
    ("Where", pointwise::select),
    ("com.microsoft.QGemm", quantized::gemm),
    ("com.microsoft.QLinearAdd", |node| quantized::binary(node, Arithmetic::Add)),
    ("com.microsoft.QLinearAveragePool", quantized::average_pool),
    ("com.microsoft.QLinearConcat", quantized::concat),
    ("com.microsoft.QLinearGlobalAveragePool", quantized::mean),
    ("com.microsoft.QLinearLeakyRelu", |node| {
        quantized::activation(node, Activation::LeakyRelu { alpha: node.float("alpha", 0.01) })
    }),
    ("com.microsoft.QLinearMul", |node| quantized::binary(node, Arithmetic::Mul)),
    ("com.microsoft.QLinearSigmoid", |node| quantized::activation(node, Activation::Sigmoid)),
    ("com.microsoft.QLinearSoftmax", quantized::softmax),
];

/// Returns the names of the supported operators in alphabetical order. An operator that is not of
/// the ONNX standard has its domain in front.
pub fn operators() -> impl Iterator<Item = &'static str> {
    OPERATORS.iter().map(|&(name, _)| name)
}

pub(super) fn is_known(kind: &str) -> bool {
    operators().any(|name| name == kind)
}

/// Returns the outputs of a node.
pub(super) fn make(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let (_, maker) = OPERATORS
        .iter()
        .find(|&&(name, _)| name == node.full_kind())
        .expect("the operator is known");
    maker(node)
}
