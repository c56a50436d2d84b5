// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shapes of a layer, as far as its cost depends on them.

use crate::accelerator::AcceleratorError;
use std::ops::RangeInclusive;

/// The largest number of multiplications of a layer. With this limit no count can overflow.
const MAX_MACS: u128 = 1_000_000_000_000_000;
/// The largest number of values along an axis.
const MAX_AXIS_LENGTH: u64 = 1 << 20;
/// The largest number of images that run together.
const MAX_IMAGES: u64 = 1024;
/// The largest number of positions of a tensor, because a mask of them is kept in memory.
const MAX_POSITIONS: u64 = 1 << 28;

/// The channels, rows and columns of a tensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TensorShape {
    /// The number of values of a position.
    pub channels: u64,
    /// The number of rows.
    pub height: u64,
    /// The number of columns.
    pub width: u64,
}

impl TensorShape {
    /// Returns the number of positions: rows times columns.
    #[must_use]
    pub fn positions(&self) -> u64 {
        self.height * self.width
    }

    /// Returns the number of values.
    #[must_use]
    pub fn values(&self) -> u64 {
        self.channels * self.positions()
    }
}

/// The inputs that an output depends on along one axis: output `o` depends on the inputs
/// `o * stride - padding_before + k * dilation`, for `k` below `kernel`, as far as they exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KernelWindow {
    /// The number of inputs of an output.
    pub kernel: u64,
    /// The distance between the inputs of consecutive outputs.
    pub stride: u64,
    /// The distance between consecutive taps, in inputs.
    pub dilation: u64,
    /// The padding before the first input.
    pub padding_before: u64,
}

impl KernelWindow {
    /// The window of one tap, in which an output depends only on the input of its own position.
    pub const SAME: Self = Self { kernel: 1, stride: 1, dilation: 1, padding_before: 0 };

    /// Makes a window of adjacent inputs.
    #[must_use]
    pub const fn of(kernel: u64, stride: u64, before: u64) -> Self {
        Self { kernel, stride, dilation: 1, padding_before: before }
    }

    pub(crate) fn taps(self, output: u64, inputs: u64) -> impl Iterator<Item = u64> {
        let first = output * self.stride;
        (0..self.kernel)
            .filter_map(move |tap| (first + tap * self.dilation).checked_sub(self.padding_before))
            .filter(move |&input| input < inputs)
    }
}

/// The shapes of a layer of a network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layer {
    pub(crate) inputs: TensorShape,
    pub(crate) outputs: TensorShape,
    /// The windows along the rows axis and along the columns axis.
    pub(crate) windows: [KernelWindow; 2],
    pub(crate) products: Option<ChannelGroups>,
    pub(crate) images: u64,
}

/// The groups of channels of a layer whose outputs are sums of products.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ChannelGroups {
    /// The number of groups of channels, which are independent of each other.
    pub(crate) groups: u64,
    pub(crate) inputs: u64,
    pub(crate) outputs: u64,
}

impl Layer {
    /// Makes a convolution. A depthwise one has as many groups as input channels.
    ///
    /// # Errors
    /// Fails if a number is 0 or exceeds its limit, or if the number of channels is not a multiple
    /// of the number of groups.
    pub fn convolution(
        inputs: TensorShape,
        outputs: TensorShape,
        windows: [KernelWindow; 2],
        groups: u64,
    ) -> Result<Self, AcceleratorError> {
        check_shapes(inputs, outputs, windows)?;
        check("number of groups", groups, 1..=MAX_AXIS_LENGTH)?;
        for (what, channels) in [
            ("number of input channels", inputs.channels),
            ("number of output channels", outputs.channels),
        ] {
            if channels % groups != 0 {
                let valid = format!("a multiple of {groups}, the number of groups");
                return Err(AcceleratorError::InvalidLayer { what, value: channels.into(), valid });
            }
        }
        let products = ChannelGroups {
            groups,
            inputs: inputs.channels / groups,
            outputs: outputs.channels / groups,
        };
        Self { inputs, outputs, windows, products: Some(products), images: 1 }.within_limits()
    }

    /// Makes the product of `rows` vectors of `inner` values with a matrix of `inner` x `columns`
    /// weights. A fully connected layer has one row.
    ///
    /// # Errors
    /// Fails if a number is 0 or exceeds its limit.
    pub fn product(rows: u64, inner: u64, columns: u64) -> Result<Self, AcceleratorError> {
        let inputs = TensorShape { channels: inner, height: rows, width: 1 };
        let outputs = TensorShape { channels: columns, height: rows, width: 1 };
        Self::convolution(inputs, outputs, [KernelWindow::SAME; 2], 1)
    }

