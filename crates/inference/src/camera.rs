// SPDX-License-Identifier: MIT OR Apache-2.0
//! The camera in front of the network: it renders the frames of a design and marks where each
//! differs from the one before.

use foveate_design::Design;
use foveate_engine::Engine;
use foveate_media::{PlaybackError, PlayedFrame, SourceKind};
use foveate_network::{
    Mask,
    vision::{FrameFormat, FrameInput, VisionNetwork},
};
use foveate_pixels::Rect;

/// A design's engine and the receiver's screen behind it.
pub(crate) struct ReceiverCamera {
    engine: Engine,
    picture: FrameInput,
    /// The black screen from which every frame of a data set starts; `None` for a clip.
    black_picture: Option<FrameInput>,
    /// True if the network also runs on the frames before the camera.
    with_originals: bool,
    /// The last frame before the camera, with its objects.
    original: Option<KeptOriginalFrame>,
    /// The number of frames so far.
    frames: u64,
    /// The outcome of the frames after the last one that the network saw, up to and including the
    /// next one that it sees.
    since_last_received: OutcomeTally,
}

/// A number of camera frames, and the number of values of P bits (pixels and means) that the camera
/// sent for them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SentCount {
    pub(crate) frames: u64,
    pub(crate) values: u64,
}

/// The outcome of some frames in the camera.
#[derive(Clone, Copy, Debug, Default)]
struct OutcomeTally {
    sent: SentCount,
    active_regions: u64,
}

/// The camera and the network of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CameraSetup<'a> {
    pub(crate) design: &'a Design,
    pub(crate) vision_network: &'a VisionNetwork,
    /// True if the network also runs on the frames before the camera.
    pub(crate) with_originals: bool,
}

/// A frame as the network sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReceivedFrame<'a> {
    /// The frame's number in its clip, from 0.
    pub(crate) number: u64,
    pub(crate) name: &'a str,
    pub(crate) time_us: u64,
    pub(crate) values: &'a [f32],
    pub(crate) changed: &'a Mask,
    /// The number of active regions, summed over all camera frames since the last frame that the
    /// network saw.
    pub(crate) active_regions: u64,
    /// The number of regions whose rendered pixels differ from those of the last frame that the
    /// network saw.
    pub(crate) changed_regions: u64,
    /// The frames and values that the camera sent since the last frame that the network saw.
    pub(crate) sent: SentCount,
    /// The receiver's screen, one word per pixel.
    pub(crate) screen: &'a [u16],
    pub(crate) original: Option<OriginalFrame<'a>>,
}

/// A frame before the camera, and its ground-truth objects if they are known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OriginalFrame<'a> {
    pub(crate) frame: &'a [u16],
    pub(crate) objects: Option<&'a [Rect]>,
}

impl ReceivedFrame<'_> {
    /// Returns the size of the frame's pixels and inputs in bytes.
    pub(crate) fn kept_bytes(&self) -> usize {
        let original = self.original.map_or(0, |original| size_of_val(original.frame));
        size_of_val(self.values) + size_of_val(self.screen) + original
    }
}

/// Returns the size, depth and regions of a camera's frames, as a network needs them.
#[must_use]
pub fn frame_format_of(camera: &foveate_camera::Camera) -> FrameFormat {
    FrameFormat {
        width: camera.width(),
        height: camera.height(),
        pixel_max: camera.pixel_max(),
        region_side: camera.region_size(),
    }
}

impl ReceiverCamera {
    pub(crate) fn new(shown: CameraSetup<'_>, kind: SourceKind) -> Self {
        let CameraSetup { design, vision_network, with_originals } = shown;
        let picture = vision_network.black_input(frame_format_of(design));
        let black = (kind == SourceKind::Set).then(|| picture.clone());
        let engine = Engine::new(design);
        Self {
            engine,
            picture,
            black_picture: black,
            with_originals,
            original: None,
            frames: 0,
            since_last_received: OutcomeTally::default(),
        }
    }

