// SPDX-License-Identifier: MIT OR Apache-2.0
//! In which order models take the axes of their input.

/// In which order a model takes the axes of its input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Channels, rows, columns.
    Nchw,
    /// Rows, columns, channels, as models from TensorFlow do, which put the channels first before anything else. A network is read from there on.
    Nhwc,
}

impl Layout {
    /// Its usual name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nchw => "nchw",
            Self::Nhwc => "nhwc",
        }
    }
}
