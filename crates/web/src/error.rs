// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a page may ask that cannot be.

use foveate_camera::ConfigError;
use foveate_engine::EngineError;
use foveate_model::ModelError;
use foveate_network::sight::SightError;
use foveate_scenes::SceneError;
use thiserror::Error;

/// A wish of the page that is refused.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WebError {
    /// The configuration is refused.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The frame is refused.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The frame is refused by the model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// There is no such scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The network cannot be read, shown frames, or understood.
    #[error(transparent)]
    Sight(#[from] SightError),
    /// A file of a network that is too large.
    #[error("the file has {given} bytes; a page takes networks of at most {most}")]
    NetworkFile {
        /// Its bytes.
        given: usize,
        /// The most.
        most: usize,
    },
    /// A network whose tensors take too much memory.
    #[error(
        "the network keeps {} MB of tensors for a frame; a page has {} MB for them: take a smaller network, or a smaller input as in letterbox=320x320",
        needed / 1_000_000,
        most / 1_000_000
    )]
    NetworkMemory {
        /// Bytes that it needs.
        needed: u64,
        /// The most.
        most: u64,
    },
    /// Pixels that no camera has.
    #[error("pixels of {bits} bits are refused; a camera has 1 to 16")]
    Bits {
        /// Bits that were asked for.
        bits: u32,
    },
    /// A setting of a network that cannot be read.
    #[error("{what}: {problem}")]
    Wish {
        /// The setting.
        what: &'static str,
        /// What would be right.
        problem: String,
    },
    /// A pixel that is larger than the bits of the frames hold.
    #[error("a pixel is larger than {bits} bits hold; give pixels as the camera has them")]
    PixelBits {
        /// Bits of a pixel.
        bits: u32,
    },
    /// There is no network yet.
    #[error("there is no network; give the file of one first")]
    NoNetwork,
    /// Bytes that are no text.
    #[error("the {what} is not UTF-8 text, from byte {at} on; give it as UTF-8")]
    Text {
        /// What should have been text.
        what: &'static str,
        /// The first byte that is none.
        at: usize,
    },
    /// A frame without pixels, or with more than a page can hold.
    #[error(
        "a frame of {width}x{height} pixels is refused; a page takes frames of 1 to {most} pixels"
    )]
    Size {
        /// Width that was asked for.
        width: u32,
        /// Height that was asked for.
        height: u32,
        /// The most pixels.
        most: u32,
    },
    /// Bytes that are no frame of the camera.
    #[error(
        "{given} bytes are no frame; one of {width}x{height} pixels has {needed}, {each} per pixel"
    )]
    FrameLength {
        /// Bytes that came.
        given: usize,
        /// Bytes of a frame.
        needed: usize,
        /// Bytes of a pixel.
        each: usize,
        /// Width of the camera.
        width: u32,
        /// Height of the camera.
        height: u32,
    },
    /// One more camera than a page may have.
    #[error("there are {most} cameras already, the most of a page; free one first")]
    TooManyCameras {
        /// The most.
        most: usize,
    },
    /// A camera that was freed, or never was.
    #[error("there is no camera number {handle}; it was freed, or never configured")]
    NoSuchCamera {
        /// The number.
        handle: u32,
    },
    /// A feature that the camera does not have.
    #[error("there is no feature number {index}; the camera has {count}, counted from 0")]
    NoSuchFeature {
        /// The number.
        index: u32,
        /// How many there are.
        count: usize,
    },
    /// A region outside of the grid.
    #[error(
        "there is no region {x},{y}; the frame has {columns} x {rows} regions, counted from 0,0"
    )]
    NoSuchRegion {
        /// Column that was asked for.
        x: u32,
        /// Row that was asked for.
        y: u32,
        /// Columns of regions.
        columns: u32,
        /// Rows of regions.
        rows: u32,
    },
    /// Nothing can be said of no frame.
    #[error("the camera has seen no frame yet; show it one first")]
    NothingYet,
    /// There are no events to take.
    #[error("nothing is recorded; begin a recording first")]
    NotRecording,
}
