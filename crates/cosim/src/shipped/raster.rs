// SPDX-License-Identifier: MIT OR Apache-2.0
//! A raster core in front of a sink: decisions and pixels leave while a frame is taken. A frame store outside gives
//! back what was stored.

use super::model::{Model, Record};
use super::script::FRAMES;
use crate::stimulus::{Applied, Queue, RasterCodec, words};
use foveate_design::{RasterDesign, RasterTiming, Store};
use foveate_frame::Frame;
use foveate_model::RasterRcm;

pub(super) fn model(part: RasterDesign<'_>) -> Box<dyn Model + '_> {
    let departure = part.timing().departure();
    Box::new(Raster {
        core: RasterRcm::new(part),
        codec: RasterCodec::new(part),
        outside: (part.store() == Store::External).then(|| Outside::new(part)),
        part,
        sink: Stalling { is_ready: true, has_stalled: false, losses: 0 },
        settling: departure.decision_clocks.max(departure.forward_clocks),
    })
}

struct Raster<'a> {
    core: RasterRcm,
    codec: RasterCodec,
    outside: Option<Outside>,
    part: RasterDesign<'a>,
    /// Clocks from the last word of a frame until all has left.
    settling: u64,
    sink: Stalling,
}

/// Regions lost in the middle after which the sink takes nothing any more, so that counters get far and the vectors of a
/// large frame stay small.
const ENOUGH_LOSSES: u64 = 64;

/// A sink that stalls: from the last word of a region on, when the first word of the next has been fetched, until a region
/// is lost. Every other time it takes a word at the edge of the loss.
struct Stalling {
    is_ready: bool,
    /// The last word of a region that is on the ports made it stall before.
    has_stalled: bool,
    losses: u64,
}

impl Stalling {
    fn next(&mut self, core: &RasterRcm) -> bool {
        if self.losses == ENOUGH_LOSSES {
            return false;
        }
        let shown = core.output();
        let ends = shown.forward_valid && shown.forward_last && !shown.forward_abort;
        if core.aborts_next() {
            self.losses += 1;
            let takes = self.losses.is_multiple_of(2);
            (self.is_ready, self.has_stalled) = (true, ends && !takes);
            return takes;
        }
        if self.is_ready && ends {
            self.is_ready = std::mem::take(&mut self.has_stalled);
        }
        self.is_ready
    }
}

impl Model for Raster<'_> {
    fn width(&self) -> usize {
        self.part.pixels_per_clock() as usize
    }

    fn beats(&self, frame: &Frame) -> Vec<Vec<u16>> {
        words(self.part, frame, || 0)
    }

    fn clock(&mut self, applied: &Applied<'_>, record: &mut Record) {
        let is_asked = self.core.output().reference_ready;
        let outside = self.outside.as_mut();
        let reference = outside.map(|outside| outside.show(applied.reset, is_asked));
        let applied = match &reference {
            Some((reference_valid, word)) => {
                let reference_valid = *reference_valid;
                &Applied { reference_valid, reference_pixels: word, ..*applied }
            }
            None => applied,
        };
        let shown = self.core.step(&applied.of_core());
        if let Some(outside) = &mut self.outside {
            outside.queue.keep(shown);
        }
        self.codec.inputs(&record.inputs, applied, &mut record.input);
        self.codec.outputs(&record.outputs, shown, &mut record.expected);
    }

    fn quiet_clocks(&self) -> u64 {
        0
    }

    fn is_ready(&self) -> bool {
        self.core.output().ready
    }

    fn settling_clocks(&self) -> u64 {
        self.settling
    }

    fn takes_while_stalling(&mut self) -> bool {
        self.sink.next(&self.core)
    }

    fn frames_behind(&self) -> u32 {
        0
    }
}

/// A frame store outside: a queue whose words fall through.
struct Outside {
    queue: Queue,
    /// A word that nobody may look at.
    nothing: Vec<u16>,
    /// Words that were taken since reset.
    taken: u64,
    /// The number of the word that is not said to be valid, though it is: the last of the frames that every script
    /// has. So the bench sees an underrun, and the decisions of its frames are those of references that are right.
    withheld: u64,
}

impl Outside {
    fn new(part: RasterDesign<'_>) -> Self {
        Self {
            queue: Queue::default(),
            nothing: vec![0; part.pixels_per_clock() as usize],
            taken: 0,
            withheld: (FRAMES - 1) * RasterTiming::of(part).words() - 1,
        }
    }

    /// What is at the ports of references at the next edge, and whether the core takes it.
    fn show(&mut self, reset: bool, is_asked: bool) -> (bool, Vec<u16>) {
        if reset {
            self.queue.forget();
            self.taken = 0;
        }
        let word = self.queue.oldest().map(<[u16]>::to_vec);
        let is_valid = word.is_some() && !(is_asked && self.taken == self.withheld);
        if is_asked && !reset {
            self.queue.pop();
            self.taken += 1;
        }
        (is_valid, word.unwrap_or_else(|| self.nothing.clone()))
    }
}
