// SPDX-License-Identifier: MIT OR Apache-2.0
//! The update of screen and references after the decision: copy, keep or clear each region.

use foveate_camera::Action;
use foveate_camera::{Payload, Reference};

use crate::pixels::Pixels;
use crate::plan::CameraPlan;
use foveate_lanes::Lane;

/// The parts of a band's planes that its actions change. The screen has no padding.
#[derive(Debug)]
pub(crate) struct Canvas<'a, T> {
    pub(crate) screen: &'a mut [T],
    pub(crate) denoised: &'a [T],
    pub(crate) reference: &'a mut [T],
    /// The regions that have a valid reference.
    pub(crate) valid: &'a mut [bool],
    /// The regions of the screen that are black already.
    pub(crate) black: &'a mut [bool],
    /// The means that the regions sent last.
    pub(crate) means: &'a [T],
}

impl<T: Lane> Canvas<'_, T> {
    /// Applies the action of every region of band `number`.
    #[inline(always)]
    pub(crate) fn act<const PERIPHERY: bool>(
        &mut self,
        plan: &CameraPlan<T>,
        raw: Pixels<'_, T>,
        number: usize,
        actions: &[Action],
    ) {
        let (side, stride, top) = (plan.side, plan.stride(), number * plan.side);
        let height = side.min(plan.height - top);
        for (column, &action) in actions.iter().enumerate() {
            let left = column * side;
            let width = side.min(plan.width - left);
            match action {
                Action::Forward => {
                    let (source, from, step) = match plan.payload {
                        Payload::Denoised => (self.denoised, left, stride),
                        Payload::Raw => (raw.values, top * raw.stride + left, raw.stride),
                    };
                    let to = &mut self.screen[left..];
                    copy(&source[from..], step, to, plan.width, width, height);
                    self.black[column] = false;
                }
                Action::Hold => {}
                Action::Summarize if !PERIPHERY => {}
                Action::Summarize => {
                    let periphery =
                        plan.periphery.as_ref().expect("only a periphery sends summaries");
                    let (place, screen) = ((plan.columns, column), &mut self.screen[left..]);
                    periphery.show(self.means, place, screen, (plan.width, width, height));
                    self.black[column] = false;
                }
                Action::Blank if self.black[column] => {}
                Action::Blank => {
                    clear(&mut self.screen[left..], plan.width, width, height);
                    self.black[column] = true;
                }
            }
            match (plan.reference, action) {
                (Reference::Previous, _) => self.valid[column] = true,
                (Reference::LastSent, Action::Forward) => {
                    let (from, to) = (&self.denoised[left..], &mut self.reference[left..]);
                    copy(from, stride, to, stride, side, side);
                    self.valid[column] = true;
                }
                (Reference::LastSent, Action::Hold) => {}
                (Reference::LastSent, Action::Blank | Action::Summarize) => {
                    self.valid[column] = false;
                }
            }
        }
    }
}

/// The number of pixels that one long copy moves in the time that one row of a region takes.
const PIECE: usize = 64;

/// Copies band `number` of the screen to a kept screen. Each comes with its black regions, which
/// are not written again.
#[inline(always)]
pub(crate) fn show<T: Lane>(
    plan: &CameraPlan<T>,
    number: usize,
    (screen, black): (&[T], &[bool]),
    (kept, kept_black): (&mut [T], &mut [bool]),
) {
    let height = plan.side.min(plan.height - number * plan.side);
    let written = black.iter().zip(&*kept_black).filter(|(black, kept)| !(**black & **kept));
    if written.count() * PIECE > plan.width {
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
fn clear<T: Lane>(plane: &mut [T], stride: usize, width: usize, height: usize) {
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
