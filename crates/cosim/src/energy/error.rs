// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a measurement of energy.

use crate::CosimError;
use foveate_camera::ConfigError;
use foveate_estimate::SiliconError;
use foveate_media::PlaybackError;
use thiserror::Error;

/// An error of a measurement of energy.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum EnergyError {
    /// The design cannot be mapped, or the library lacks a table.
    #[error(transparent)]
    Silicon(#[from] SiliconError),
    /// The frames cannot be read.
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    /// The model of the unit cannot take the frames.
    #[error(transparent)]
    Cosim(#[from] CosimError),
    /// The input is a set of images and not a clip.
    #[error(
        "`{input}` is a set of images without order, which has no activity in time; give a video, a folder of \
         frames or `scene:street`"
    )]
    NoClip { input: String },
    /// The input has several clips.
    #[error("the energy is measured on one clip, and `{input}` are several; give one of them")]
    SeveralClips { input: String },
    /// The design cannot take frames of the clip's size.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The clip is too short.
    #[error("the clip `{clip}` has {found} frames, and an activity needs at least {needed}")]
    TooShort { clip: String, found: u64, needed: u64 },
    /// The clip ended early.
    #[error("the clip `{clip}` is not complete, so no energy is given: {problem}")]
    IncompleteClip { clip: String, problem: String },
    /// The organization cannot be measured.
    #[error(
        "the energy of organization `raster` is not measured, because its memories are macros, whose accesses are \
         not counted; choose `pipelined` or `serial`"
    )]
    Raster,
    /// The netlist differs from the model.
    #[error(
        "the netlist differs from the model in port `{port}`, from region {region} on, while frame {frame} of a \
         stretch is taken: it has {found}, and the model has {expected}. So no energy is given; `foveate cosim` with \
         the netlist of `foveate estimate --netlist` shows more"
    )]
    Mismatch { region: u32, frame: u64, port: String, expected: String, found: String },
    /// The netlist has a loop of gates, or lacks a pin.
    #[error("the netlist cannot be simulated: {reason}")]
    Netlist { reason: String },
}
