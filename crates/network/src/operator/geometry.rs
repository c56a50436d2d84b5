// SPDX-License-Identifier: MIT OR Apache-2.0
//! The windows and channels of a convolution, independent of the type of its values.

use super::{Products, features, only};
use crate::form::Form;
use crate::mask::Window;

/// The windows, groups and channels of a convolution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Geometry {
    pub(crate) rows: Window,
    pub(crate) columns: Window,
    pub(crate) groups: usize,
    /// The channels of the output.
    pub(crate) channels: usize,
    /// The channels of the input.
    pub(crate) inputs: usize,
}

impl Geometry {
    /// Returns the geometry of a convolution with weights of the shape
    /// `[channels, inputs per group, rows, columns]`.
    pub(crate) fn new(
        shape: &[usize],
        [rows, columns]: [Window; 2],
        groups: usize,
    ) -> Result<Self, String> {
        let &[channels, inputs, height, width] = shape else {
            return Err(format!(
                "its weights have {} axes; only two-dimensional convolution is known",
                shape.len()
            ));
        };
        if shape.contains(&0) || groups == 0 || channels % groups != 0 {
            return Err(format!("its weights {shape:?} do not fit {groups} groups"));
        }
        if rows.kernel != height || columns.kernel != width {
            return Err(format!("its kernel_shape differs from its weights, {height}x{width}"));
        }
        Ok(Self { rows, columns, groups, channels, inputs: inputs * groups })
    }

    /// Fails if a bias does not have one value per channel.
    pub(crate) fn check_bias<T>(&self, bias: Option<&[T]>) -> Result<(), String> {
        match bias {
            Some(bias) if bias.len() != self.channels => {
                Err(format!("its bias is not of {} channels", self.channels))
            }
            _ => Ok(()),
        }
    }

    /// The number of products of an output.
    pub(crate) fn depth(&self) -> usize {
        self.inputs / self.groups * self.rows.kernel * self.columns.kernel
    }

    /// Returns true if every channel of the output depends on one channel of the input, its own.
    pub(crate) fn is_depthwise(&self) -> bool {
        self.inputs == self.groups && self.channels == self.groups
    }

    /// Returns true if every output sees only the inputs of its own position.
    pub(crate) fn is_pointwise(&self) -> bool {
        [self.rows, self.columns] == [Window::SAME; 2]
    }

    /// Returns the rows and columns of an input or output for the computation. A pointwise
    /// convolution is computed as one row, because it does not matter where a row ends.
    pub(crate) fn size(&self, form: &Form) -> [usize; 2] {
        if self.is_pointwise() { [1, form.places()] } else { [form.height(), form.width()] }
    }

    /// Returns the form of the output.
    pub(crate) fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let [channels, height, width] = features(only(inputs)?)?;
        if channels != self.inputs {
            return Err(format!("it takes {} channels, but its input has {channels}", self.inputs));
        }
        let (height, width) = (outputs(self.rows, height)?, outputs(self.columns, width)?);
        Ok(Form::features(vec![1, self.channels, height, width]))
    }

    pub(crate) fn products(&self) -> Products {
        Products::Convolution { rows: self.rows, columns: self.columns, groups: self.groups }
    }
}

/// Returns the number of outputs along an axis of `inputs` inputs.
pub(super) fn outputs(window: Window, inputs: usize) -> Result<usize, String> {
    let padded = inputs + window.before + window.after;
    let room = padded.checked_sub(window.span());
    let room = room.ok_or_else(|| {
        format!("its window of {} is larger than its input, {padded} with padding", window.span())
    })?;
    Ok(room / window.stride + 1)
}
