// SPDX-License-Identifier: MIT OR Apache-2.0
//! The list of scenes and the iterator over the frames of one.

use std::fmt;

use foveate_frame::Frame;

use crate::patterns;
use crate::street::{Mood, Street};
use crate::{SceneError, canvas::Canvas, noise};

/// Names, summaries and default lengths, in the order of the documentation.
macro_rules! scenes {
    ($($variant:ident $name:literal $frames:literal $summary:literal;)+) => {
        /// A scene.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Scene { $(#[doc = $summary] $variant),+ }

        impl Scene {
            /// Every scene; the first is the one to look at.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Its name on the command line, after `scene:`.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }

            /// What it shows, in one line.
            #[must_use]
            pub fn summary(self) -> &'static str {
                match self { $(Self::$variant => $summary),+ }
            }

            /// How many frames show it well.
            #[must_use]
            pub fn default_frames(self) -> u32 {
                match self { $(Self::$variant => $frames),+ }
            }
        }
    };
}

scenes! {
    Street "street" 90 "cars, a pedestrian and mild sensor noise in front of houses";
    Zero "zero" 4 "every pixel zero";
    Max "max" 4 "every pixel at its maximum";
    Checkerboard "checkerboard" 8 "one-pixel checkerboard at full swing, inverted every second frame";
    HotPixels "hot-pixels" 16 "one hot or dead pixel per region, at each of its four corners in turn";
    Ramps "ramps" 16 "ramps and steps whose slope grows by one level from region to region and frame to frame";
    HalfMeans "half-means" 12 "region means that end in exactly one half, one pixel less and one more";
    Flicker "flicker" 16 "every pixel alternates between two neighboring levels";
    Fade "fade" 96 "every pixel changes by exactly one level per frame, up and down again";
    LightStep "light-step" 32 "the light is switched on and off every eight frames";
    Shake "shake" 32 "the street without traffic, seen by a camera that shakes";
    NightRain "night-rain" 60 "the street at night, with rain and strong sensor noise";
    OnePixel "one-pixel" 64 "an object of one pixel moves over a plain background";
    LateChange "late-change" 64 "nothing changes until the last frame";
    Random "random" 16 "independent random pixels";
}

/// How large, how deep and how many frames to make. Values outside their ranges are brought in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneSize {
    /// Width in pixels, 1..=16384.
    pub width: u32,
    /// Height in pixels, 1..=16384.
    pub height: u32,
    /// Bits per pixel P, 1..=16.
    pub bits: u32,
    /// Side of a region N, 2..=64; some scenes put something into every region.
    pub region_size: u32,
    /// Number of frames.
    pub frames: u32,
}

impl SceneSize {
    /// Largest pixel, 2^P - 1.
    pub(crate) fn max(&self) -> u32 {
        (1 << self.bits) - 1
    }

    fn in_range(self) -> Self {
        Self {
            width: self.width.clamp(1, 16_384),
            height: self.height.clamp(1, 16_384),
            bits: self.bits.clamp(1, 16),
            region_size: self.region_size.clamp(2, 64),
            frames: self.frames,
        }
    }
}

impl Scene {
    /// The scene of that name.
    ///
    /// # Errors
    /// When there is none; the message names the nearest and lists all.
    pub fn find(name: &str) -> Result<Self, SceneError> {
        /// Below this similarity a suggestion would only confuse.
        const SIMILAR: f64 = 0.7;
        if let Some(&scene) = Self::ALL.iter().find(|scene| scene.name() == name) {
            return Ok(scene);
        }
        let nearest = Self::ALL
            .iter()
            .map(|scene| (strsim::jaro_winkler(scene.name(), name), scene.name().to_owned()))
            .filter(|(similarity, _)| *similarity >= SIMILAR)
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, name)| name);
        let known = Self::ALL.iter().map(|scene| scene.name()).collect::<Vec<_>>().join(", ");
        Err(SceneError::Unknown { name: name.to_owned(), nearest, known })
    }

    /// Its frames, made one at a time.
    #[must_use]
    pub fn frames(self, size: SceneSize) -> SceneFrames {
        SceneFrames::new(self, size.in_range())
    }
}

impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The frames of one scene.
#[derive(Clone, Debug)]
pub struct SceneFrames {
    scene: Scene,
    size: SceneSize,
    street: Option<Street>,
    next: u32,
}

impl SceneFrames {
    fn new(scene: Scene, size: SceneSize) -> Self {
        let street = match scene {
            Scene::Street => Some(Street::new(size.width, size.height, Mood::Day)),
            Scene::NightRain => Some(Street::new(size.width, size.height, Mood::Night)),
            Scene::Shake => {
                let margin = 2 * shake_reach(&size);
                Some(Street::new(size.width + margin, size.height + margin, Mood::Day))
            }
            _ => None,
        };
        Self { scene, size, street, next: 0 }
    }

    /// Frame number `t`.
    fn frame(&self, t: u32) -> Option<Frame> {
        match (self.scene, &self.street) {
            (Scene::Street, Some(street)) => self.seen(&street.at(t), (0, 0), 160, t),
            (Scene::NightRain, Some(street)) => self.seen(&street.at(t), (0, 0), 450, t),
            (Scene::Shake, Some(street)) => {
                let span = 2 * shake_reach(&self.size) + 1;
                let shift = |axis| noise::pick(0x5AAE, t, axis, 0, span);
                self.seen(street.backdrop(), (shift(0), shift(1)), 0, t)
            }
            _ => self.made(|x, y| patterns::pixel(self.scene, &self.size, t, x, y)),
        }
    }

    /// The canvas through a sensor: cut out at `corner`, with noise, in P bits.
    fn seen(&self, canvas: &Canvas, corner: (u32, u32), amplitude: i32, t: u32) -> Option<Frame> {
        self.made(|x, y| {
            let light = i32::from(canvas.get(x + corner.0, y + corner.1));
            let noisy = light + amplitude * noise::bell(0x5EED, t, x, y);
            u32::try_from(noisy.clamp(0, 65_535)).unwrap_or(0) >> (16 - self.size.bits)
        })
    }

    fn made(&self, mut pixel: impl FnMut(u32, u32) -> u32) -> Option<Frame> {
        let SceneSize { width, height, bits, .. } = self.size;
        let limit = self.size.max();
        let pixel = |x, y| u16::try_from(pixel(x, y).min(limit)).unwrap_or(u16::MAX);
        // A size in range is a valid frame.
        Frame::from_fn(width, height, bits, pixel).ok()
    }
}

impl Iterator for SceneFrames {
    type Item = Frame;

    fn next(&mut self) -> Option<Frame> {
        if self.next >= self.size.frames {
            return None;
        }
        self.next += 1;
        self.frame(self.next - 1)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = (self.size.frames - self.next.min(self.size.frames)) as usize;
        (left, Some(left))
    }
}

impl ExactSizeIterator for SceneFrames {}

/// How far a shaking camera goes to either side, in pixels: 4 at 224x224.
fn shake_reach(size: &SceneSize) -> u32 {
    (size.width.min(size.height) / 56).max(1)
}
