// SPDX-License-Identifier: MIT OR Apache-2.0
//! The renderer: it updates screen and references after the decision by copying, keeping or
//! clearing each region ([`BandRenderer`]). A [`Receiver`] is this renderer alone, applied to
//! what came over a link.
//!
//! The caller keeps the rendered frames of a batch from batch to batch ([`BatchScreens`]). Most
//! of a rendered frame is black, and was black in the frame that the buffer held before, so
//! regions that are known to be black are not written again. This is why the buffers are not
//! plain slices of the caller.

use crate::pixels::BorrowedFrame;
use crate::plan::CameraPlan;
use foveate_camera::{Camera, Payload, ReferencePolicy, RegionAction};
use foveate_pixels::FramePixels;
use foveate_pixels::vectors::VectorPixel;

/// A screen, and the pixels and means that were received for the next frame.
#[derive(Debug)]
pub struct Receiver {
    state: ReceiverCore,
}

#[derive(Debug)]
enum ReceiverCore {
    Bytes(ReceiverState<u8>),
    Words(ReceiverState<u16>),
}

#[derive(Debug)]
struct ReceiverState<T: VectorPixel> {
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
            ReceiverCore::Bytes(ReceiverState::new(camera))
        } else {
            ReceiverCore::Words(ReceiverState::new(camera))
        };
        Self { state }
    }

    /// Makes the screen black.
    pub fn reset(&mut self) {
        match &mut self.state {
            ReceiverCore::Bytes(state) => state.reset(),
            ReceiverCore::Words(state) => state.reset(),
        }
    }

    /// Takes the N x N pixels of a region in row-major order. Pixels beyond the region are dropped,
    /// and values that are too large lose their high bits.
    pub fn take_pixels(&mut self, region: u32, pixels: &[u16]) {
        match &mut self.state {
            ReceiverCore::Bytes(state) => state.take_pixels(region, pixels),
            ReceiverCore::Words(state) => state.take_pixels(region, pixels),
        }
    }

    /// Takes the means of a region, row by row of blocks, as [`Receiver::take_pixels`] takes
    /// pixels.
    pub fn take_means(&mut self, region: u32, means: &[u16]) {
        match &mut self.state {
            ReceiverCore::Bytes(state) => state.take_means(region, means),
            ReceiverCore::Words(state) => state.take_means(region, means),
        }
    }

    /// Applies the action of every region, numbered row by row.
    pub fn show(&mut self, actions: &[RegionAction]) {
        match &mut self.state {
            ReceiverCore::Bytes(state) => state.show(actions),
            ReceiverCore::Words(state) => state.show(actions),
        }
    }

    /// Returns the screen.
    #[must_use]
    pub fn rendered(&self) -> FramePixels<'_> {
        match &self.state {
            ReceiverCore::Bytes(state) => FramePixels::Bytes(&state.screen),
            ReceiverCore::Words(state) => FramePixels::Words(&state.screen),
        }
    }
}

impl<T: VectorPixel> ReceiverState<T> {
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
fn write_rows<T: VectorPixel>(plane: &mut [T], stride: usize, values: &[u16], width: usize) {
    for (row, to) in values.chunks(width).zip(plane.chunks_mut(stride)) {
        for (to, &value) in to.iter_mut().zip(row) {
            *to = T::from_low_bits(value.into());
        }
    }
}

/// The parts of a band's planes that its actions change. The screen has no padding.
#[derive(Debug)]
pub(crate) struct BandRenderer<'a, T> {
    pub(crate) screen: &'a mut [T],
    pub(crate) denoised: &'a [T],
    pub(crate) reference: &'a mut [T],
    /// The regions that have a valid reference.
    pub(crate) reference_valid: &'a mut [bool],
    /// The regions of the screen that are black already.
    pub(crate) black_regions: &'a mut [bool],
    /// The means that the regions sent last.
    pub(crate) means: &'a [T],
}

impl<T: VectorPixel> BandRenderer<'_, T> {
    /// Applies the action of every region of band `number`.
    #[inline(always)]
    pub(crate) fn apply_actions(
        &mut self,
        plan: &CameraPlan<T>,
        raw: BorrowedFrame<'_, T>,
        number: usize,
        actions: &[RegionAction],
    ) {
        let (side, stride, top) = (plan.side, plan.stride(), number * plan.side);
        let height = side.min(plan.height - top);
        for (column, &action) in actions.iter().enumerate() {
            let left = column * side;
            let width = side.min(plan.width - left);
            match action {
                RegionAction::Forward => {
                    let (source, from, step) = match plan.payload {
                        Payload::Denoised => (self.denoised, left, stride),
                        Payload::Raw => (raw.values, top * raw.stride + left, raw.stride),
                    };
                    let to = &mut self.screen[left..];
                    copy(&source[from..], step, to, plan.width, width, height);
                    self.black_regions[column] = false;
                }
                RegionAction::Hold => {}
                RegionAction::Summarize => {
                    let periphery =
                        plan.periphery.as_ref().expect("only a periphery sends summaries");
                    let (place, screen) = ((plan.columns, column), &mut self.screen[left..]);
                    periphery.show_region(self.means, place, screen, (plan.width, width, height));
                    self.black_regions[column] = false;
                }
                RegionAction::Blank if self.black_regions[column] => {}
                RegionAction::Blank => {
                    clear(&mut self.screen[left..], plan.width, width, height);
                    self.black_regions[column] = true;
                }
            }
            match (plan.reference, action) {
                (ReferencePolicy::Previous, _) => self.reference_valid[column] = true,
                (ReferencePolicy::LastSent, RegionAction::Forward) => {
                    let (from, to) = (&self.denoised[left..], &mut self.reference[left..]);
                    copy(from, stride, to, stride, side, side);
                    self.reference_valid[column] = true;
                }
                (ReferencePolicy::LastSent, RegionAction::Hold) => {}
                (ReferencePolicy::LastSent, RegionAction::Blank | RegionAction::Summarize) => {
                    self.reference_valid[column] = false;
                }
            }
        }
    }
}

