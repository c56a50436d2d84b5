// SPDX-License-Identifier: MIT OR Apache-2.0
//! The update of screen and references after the decision: copy, keep or clear each region.

use foveate_camera::{Payload, ReferencePolicy, RegionAction};

use crate::pixels::BorrowedFrame;
use crate::plan::CameraPlan;
use foveate_pixels::lanes::PixelLane;

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

impl<T: PixelLane> BandRenderer<'_, T> {
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
pub(crate) fn keep_screen_band<T: PixelLane>(
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
fn clear<T: PixelLane>(plane: &mut [T], stride: usize, width: usize, height: usize) {
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
