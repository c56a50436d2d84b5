// SPDX-License-Identifier: MIT OR Apache-2.0
//! The renderer alone: the screen of a receiver that gets actions, pixels and means over a link. It
//! is the engine's own renderer, applied to the received pixels.

use foveate_camera::{Action, Camera, Payload, Reference};
use foveate_frame::Plane;
use foveate_lanes::Lane;

use crate::pixels::Pixels;
use crate::plan::CameraPlan;
use crate::render::Canvas;

/// A screen, and the pixels and means that were received for the next frame.
#[derive(Debug)]
pub struct Receiver {
    state: State,
}

#[derive(Debug)]
enum State {
    Bytes(Received<u8>),
    Words(Received<u16>),
}

#[derive(Debug)]
struct Received<T: Lane> {
    plan: CameraPlan<T>,
    /// The pixels that were received last, in a padded frame.
    pixels: Vec<T>,
    /// The means that were received last, row by row of blocks.
    means: Vec<T>,
    screen: Vec<T>,
    black: Vec<bool>,
    valid: Vec<bool>,
}

impl Receiver {
    /// Makes a receiver with a black screen.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        let state = if camera.pixel_bits() <= 8 {
            State::Bytes(Received::new(camera))
        } else {
            State::Words(Received::new(camera))
        };
        Self { state }
    }

    /// Makes the screen black.
    pub fn reset(&mut self) {
        match &mut self.state {
            State::Bytes(received) => received.reset(),
            State::Words(received) => received.reset(),
        }
    }

    /// Takes the N x N pixels of a region in row-major order. Pixels beyond the region are dropped,
    /// and values that are too large lose their high bits.
    pub fn take_pixels(&mut self, region: u32, pixels: &[u16]) {
        match &mut self.state {
            State::Bytes(received) => received.take_pixels(region, pixels),
            State::Words(received) => received.take_pixels(region, pixels),
        }
    }

    /// Takes the means of a region, row by row of blocks, as [`Receiver::take_pixels`] takes
    /// pixels.
    pub fn take_means(&mut self, region: u32, means: &[u16]) {
        match &mut self.state {
            State::Bytes(received) => received.take_means(region, means),
            State::Words(received) => received.take_means(region, means),
        }
    }

    /// Applies the action of every region, numbered row by row.
    pub fn show(&mut self, actions: &[Action]) {
        match &mut self.state {
            State::Bytes(received) => received.show(actions),
            State::Words(received) => received.show(actions),
        }
    }

    /// Returns the screen.
    #[must_use]
    pub fn rendered(&self) -> Plane<'_> {
        match &self.state {
            State::Bytes(received) => Plane::Bytes(&received.screen),
            State::Words(received) => Plane::Words(&received.screen),
        }
    }
}

impl<T: Lane> Received<T> {
    fn new(camera: &Camera) -> Self {
        // Received pixels are shown unchanged, and no reference is needed.
        let plan = CameraPlan {
            payload: Payload::Denoised,
            reference: Reference::Previous,
            ..CameraPlan::new(camera)
        };
        Self {
            pixels: vec![T::default(); plan.stride() * plan.rows * plan.side],
            means: vec![T::default(); plan.rows * plan.band_means()],
            screen: vec![T::default(); plan.width * plan.height],
            black: vec![true; plan.regions()],
            valid: vec![false; plan.regions()],
            plan,
        }
    }

    fn reset(&mut self) {
        self.screen.fill(T::default());
        self.black.fill(true);
    }

    fn take_pixels(&mut self, region: u32, pixels: &[u16]) {
        let plan = &self.plan;
        let to = self.pixels.get_mut(plan.first_pixel(region)..).unwrap_or_default();
        fill(to, plan.stride(), pixels, plan.side);
    }

    fn take_means(&mut self, region: u32, means: &[u16]) {
        let plan = &self.plan;
        let Some(own) = &plan.periphery else { return };
        let to = self.means.get_mut(plan.first_mean(region, own.blocks)..).unwrap_or_default();
        fill(to, plan.means_in_row(), means, own.blocks);
    }

    fn show(&mut self, actions: &[Action]) {
        let plan = &self.plan;
        let band_pixels = plan.stride() * plan.side;
        let raw = Pixels {
            values: &self.pixels[..],
            stride: plan.stride(),
            width: plan.width,
            height: plan.height,
        };
        let mut means = &self.means[..];
        let bands = actions
            .chunks_exact(plan.columns)
            .zip(self.screen.chunks_mut(plan.side * plan.width))
            .zip(self.pixels.chunks_exact(band_pixels))
            .zip(self.black.chunks_exact_mut(plan.columns))
            .zip(self.valid.chunks_exact_mut(plan.columns));
        for (band, ((((actions, screen), denoised), black), valid)) in bands.enumerate() {
            let (own, rest) = means.split_at(plan.band_means());
            means = rest;
            let reference: &mut [T] = &mut [];
            let mut canvas = Canvas { screen, denoised, reference, valid, black, means: own };
            if plan.periphery.is_some() {
                canvas.act::<true>(plan, raw, band, actions);
            } else {
                canvas.act::<false>(plan, raw, band, actions);
            }
        }
    }
}

/// Writes values into a plane, in rows of `width`.
fn fill<T: Lane>(plane: &mut [T], stride: usize, values: &[u16], width: usize) {
    for (row, to) in values.chunks(width).zip(plane.chunks_mut(stride)) {
        for (to, &value) in to.iter_mut().zip(row) {
            *to = T::low(value.into());
        }
    }
}
