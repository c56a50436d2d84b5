// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames of a scene, which are computed one at a time.

use foveate_frame::Frame;

use crate::canvas::Canvas;
use crate::street::{Mood, Street};
use crate::{Scene, SceneSize, noise, patterns};

impl Scene {
    /// Returns an iterator over the frames of the scene, which computes one at a time. A size
    /// outside of its range is clamped.
    #[must_use]
    pub fn frames(self, size: SceneSize) -> SceneFrames {
        SceneFrames::new(self, size.in_range())
    }
}

/// An iterator over the frames of one scene.
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

    /// Returns frame number `t`, and does not advance the iterator.
    #[must_use]
    pub fn at(&self, t: u32) -> Frame {
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

    /// Returns the frame of a sensor that looks at the canvas: cut out at `corner`, with noise of
    /// the given amplitude, in P bits.
    fn seen(&self, canvas: &Canvas, corner: (u32, u32), amplitude: i32, t: u32) -> Frame {
        self.made(|x, y| {
            let light = i32::from(canvas.get(x + corner.0, y + corner.1));
            let noisy = light + amplitude * noise::bell(0x5EED, t, x, y);
            u32::try_from(noisy.clamp(0, 65_535)).expect("not negative") >> (16 - self.size.bits)
        })
    }

    fn made(&self, mut pixel: impl FnMut(u32, u32) -> u32) -> Frame {
        let SceneSize { width, height, bits, .. } = self.size;
        let limit = self.size.max();
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
        Some(self.at(self.next - 1))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = (self.size.frames - self.next.min(self.size.frames)) as usize;
        (left, Some(left))
    }
}

impl ExactSizeIterator for SceneFrames {}

/// Returns the largest displacement of a shaking camera to either side, in pixels. It is 4 for
/// 224x224 pixels.
fn shake_reach(size: &SceneSize) -> u32 {
    (size.width.min(size.height) / 56).max(1)
}
