// SPDX-License-Identifier: MIT OR Apache-2.0
//! The list of scenes with their names and summaries.

use std::fmt;

use crate::scenes::SceneError;

/// Defines the scenes with names, default numbers of frames and summaries, in the order of the
/// documentation.
macro_rules! scenes {
    ($($variant:ident $name:literal $frames:literal $summary:literal;)+) => {
        /// A synthetic scene.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Scene { $(#[doc = $summary] $variant),+ }

        impl Scene {
            /// Every scene. The first one is made to be looked at.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Returns the name of the scene on the command line, after `scene:`.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }

            /// Returns the content of the scene in one line.
            #[must_use]
            pub fn summary(self) -> &'static str {
                match self { $(Self::$variant => $summary),+ }
            }

            /// Returns the number of frames that is enough to show the scene.
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

/// The size, the depth and the number of frames of a scene. Values outside of their ranges are
/// clamped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneParameters {
    /// Width in pixels, 1..=16384.
    pub width: u32,
    /// Height in pixels, 1..=16384.
    pub height: u32,
    /// Bits per pixel P, 1..=16.
    pub bits: u32,
    /// Side of a region N in pixels, 2..=64. Some scenes place an object in every region.
    pub region_size: u32,
    /// Number of frames.
    pub frames: u32,
}

impl SceneParameters {
    /// Returns the largest pixel value, 2^P - 1.
    pub(crate) fn pixel_max(&self) -> u32 {
        (1 << self.bits) - 1
    }

    pub(crate) fn clamped(self) -> Self {
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
    /// Returns the scene of that name.
    ///
    /// # Errors
    /// Returns an error if there is no scene of that name. The message names the most similar scene
    /// and lists all.
    pub fn find(name: &str) -> Result<Self, SceneError> {
        /// The least similarity of a name that is suggested. Less similar names would only confuse.
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
        Err(SceneError::UnknownScene { name: name.to_owned(), nearest, known })
    }
}

impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
