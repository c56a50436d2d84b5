// SPDX-License-Identifier: MIT OR Apache-2.0
//! The renderer alone: the screen of a receiver that gets actions, pixels and means over a link. It
//! is the engine's own renderer, applied to the received pixels.

use foveate_camera::{Camera, Payload, ReferencePolicy, RegionAction};
use foveate_pixels::{FramePixels, lanes::PixelLane};

use crate::pixels::BorrowedFrame;
use crate::plan::CameraPlan;
use crate::renderer::BandRenderer;

/// A screen, and the pixels and means that were received for the next frame.
#[derive(Debug)]
pub struct Receiver {
    state: ReceiverLanes,
}

#[derive(Debug)]
enum ReceiverLanes {
    Bytes(ReceiverState<u8>),
    Words(ReceiverState<u16>),
}

#[derive(Debug)]
struct ReceiverState<T: PixelLane> {
    plan: CameraPlan<T>,
    /// The pixels that were received last, in a padded frame.
    pixels: Vec<T>,
    /// The means that were received last, row by row of blocks.
    means: Vec<T>,
    screen: Vec<T>,
    black_regions: Vec<bool>,
    reference_valid: Vec<bool>,
}

impl Receiver {
    /// Makes a receiver with a black screen.
    #[must_use]
    pub fn new(camera: &Camera) -> Self {
        let state = if camera.pixel_bits() <= 8 {
            ReceiverLanes::Bytes(ReceiverState::new(camera))
        } else {
            ReceiverLanes::Words(ReceiverState::new(camera))
        };
        Self { state }
    }

    /// Makes the screen black.
    pub fn reset(&mut self) {
        match &mut self.state {
            ReceiverLanes::Bytes(state) => state.reset(),
            ReceiverLanes::Words(state) => state.reset(),
        }
    }

    /// Takes the N x N pixels of a region in row-major order. Pixels beyond the region are dropped,
    /// and values that are too large lose their high bits.
    pub fn take_pixels(&mut self, region: u32, pixels: &[u16]) {
        match &mut self.state {
            ReceiverLanes::Bytes(state) => state.take_pixels(region, pixels),
            ReceiverLanes::Words(state) => state.take_pixels(region, pixels),
        }
    }

    /// Takes the means of a region, row by row of blocks, as [`Receiver::take_pixels`] takes
    /// pixels.
    pub fn take_means(&mut self, region: u32, means: &[u16]) {
        match &mut self.state {
            ReceiverLanes::Bytes(state) => state.take_means(region, means),
            ReceiverLanes::Words(state) => state.take_means(region, means),
        }
    }

    /// Applies the action of every region, numbered row by row.
    pub fn show(&mut self, actions: &[RegionAction]) {
        match &mut self.state {
            ReceiverLanes::Bytes(state) => state.show(actions),
            ReceiverLanes::Words(state) => state.show(actions),
        }
    }

    /// Returns the screen.
    #[must_use]
    pub fn rendered(&self) -> FramePixels<'_> {
        match &self.state {
            ReceiverLanes::Bytes(state) => FramePixels::Bytes(&state.screen),
            ReceiverLanes::Words(state) => FramePixels::Words(&state.screen),
        }
    }
}

impl<T: PixelLane> ReceiverState<T> {
    fn new(camera: &Camera) -> Self {
        // Received pixels are shown unchanged, and no reference is needed.
        let plan = CameraPlan {
            payload: Payload::Denoised,
            reference: ReferencePolicy::Previous,
            ..CameraPlan::new(camera)
        };
        Self {
            pixels: vec![T::default(); plan.stride() * plan.rows * plan.side],
            means: vec![T::default(); plan.rows * plan.band_means()],
            screen: vec![T::default(); plan.width * plan.height],
            black_regions: vec![true; plan.regions()],
            reference_valid: vec![false; plan.regions()],
            plan,
        }
    }

    fn reset(&mut self) {
        self.screen.fill(T::default());
        self.black_regions.fill(true);
    }

    fn take_pixels(&mut self, region: u32, pixels: &[u16]) {
        let plan = &self.plan;
        let to = self.pixels.get_mut(plan.first_pixel(region)..).unwrap_or_default();
        write_rows(to, plan.stride(), pixels, plan.side);
    }

    fn take_means(&mut self, region: u32, means: &[u16]) {
        let plan = &self.plan;
        let Some(periphery) = &plan.periphery else { return };
        let to =
            self.means.get_mut(plan.first_mean(region, periphery.blocks)..).unwrap_or_default();
        write_rows(to, plan.means_in_row(), means, periphery.blocks);
    }

    fn show(&mut self, actions: &[RegionAction]) {
        let plan = &self.plan;
        let band_pixels = plan.stride() * plan.side;
        let raw = BorrowedFrame {
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
            .zip(self.black_regions.chunks_exact_mut(plan.columns))
            .zip(self.reference_valid.chunks_exact_mut(plan.columns));
        for (band, ((((actions, screen), denoised), black), valid)) in bands.enumerate() {
            let (band_means, rest) = means.split_at(plan.band_means());
            means = rest;
            let reference: &mut [T] = &mut [];
            let mut renderer = BandRenderer {
                screen,
                denoised,
                reference,
                reference_valid: valid,
                black_regions: black,
                means: band_means,
            };
            renderer.apply_actions(plan, raw, band, actions);
        }
    }
}

/// Writes values into a plane, in rows of `width`.
fn write_rows<T: PixelLane>(plane: &mut [T], stride: usize, values: &[u16], width: usize) {
    for (row, to) in values.chunks(width).zip(plane.chunks_mut(stride)) {
        for (to, &value) in to.iter_mut().zip(row) {
            *to = T::from_low_bits(value.into());
        }
    }
}