/// The number of pixels that one long copy moves in the time in which a short copy moves one row of
/// a region. A short copy costs mainly its start.
const LONG_COPY_PIXELS: usize = 64;

/// Copies band `number` of the screen to a kept screen. `black` and `kept_black` tell which regions
/// of the two screens are black; a region that is black on both is not written.
#[inline(always)]
pub(crate) fn keep_screen_band<T: VectorPixel>(
    plan: &CameraPlan<T>,
    number: usize,
    (screen, black): (&[T], &[bool]),
    (kept, kept_black): (&mut [T], &mut [bool]),
) {
    let height = plan.side.min(plan.height - number * plan.side);
    // One long copy of the whole band is faster than short copies of many regions.
    let written = black.iter().zip(&*kept_black).filter(|(black, kept)| !(**black & **kept));
    if written.count() * LONG_COPY_PIXELS > plan.width {
        kept[..height * plan.width].copy_from_slice(&screen[..height * plan.width]);
        kept_black.copy_from_slice(black);
        return;
    }
    for (column, (&black, kept_black)) in black.iter().zip(kept_black).enumerate() {
        let left = column * plan.side;
        let width = plan.side.min(plan.width - left);
        let kept = &mut kept[left..];
        match (black, *kept_black) {
            (false, _) => copy(&screen[left..], plan.width, kept, plan.width, width, height),
            (true, false) => clear(kept, plan.width, width, height),
            (true, true) => {}
        }
        *kept_black = black;
    }
}

/// Sets `width` x `height` values of a plane to zero.
#[inline(always)]
fn clear<T: VectorPixel>(plane: &mut [T], stride: usize, width: usize, height: usize) {
    for y in 0..height {
        plane[y * stride..][..width].fill(T::default());
    }
}

/// Copies `width` x `height` values from one plane to another.
#[inline(always)]
fn copy<T: Copy>(
    from: &[T],
    from_stride: usize,
    to: &mut [T],
    to_stride: usize,
    width: usize,
    height: usize,
) {
    // The usual widths are constants, so that a copy is a few moves in place of a call.
    match width {
        8 => copy_constant::<8, T>(from, from_stride, to, to_stride, height),
        16 => copy_constant::<16, T>(from, from_stride, to, to_stride, height),
        32 => copy_constant::<32, T>(from, from_stride, to, to_stride, height),
        64 => copy_constant::<64, T>(from, from_stride, to, to_stride, height),
        _ => {
            for y in 0..height {
                to[y * to_stride..][..width].copy_from_slice(&from[y * from_stride..][..width]);
            }
        }
    }
}

#[inline(always)]
fn copy_constant<const WIDTH: usize, T: Copy>(
    from: &[T],
    from_stride: usize,
    to: &mut [T],
    to_stride: usize,
    height: usize,
) {
    for y in 0..height {
        let from = from[y * from_stride..].first_chunk::<WIDTH>();
        let to = to[y * to_stride..].first_chunk_mut::<WIDTH>();
        if let (Some(from), Some(to)) = (from, to) {
            *to = *from;
        }
    }
}

/// The rendered frames of the last batch, one per frame. The same value can be given to batch after
/// batch of any engine. Pixels are `u8` up to 8 bits and `u16` beyond.
#[derive(Clone, Debug, Default)]
pub struct BatchScreens<T> {
    /// The width and height of the frames and the side of a region.
    size_and_region: (usize, usize, usize),
    /// The screens, followed by unused ones if an earlier batch was longer.
    screens: Vec<KeptScreen<T>>,
    used: usize,
}

/// A rendered frame.
#[derive(Clone, Debug)]
pub(crate) struct KeptScreen<T> {
    pub(crate) pixels: Vec<T>,
    pub(crate) black_regions: Vec<bool>,
}

impl<T> BatchScreens<T> {
    /// Makes a buffer without frames.
    #[must_use]
    pub fn new() -> Self {
        Self { size_and_region: (0, 0, 0), screens: Vec::new(), used: 0 }
    }

    /// Returns the rendered frame after frame `number` of the last batch, in row-major order
    /// without padding.
    #[must_use]
    pub fn get(&self, number: usize) -> Option<&[T]> {
        self.iter().nth(number)
    }

    /// Returns all rendered frames of the last batch in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[T]> {
        self.screens[..self.used].iter().map(|screen| &screen.pixels[..])
    }
}

/// Returns one screen per frame, to be written.
pub(crate) fn resize_screens<'a, T: VectorPixel>(
    screens: &'a mut BatchScreens<T>,
    plan: &CameraPlan<T>,
    frames: usize,
) -> &'a mut [KeptScreen<T>] {
    let shape = (plan.width, plan.height, plan.side);
    if screens.size_and_region != shape {
        *screens = BatchScreens { size_and_region: shape, ..BatchScreens::new() };
    }
    let new = || KeptScreen {
        pixels: vec![T::default(); plan.width * plan.height],
        black_regions: vec![true; plan.regions()],
    };
    screens.screens.resize_with(frames.max(screens.screens.len()), new);
    screens.used = frames;
    &mut screens.screens[..frames]
}
