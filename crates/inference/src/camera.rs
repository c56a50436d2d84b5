// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the network sees: the rendered frames of a design, and where each differs from the one before.

use crate::InferenceError;
use foveate_design::Design;
use foveate_engine::Engine;
use foveate_footage::{Kind, SourceFrame};
use foveate_frame::Rect;
use foveate_network::Mask;
use foveate_network::sight::{Frames, Picture, Witness};

/// A design with a receiver behind it.
pub(crate) struct Camera {
    engine: Engine,
    picture: Picture,
    /// From which every image of a set begins.
    black: Option<Picture>,
    /// Whether the network is to see the frames as they were before the camera, too.
    with_originals: bool,
    /// The last of these.
    original: Option<KeptOriginal>,
    /// Frames so far.
    frames: u64,
    /// The outcome of the frames that the network has not seen, up to the next one that it sees.
    passed: CameraTally,
}

/// Frames of a camera, and the values of P bits that it sends for them: pixels and means.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SentCount {
    pub(crate) frames: u64,
    pub(crate) values: u64,
}

/// The outcome of a frame in the camera.
#[derive(Clone, Copy, Debug, Default)]
struct CameraTally {
    sent: SentCount,
    active_regions: u64,
}

/// What a network is shown.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown<'a> {
    pub(crate) design: &'a Design,
    pub(crate) witness: &'a Witness,
    /// Whether it is to see the frames as they were before the camera, too.
    pub(crate) with_originals: bool,
}

/// A frame as the network sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen<'a> {
    /// From 0.
    pub(crate) number: u64,
    pub(crate) name: &'a str,
    pub(crate) time_us: u64,
    pub(crate) values: &'a [f32],
    pub(crate) changed: &'a Mask,
    /// Since the frame before that the network saw, over all frames of the camera.
    pub(crate) active_regions: u64,
    /// Beside that frame.
    pub(crate) changed_regions: u64,
    /// Since that frame.
    pub(crate) sent: SentCount,
    /// What is on the receiver's screen.
    pub(crate) screen: &'a [u16],
    pub(crate) original: Option<Original<'a>>,
}

/// A frame as it was before the camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Original<'a> {
    pub(crate) frame: &'a [u16],
    pub(crate) objects: Option<&'a [Rect]>,
}

impl Seen<'_> {
    /// Bytes of its pictures.
    pub(crate) fn bytes(&self) -> usize {
        let original = self.original.map_or(0, |original| size_of_val(original.frame));
        size_of_val(self.values) + size_of_val(self.screen) + original
    }
}

/// The frames of a camera, as a network is shown them.
#[must_use]
pub fn frames_of(camera: &foveate_design::Camera) -> Frames {
    Frames {
        width: camera.width(),
        height: camera.height(),
        pixel_max: camera.pixel_max(),
        region: camera.region_size(),
    }
}

impl Camera {
    pub(crate) fn new(shown: Shown<'_>, kind: Kind) -> Self {
        let Shown { design, witness, with_originals } = shown;
        let picture = witness.picture(frames_of(design));
        let black = (kind == Kind::Set).then(|| picture.clone());
        let engine = Engine::new(design);
        Self {
            engine,
            picture,
            black,
            with_originals,
            original: None,
            frames: 0,
            passed: CameraTally::default(),
        }
    }

    /// The picture before the first frame.
    pub(crate) fn black(&self) -> Option<&[f32]> {
        self.black.as_ref().map(|picture| &picture.values[..])
    }

    /// Shows the design another frame, which the network does not see.
    pub(crate) fn pass(&mut self, frame: &SourceFrame) -> Result<(), InferenceError> {
        if self.black.is_some() {
            self.engine.reset();
        }
        self.engine.step_raster(&frame.frame)?;
        let outcome = self.engine.outcome();
        let active = outcome.active.iter().filter(|&&active| active).count();
        self.passed.active_regions += active as u64;
        self.passed.sent.frames += 1;
        self.passed.sent.values += self.engine.camera().values_of(&outcome.actions);
        self.frames += 1;
        Ok(())
    }

    /// Shows the design another frame, in which there may be known objects.
    pub(crate) fn see<'a>(
        &'a mut self,
        frame: &'a SourceFrame,
        objects: Option<Vec<Rect>>,
    ) -> Result<Seen<'a>, InferenceError> {
        if let Some(black) = &self.black {
            self.picture.clone_from(black);
        }
        self.pass(frame)?;
        let CameraTally { sent, active_regions } = std::mem::take(&mut self.passed);
        self.picture.show(self.engine.rendered());
        let words = || frame.frame.plane().to_words();
        self.original = self.with_originals.then(|| KeptOriginal { frame: words(), objects });
        Ok(Seen {
            number: self.frames - 1,
            name: &frame.name,
            time_us: frame.time_us,
            values: &self.picture.values,
            changed: &self.picture.changed,
            active_regions,
            changed_regions: self.picture.changed_regions as u64,
            sent,
            screen: self.picture.frame(),
            original: self.original.as_ref().map(KeptOriginal::shown),
        })
    }
}

/// A frame that is kept.
#[derive(Clone, Debug)]
pub(crate) struct Kept {
    number: u64,
    name: String,
    time_us: u64,
    values: Vec<f32>,
    changed: Mask,
    active_regions: u64,
    changed_regions: u64,
    sent: SentCount,
    screen: Vec<u16>,
    original: Option<KeptOriginal>,
}

/// A frame that is kept as it was before the camera.
#[derive(Clone, Debug)]
struct KeptOriginal {
    frame: Vec<u16>,
    objects: Option<Vec<Rect>>,
}

impl KeptOriginal {
    fn shown(&self) -> Original<'_> {
        Original { frame: &self.frame, objects: self.objects.as_deref() }
    }
}

impl Kept {
    pub(crate) fn of(seen: Seen<'_>) -> Self {
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
            original: seen.original.map(|original| KeptOriginal {
                frame: original.frame.to_vec(),
                objects: original.objects.map(<[Rect]>::to_vec),
            }),
        }
    }

    pub(crate) fn seen(&self) -> Seen<'_> {
        Seen {
            number: self.number,
            name: &self.name,
            time_us: self.time_us,
            values: &self.values,
            changed: &self.changed,
            active_regions: self.active_regions,
            changed_regions: self.changed_regions,
            sent: self.sent,
            screen: &self.screen,
            original: self.original.as_ref().map(KeptOriginal::shown),
        }
    }
}
