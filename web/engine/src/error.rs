// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of requests of a page.

use foveate_camera::ConfigError;
use foveate_engine::EngineError;
use foveate_model::ModelError;
use foveate_network::vision::VisionError;
use foveate_pixels::SceneError;
use thiserror::Error;

/// A request of the page that is refused.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
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
    /// The network cannot be read, cannot take the frames, or has outputs that cannot be read.
    #[error(transparent)]
    Sight(#[from] VisionError),
    /// The file of a network is too large.
    #[error("the file has {given} bytes; a page takes networks of at most {most}")]
    NetworkFile { given: usize, most: usize },
    /// The tensors of a network take too much memory.
    #[error(
        "the network keeps {} MB of tensors for a frame; a page has {} MB for them: take a smaller network, or a smaller input as in letterbox=320x320",
        needed / 1_000_000,
        most / 1_000_000
    )]
    NetworkMemory { needed: u64, most: u64 },
    /// No camera has pixels of this depth.
    #[error("pixels of {bits} bits are refused; a camera has 1 to 16")]
    PixelDepth { bits: u32 },
    /// A setting of a network cannot be read.
    #[error("{what}: {problem}")]
    Setting { what: &'static str, problem: String },
    /// A pixel is larger than its bits allow.
    #[error("a pixel is larger than {bits} bits hold; give pixels as the camera has them")]
    PixelTooLarge { bits: u32 },
    /// There is no network yet.
    #[error("there is no network; give the file of one first")]
    NoNetwork,
    /// The bytes are not text.
    #[error("the {what} is not UTF-8 text, from byte {at} on; give it as UTF-8")]
    NotUtf8 { what: &'static str, at: usize },
    /// The frame has no pixels, or more than a page can hold.
    #[error(
        "a frame of {width}x{height} pixels is refused; a page takes frames of 1 to {most} pixels"
    )]
    FrameSize { width: u32, height: u32, most: u32 },
    /// The bytes are no frame of the camera.
    #[error(
        "{given} bytes are not a frame; one of {width}x{height} pixels has {needed}, {each} per pixel"
    )]
    FrameLength { given: usize, needed: usize, each: usize, width: u32, height: u32 },
    /// The page has the largest number of cameras already.
    #[error("there are {most} cameras already, the most that a page can have; free one first")]
    TooManyCameras { most: usize },
    /// The camera was freed, or never existed.
    #[error("there is no camera number {handle}; it was freed, or never configured")]
    NoSuchCamera { handle: u32 },
    /// The camera does not have the feature.
    #[error("there is no feature number {index}; the camera has {count}, counted from 0")]
    NoSuchFeature { index: u32, count: usize },
    /// The region is outside of the grid.
    #[error(
        "there is no region {x},{y}; the frame has {columns} x {rows} regions, counted from 0,0"
    )]
    NoSuchRegion { x: u32, y: u32, columns: u32, rows: u32 },
    /// A number is not that of a class of regions.
    #[error(
        "region {region} has the class {code}; classes are 0 (normal), 1 (off), 2 (keen) and 3 (always)"
    )]
    NoSuchClass { region: usize, code: u8 },
    /// The camera has seen no frame yet.
    #[error("the camera has seen no frame yet; show it one first")]
    NoFrameYet,
    /// There is no recording.
    #[error("nothing is recorded; begin a recording first")]
    NotRecording,
}
