// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames of a scene, which are computed one at a time.

use crate::Frame;
use crate::scenes::noise;

use crate::scenes::canvas::Canvas;
use crate::scenes::street::{Street, TimeOfDay};
use crate::scenes::{Scene, SceneParameters, patterns};

impl Scene {
    /// Returns an iterator over the frames of the scene, which computes one at a time. A size
    /// outside of its range is clamped.
    #[must_use]
    pub fn frames(self, size: SceneParameters) -> SceneFrames {
        SceneFrames::new(self, size.clamped())
    }
}

/// An iterator over the frames of one scene.
#[derive(Clone, Debug)]
pub struct SceneFrames {
    scene: Scene,
    size: SceneParameters,
    street: Option<Street>,
    next: u32,
}

impl SceneFrames {
    fn new(scene: Scene, size: SceneParameters) -> Self {
        let street = match scene {
            Scene::Street => Some(Street::new(size.width, size.height, TimeOfDay::Day)),
            Scene::NightRain => Some(Street::new(size.width, size.height, TimeOfDay::Night)),
            Scene::Shake => {
                let margin = 2 * shake_reach(&size);
                Some(Street::new(size.width + margin, size.height + margin, TimeOfDay::Day))
            }
            _ => None,
        };
        Self { scene, size, street, next: 0 }
    }

    /// Returns frame number `t`, and does not advance the iterator.
    #[must_use]
    pub fn frame_at(&self, t: u32) -> Frame {
        match (self.scene, &self.street) {
            (Scene::Street, Some(street)) => {
                self.sensor_frame(&street.canvas_at(t), (0, 0), 160, t)
            }
            (Scene::NightRain, Some(street)) => {
                self.sensor_frame(&street.canvas_at(t), (0, 0), 450, t)
            }
            (Scene::Shake, Some(street)) => {
                let span = 2 * shake_reach(&self.size) + 1;
                let shift = |axis| noise::pick(0x5AAE, t, axis, 0, span);
                self.sensor_frame(street.backdrop(), (shift(0), shift(1)), 0, t)
            }
            _ => self
                .frame_from_pixels(|x, y| patterns::pattern_pixel(self.scene, &self.size, t, x, y)),
        }
    }

    /// Returns the frame of a sensor that looks at the canvas: cut out at `corner`, with noise of
    /// the given amplitude, in P bits.
    fn sensor_frame(&self, canvas: &Canvas, corner: (u32, u32), amplitude: i32, t: u32) -> Frame {
        self.frame_from_pixels(|x, y| {
            let light = i32::from(canvas.get(x + corner.0, y + corner.1));
            let noisy = light + amplitude * noise::normal_noise(0x5EED, t, x, y);
            u32::try_from(noisy.clamp(0, 65_535)).expect("not negative") >> (16 - self.size.bits)
        })
    }

    fn frame_from_pixels(&self, mut pixel: impl FnMut(u32, u32) -> u32) -> Frame {
        let SceneParameters { width, height, bits, .. } = self.size;
        let limit = self.size.pixel_max();
        let pixel = |x, y| u16::try_from(pixel(x, y).min(limit)).expect("of at most 16 bits");
        Frame::from_fn(width, height, bits, pixel).expect("a size in range is a valid frame")
    }
}

impl Iterator for SceneFrames {
    type Item = Frame;

    fn next(&mut self) -> Option<Frame> {
        if self.next >= self.size.frames {
            return None;
        }
        self.next += 1;
        Some(self.frame_at(self.next - 1))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = (self.size.frames - self.next.min(self.size.frames)) as usize;
        (left, Some(left))
    }
}

impl ExactSizeIterator for SceneFrames {}

/// Returns the largest displacement of a shaking camera to either side, in pixels. It is 4 for
/// 224x224 pixels.
fn shake_reach(size: &SceneParameters) -> u32 {
    (size.width.min(size.height) / 56).max(1)
}
