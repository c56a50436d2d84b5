// SPDX-License-Identifier: MIT OR Apache-2.0
//! The axis order of the input of a model.

/// The order in which a model takes the axes of its input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputLayout {
    /// Channels, rows, columns.
    Nchw,
    /// Rows, columns, channels, as in models from TensorFlow. Such a model first transposes its
    /// input to put the channels first. The network is read from behind that transposition.
    Nhwc,
}

impl InputLayout {
    /// The usual name of the layout.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nchw => "nchw",
            Self::Nhwc => "nhwc",
        }
    }
}
