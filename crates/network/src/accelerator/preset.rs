// SPDX-License-Identifier: MIT OR Apache-2.0
//! Named accelerators, whose files state the source of every figure.

use crate::accelerator::AcceleratorError;

/// A named accelerator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AcceleratorPreset {
    /// The name on the command line.
    pub name: &'static str,
    /// A description in one line.
    pub summary: &'static str,
    /// The text of its file, which a user can start from.
    pub toml: &'static str,
}

/// All presets.
pub const PRESETS: &[AcceleratorPreset] = &[
    AcceleratorPreset {
        name: "systolic-ws",
        summary: "16 x 16 weight-stationary systolic array, 8 bits",
        toml: include_str!("../../presets/systolic-ws.toml"),
    },
    AcceleratorPreset {
        name: "systolic-os",
        summary: "16 x 16 output-stationary systolic array, 8 bits",
        toml: include_str!("../../presets/systolic-os.toml"),
    },
    AcceleratorPreset {
        name: "eyeriss",
        summary: "12 x 14 row-stationary array like Eyeriss, 16 bits",
        toml: include_str!("../../presets/eyeriss.toml"),
    },
];

impl AcceleratorPreset {
    /// Returns the preset of that name.
    ///
    /// # Errors
    /// Fails if there is no such preset; the message lists the existing ones.
    pub fn find(name: &str) -> Result<&'static Self, AcceleratorError> {
        PRESETS.iter().find(|preset| preset.name == name).ok_or_else(|| {
            AcceleratorError::UnknownPreset {
                name: name.to_owned(),
                known: PRESETS.iter().map(|preset| preset.name).collect::<Vec<_>>().join(", "),
            }
        })
    }
}