    /// Returns the network's input for a black screen, if the frames are those of a data set.
    pub(crate) fn black_input(&self) -> Option<&[f32]> {
        self.black_picture.as_ref().map(|picture| &picture.values[..])
    }

    /// Shows the design another frame, which the network does not see.
    pub(crate) fn skip_frame(&mut self, frame: &PlayedFrame) -> Result<(), PlaybackError> {
        let outcome = frame.show_to(&mut self.engine)?;
        let active = outcome.active.iter().filter(|&&active| active).count();
        let actions = &self.engine.outcome().actions;
        let values = self.engine.camera().values_sent_per_frame(actions);
        self.since_last_received.active_regions += active as u64;
        self.since_last_received.sent.frames += 1;
        self.since_last_received.sent.values += values;
        self.frames += 1;
        Ok(())
    }

    /// Shows the design another frame, and returns it as the network sees it, with its ground-truth
    /// objects if they are known.
    pub(crate) fn receive_frame<'a>(
        &'a mut self,
        frame: &'a PlayedFrame,
        objects: Option<Vec<Rect>>,
    ) -> Result<ReceivedFrame<'a>, PlaybackError> {
        if let Some(black) = &self.black_picture {
            self.picture.clone_from(black);
        }
        self.skip_frame(frame)?;
        let OutcomeTally { sent, active_regions } = std::mem::take(&mut self.since_last_received);
        self.picture.set_frame(self.engine.rendered());
        let words = || frame.frame.borrowed_pixels().to_words();
        self.original = self.with_originals.then(|| KeptOriginalFrame { frame: words(), objects });
        Ok(ReceivedFrame {
            number: self.frames - 1,
            name: &frame.name,
            time_us: frame.time_us,
            values: &self.picture.values,
            changed: &self.picture.changed,
            active_regions,
            changed_regions: self.picture.changed_regions as u64,
            sent,
            screen: self.picture.frame(),
            original: self.original.as_ref().map(KeptOriginalFrame::as_original),
        })
    }
}

/// A frame as the network saw it, kept in memory.
#[derive(Clone, Debug)]
pub(crate) struct KeptFrame {
    number: u64,
    name: String,
    time_us: u64,
    values: Vec<f32>,
    changed: Mask,
    active_regions: u64,
    changed_regions: u64,
    sent: SentCount,
    screen: Vec<u16>,
    original: Option<KeptOriginalFrame>,
}

/// A frame before the camera, kept in memory.
#[derive(Clone, Debug)]
struct KeptOriginalFrame {
    frame: Vec<u16>,
    objects: Option<Vec<Rect>>,
}

impl KeptOriginalFrame {
    fn as_original(&self) -> OriginalFrame<'_> {
        OriginalFrame { frame: &self.frame, objects: self.objects.as_deref() }
    }
}

impl KeptFrame {
    pub(crate) fn from_received(seen: ReceivedFrame<'_>) -> Self {
        Self {
            number: seen.number,
            name: seen.name.to_owned(),
            time_us: seen.time_us,
            values: seen.values.to_vec(),
            changed: seen.changed.clone(),
            active_regions: seen.active_regions,
            changed_regions: seen.changed_regions,
            sent: seen.sent,
            screen: seen.screen.to_vec(),
            original: seen.original.map(|original| KeptOriginalFrame {
                frame: original.frame.to_vec(),
                objects: original.objects.map(<[Rect]>::to_vec),
            }),
        }
    }

    pub(crate) fn as_received(&self) -> ReceivedFrame<'_> {
        ReceivedFrame {
            number: self.number,
            name: &self.name,
            time_us: self.time_us,
            values: &self.values,
            changed: &self.changed,
            active_regions: self.active_regions,
            changed_regions: self.changed_regions,
            sent: self.sent,
            screen: &self.screen,
            original: self.original.as_ref().map(KeptOriginalFrame::as_original),
        }
    }
}