    /// Makes a layer without sums of products, such as pooling, activation or addition. The
    /// channels of several inputs are counted together.
    ///
    /// # Errors
    /// Fails if a number is 0 or exceeds its limit.
    pub fn transfer(
        inputs: TensorShape,
        outputs: TensorShape,
        windows: [KernelWindow; 2],
    ) -> Result<Self, AcceleratorError> {
        check_shapes(inputs, outputs, windows)?;
        Self { inputs, outputs, windows, products: None, images: 1 }.within_limits()
    }

    /// Returns the same layer for several images, which share fetched weights where the array
    /// allows it. Its cost is that of all images.
    ///
    /// # Errors
    /// Fails if the number of images is 0 or exceeds its limit.
    pub fn with_images(mut self, images: u64) -> Result<Self, AcceleratorError> {
        check("number of images", images, 1..=MAX_IMAGES)?;
        self.images = images;
        self.within_limits()
    }

    /// Returns the shape of the output of one image.
    #[must_use]
    pub fn outputs(&self) -> TensorShape {
        self.outputs
    }

    /// Returns the number of multiplications of all images.
    #[must_use]
    pub fn macs(&self) -> u64 {
        self.images * self.outputs.positions() * self.macs_per_position()
    }

    /// Returns the number of weights, without biases.
    #[must_use]
    pub fn weights(&self) -> u64 {
        self.macs_per_position()
    }

    /// Returns the number of multiplications of a position, in which each weight is used once.
    pub(crate) fn macs_per_position(&self) -> u64 {
        self.products.map_or(0, |products| {
            products.groups * products.outputs * self.inputs_per_sum(&products)
        })
    }

    pub(crate) fn inputs_per_sum(&self, products: &ChannelGroups) -> u64 {
        products.inputs * self.windows[0].kernel * self.windows[1].kernel
    }

    fn within_limits(self) -> Result<Self, AcceleratorError> {
        let per_position = u128::from(self.outputs.channels)
            * u128::from(self.inputs.channels)
            * u128::from(self.windows[0].kernel * self.windows[1].kernel);
        let positions = u128::from(self.outputs.positions().max(self.inputs.positions()));
        let macs = per_position.saturating_mul(positions).saturating_mul(self.images.into());
        if macs <= MAX_MACS {
            return Ok(self);
        }
        Err(AcceleratorError::InvalidLayer {
            what: "number of multiplications",
            value: macs,
            valid: format!("at most {MAX_MACS}, counted as if the layer were dense"),
        })
    }
}

fn check_shapes(
    inputs: TensorShape,
    outputs: TensorShape,
    windows: [KernelWindow; 2],
) -> Result<(), AcceleratorError> {
    check("number of input channels", inputs.channels, 1..=MAX_AXIS_LENGTH)?;
    check("input height", inputs.height, 1..=MAX_AXIS_LENGTH)?;
    check("input width", inputs.width, 1..=MAX_AXIS_LENGTH)?;
    check("number of output channels", outputs.channels, 1..=MAX_AXIS_LENGTH)?;
    check("output height", outputs.height, 1..=MAX_AXIS_LENGTH)?;
    check("output width", outputs.width, 1..=MAX_AXIS_LENGTH)?;
    check("number of input positions", inputs.positions(), 1..=MAX_POSITIONS)?;
    check("number of output positions", outputs.positions(), 1..=MAX_POSITIONS)?;
    for window in windows {
        check("kernel", window.kernel, 1..=MAX_AXIS_LENGTH)?;
        check("stride", window.stride, 1..=MAX_AXIS_LENGTH)?;
        check("dilation", window.dilation, 1..=MAX_AXIS_LENGTH)?;
        check("padding", window.padding_before, 0..=MAX_AXIS_LENGTH)?;
    }
    Ok(())
}

fn check(
    what: &'static str,
    value: u64,
    range: RangeInclusive<u64>,
) -> Result<(), AcceleratorError> {
    if range.contains(&value) {
        return Ok(());
    }
    let valid = format!("{} to {}", range.start(), range.end());
    Err(AcceleratorError::InvalidLayer { what, value: value.into(), valid })
}
