// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frame stores of every RPU. A place is read before it is overwritten, so that one frame's worth of
//! places holds the frame that comes in and what is left of the one before, as in the hardware.
//! Nothing is ever cleared; flags say what is valid.

use foveate_lanes::{BLOCK, Block, Lane};

use crate::plan::Plan;
use crate::rows::{Memory, Row};
use crate::window::Pixels;

/// The last frames, and the one that was last sent where that is a reference.
#[derive(Clone, Debug)]
pub(crate) struct Store<T: Lane> {
    latest: Frame<T>,
    /// With a second pass: the frame before it, because pixels leave a frame later.
    before: Option<Frame<T>>,
    sent: Option<Memory<T>>,
}

#[derive(Clone, Debug)]
struct Frame<T: Lane> {
    scored: Memory<T>,
    raw: Option<Memory<T>>,
}

impl<T: Lane> Store<T> {
    pub(crate) fn new(plan: &Plan, keeps_sent: bool) -> Self {
        let memory = || Memory::new(plan.pixels, plan.lanes);
        let frame = || Frame { scored: memory(), raw: plan.keeps_raw.then(memory) };
        Self {
            latest: frame(),
            before: plan.second_pass.then(frame),
            sent: keeps_sent.then(memory),
        }
    }

    /// The scored values of the frame before, until [`Store::write`].
    pub(crate) fn previous(&self, position: usize) -> &[Block<T>] {
        self.latest.scored.row(position)
    }

    /// The scored values that were last sent.
    pub(crate) fn sent(&self, position: usize) -> Option<&[Block<T>]> {
        self.sent.as_ref().map(|sent| sent.row(position))
    }

    /// Pixels of the frame that leaves, until [`Store::write`].
    pub(crate) fn leaving(&self, position: usize) -> &[Block<T>] {
        let frame = self.before.as_ref().unwrap_or(&self.latest);
        frame.raw.as_ref().unwrap_or(&frame.scored).row(position)
    }

    #[inline(always)]
    pub(crate) fn write(&mut self, position: usize, pixels: Pixels<'_, T>) {
        let Self { latest, before, .. } = self;
        if let Some(before) = before {
            before.write(position, latest.scored.row(position), latest.raw_row(position));
        }
        latest.write(position, pixels.scored, pixels.raw);
    }

    /// Where `active` is set, the frame that has just been decided is the one that was last sent.
    #[inline(always)]
    pub(crate) fn send_decided(&mut self, active: &Row<T>) {
        let Self { latest, before, sent } = self;
        let Some(sent) = sent else { return };
        let decided = &before.as_ref().unwrap_or(latest).scored;
        let active = active.blocks();
        let places = sent.all_mut().chunks_exact_mut(active.len());
        for (sent, decided) in places.zip(decided.all().chunks_exact(active.len())) {
            for ((sent, decided), active) in sent.iter_mut().zip(decided).zip(active) {
                for lane in 0..BLOCK {
                    sent[lane] = sent[lane] ^ ((sent[lane] ^ decided[lane]) & active[lane]);
                }
            }
        }
    }
}

impl<T: Lane> Frame<T> {
    fn raw_row(&self, position: usize) -> Option<&[Block<T>]> {
        self.raw.as_ref().map(|raw| raw.row(position))
    }

    #[inline(always)]
    fn write(&mut self, position: usize, scored: &[Block<T>], raw: Option<&[Block<T>]>) {
        self.scored.row_mut(position).copy_from_slice(scored);
        if let (Some(memory), Some(raw)) = (&mut self.raw, raw) {
            memory.row_mut(position).copy_from_slice(raw);
        }
    }
}
