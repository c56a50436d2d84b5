// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cameras of a page, by number, and the scenes that it shows to them.

use foveate_design::DesignConfig;
use foveate_pixels::{Scene, SceneFrames, SceneParameters};
use serde_json::Value;

use super::facts::page_description;
use super::limits::{MAX_CAMERAS, MAX_PIXELS};
use crate::{LiveCamera, WebError, facts};

/// The state of a page: its cameras and its scene.
#[derive(Debug, Default)]
pub struct PageCameras {
    cameras: [Option<LiveCamera>; MAX_CAMERAS],
    /// The scene that was asked for last. It is kept so that its backdrop is drawn only once.
    scene: Option<(Scene, SceneParameters, SceneFrames)>,
    frame: Vec<u8>,
}

impl PageCameras {
    /// Returns the description of what a page can ask for.
    ///
    /// # Errors
    /// Does not fail for the tables of this program, which a test proves.
    pub fn description(&self) -> Result<Value, WebError> {
        Ok(page_description()?)
    }

    /// Makes a camera for frames of this size from a configuration in TOML. Returns its number, and
    /// the facts about it.
    ///
    /// # Errors
    /// Fails if the configuration is refused, the frame is too large, or there are too many
    /// cameras.
    pub fn configure(
        &mut self,
        toml: &[u8],
        (width, height): (u32, u32),
    ) -> Result<(u32, Value), WebError> {
        let config = DesignConfig::from_toml(utf8_text(toml, "configuration")?)?;
        let design = config.validate_for_frames(width, height)?;
        check_size(width, height)?;
        let free = (0..).zip(&mut self.cameras).find(|(_, place)| place.is_none());
        let (number, place) = free.ok_or(WebError::TooManyCameras { most: MAX_CAMERAS })?;
        let camera = place.insert(LiveCamera::new(design));
        Ok((number, facts::camera_facts(camera.design())))
    }

    /// Returns the camera with this number.
    ///
    /// # Errors
    /// Fails if there is no such camera.
    pub fn camera(&mut self, handle: u32) -> Result<&mut LiveCamera, WebError> {
        let camera = self.cameras.get_mut(handle as usize).and_then(Option::as_mut);
        camera.ok_or(WebError::NoSuchCamera { handle })
    }

    /// Sets the classes of the regions of a camera, as [`LiveCamera::set_classes`] does. Returns the
    /// facts about the camera.
    ///
    /// # Errors
    /// Fails if there is no such camera, or if the classes are refused.
    pub fn set_classes(&mut self, handle: u32, codes: &[u8]) -> Result<Value, WebError> {
        let camera = self.camera(handle)?;
        camera.set_classes(codes)?;
        Ok(facts::camera_facts(camera.design()))
    }

    /// Ends a camera.
    ///
    /// # Errors
    /// Fails if there is no camera with this number.
    pub fn remove(&mut self, handle: u32) -> Result<(), WebError> {
        self.camera(handle)?;
        self.cameras[handle as usize] = None;
        Ok(())
    }

    /// Returns a frame of a scene as 8-bit grey, made for regions of `region_size` x `region_size`
    /// pixels. After the last frame the first comes again.
    ///
    /// # Errors
    /// Fails if there is no scene of that name, or if the frame is too large.
    pub fn scene_frame(
        &mut self,
        name: &[u8],
        (width, height): (u32, u32),
        region_size: u32,
        number: u32,
    ) -> Result<&[u8], WebError> {
        let scene = Scene::find(utf8_text(name, "name of the scene")?)?;
        check_size(width, height)?;
        let frames = scene.default_frames();
        let size = SceneParameters { width, height, bits: 8, region_size, frames };
        let known = self.scene.take().filter(|(own, of, _)| (*own, *of) == (scene, size));
        let (.., made) =
            self.scene.insert(known.unwrap_or_else(|| (scene, size, scene.frames(size))));
        let frame = made.frame_at(number % frames);
        self.frame.clear();
        self.frame.extend(frame.pixels().iter().map(|pixel| pixel.to_le_bytes()[0]));
        Ok(&self.frame)
    }
}

/// Fails if a frame has no pixels or too many.
pub(crate) fn check_size(width: u32, height: u32) -> Result<(), WebError> {
    let pixels = u64::from(width) * u64::from(height);
    if (1..=u64::from(MAX_PIXELS)).contains(&pixels) {
        return Ok(());
    }
    Err(WebError::FrameSize { width, height, most: MAX_PIXELS })
}

fn utf8_text<'a>(bytes: &'a [u8], what: &'static str) -> Result<&'a str, WebError> {
    std::str::from_utf8(bytes).map_err(|error| WebError::NotUtf8 { what, at: error.valid_up_to() })
}
