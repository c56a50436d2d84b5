// SPDX-License-Identifier: MIT OR Apache-2.0
//! The windows and channels of a convolution, independent of the type of its values.

use super::{ProductKind, feature_size, only_input};
use crate::mask::AxisWindow;
use crate::tensor_form::TensorForm;

/// The windows, groups and channels of a convolution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ConvGeometry {
    pub(crate) rows: AxisWindow,
    pub(crate) columns: AxisWindow,
    pub(crate) groups: usize,
    /// The channels of the output.
    pub(crate) output_channels: usize,
    /// The channels of the input.
    pub(crate) input_channels: usize,
}

impl ConvGeometry {
    /// Returns the geometry of a convolution with weights of the shape
    /// `[channels, inputs per group, rows, columns]`.
    pub(crate) fn new(
        shape: &[usize],
        [rows, columns]: [AxisWindow; 2],
        groups: usize,
    ) -> Result<Self, String> {
        let &[channels, inputs, height, width] = shape else {
            return Err(format!(
                "its weights have {} axes; only two-dimensional convolution is supported",
                shape.len()
            ));
        };
        if shape.contains(&0) || groups == 0 || channels % groups != 0 {
            return Err(format!("its weights {shape:?} do not fit {groups} groups"));
        }
        if rows.kernel != height || columns.kernel != width {
            return Err(format!("its kernel_shape differs from its weights, {height}x{width}"));
        }
        Ok(Self {
            rows,
            columns,
            groups,
            output_channels: channels,
            input_channels: inputs * groups,
        })
    }

    /// Fails if a bias does not have one value per channel.
    pub(crate) fn check_bias<T>(&self, bias: Option<&[T]>) -> Result<(), String> {
        match bias {
            Some(bias) if bias.len() != self.output_channels => {
                Err(format!("its bias does not have {} channels", self.output_channels))
            }
            _ => Ok(()),
        }
    }

    /// The number of products of an output.
    pub(crate) fn depth(&self) -> usize {
        self.input_channels / self.groups * self.rows.kernel * self.columns.kernel
    }

    /// Returns true if every channel of the output depends on one channel of the input, its own.
    pub(crate) fn is_depthwise(&self) -> bool {
        self.input_channels == self.groups && self.output_channels == self.groups
    }

    /// Returns true if every output sees only the inputs of its own position.
    pub(crate) fn is_pointwise(&self) -> bool {
        [self.rows, self.columns] == [AxisWindow::SAME; 2]
    }

    /// Returns the rows and columns of an input or output for the computation. A pointwise
    /// convolution is computed as one row, because it does not matter where a row ends.
    pub(crate) fn computed_size(&self, form: &TensorForm) -> [usize; 2] {
        if self.is_pointwise() { [1, form.position_count()] } else { [form.height(), form.width()] }
    }

    /// Returns the form of the output.
    pub(crate) fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let [channels, height, width] = feature_size(only_input(inputs)?)?;
        if channels != self.input_channels {
            return Err(format!(
                "it takes {} channels, but its input has {channels}",
                self.input_channels
            ));
        }
        let (height, width) =
            (output_length(self.rows, height)?, output_length(self.columns, width)?);
        Ok(TensorForm::features(vec![1, self.output_channels, height, width]))
    }

    pub(crate) fn products(&self) -> ProductKind {
        ProductKind::Convolution { rows: self.rows, columns: self.columns, groups: self.groups }
    }
}

/// Returns the number of outputs along an axis of `inputs` inputs.
pub(super) fn output_length(window: AxisWindow, inputs: usize) -> Result<usize, String> {
    let padded = inputs + window.padding_before + window.padding_after;
    let room = padded.checked_sub(window.span());
    let room = room.ok_or_else(|| {
        format!("its window of {} is larger than its input, {padded} with padding", window.span())
    })?;
    Ok(room / window.stride + 1)
}
