// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle models, and the events on their ports.

use foveate_design::{Design, Hardware, PixelFeed};
use foveate_model::{CoreInput, PipelinedRcm, RasterRcm, SerialRcm};

use crate::event::{CoreEvent, PortEvent};

/// A cycle model that is watched.
pub(crate) enum ObservedCore {
    Pipelined(Box<ObservedPipelined>),
    Serial(Box<ObservedSerial>),
    Raster(Box<ObservedRaster>),
}

impl ObservedCore {
    pub(crate) fn new(design: &Design) -> Self {
        match design.hardware() {
            Hardware::Pipelined(own) => Self::Pipelined(Box::new(ObservedPipelined {
                model: PipelinedRcm::new(design.with_hardware(own)),
                design: design.clone(),
                sent: vec![0; design.regions() as usize],
            })),
            Hardware::Serial(own) => Self::Serial(Box::new(ObservedSerial {
                model: SerialRcm::new(design.with_hardware(own)),
                design: design.clone(),
            })),
            Hardware::Raster(_) => Self::Raster(Box::new(ObservedRaster::new(design))),
        }
    }

    /// Returns true if the core takes a beat at the next edge, or if it does not say so.
    pub(crate) fn is_ready(&self) -> bool {
        match self {
            Self::Pipelined(_) => true,
            Self::Serial(core) => core.model.output().ready,
            Self::Raster(core) => core.model.output().ready,
        }
    }

    /// Applies edge `clock`, and appends the events after it.
    pub(crate) fn clock(&mut self, input: &CoreInput<'_>, clock: u64, events: &mut Vec<PortEvent>) {
        let mut push = |event| events.push(PortEvent { clock, event });
        match self {
            Self::Pipelined(core) => core.clock(input, &mut push),
            Self::Serial(core) => core.clock(input, &mut push),
            Self::Raster(core) => core.clock(input, &mut push),
        }
    }
}

/// An array of RPUs.
pub(crate) struct ObservedPipelined {
    design: Design,
    model: PipelinedRcm,
    /// The number of words that each region has sent of its current frame.
    sent: Vec<u32>,
}

impl ObservedPipelined {
    fn clock(&mut self, input: &CoreInput<'_>, push: &mut impl FnMut(CoreEvent)) {
        let features = self.design.features().len();
        let shown = self.model.step(input);
        let decides = shown[0].decision_valid;
        for (region, (shown, sent)) in (0..).zip(shown.iter().zip(&mut self.sent)) {
            if shown.forward_valid {
                let (words, is_mean) = (self.design.region_pixels(), *sent >= MEANS);
                let last = if is_mean { MEANS + means(&self.design) } else { words } - 1;
                push(CoreEvent::Word {
                    region,
                    frame: 0,
                    number: *sent % MEANS,
                    is_mean,
                    values: vec![shown.forward_pixel],
                    is_last: *sent == last,
                    is_aborted: false,
                });
                *sent += 1;
            }
            if decides {
                // With `mad`, the frame that is decided leaves only now.
                *sent = if shown.summary { MEANS } else { 0 };
                push(CoreEvent::Decision {
                    region,
                    relevance: [shown.srs, shown.trs],
                    summary: shown.summary,
                    scores: shown.scores[..features].to_vec(),
                    count: shown.temporal_count,
                });
            }
        }
        if self.model.sync_error() {
            push(CoreEvent::SyncError);
        }
    }
}

/// A number that is added to the numbers of means, to tell them from those of pixels.
const MEANS: u32 = 1 << 20;

/// Returns the number of means of a summary.
fn means(design: &Design) -> u32 {
    design.periphery().map_or(0, |periphery| periphery.mean_count())
}

/// A serial array.
pub(crate) struct ObservedSerial {
    design: Design,
    model: SerialRcm,
}

impl ObservedSerial {
    fn clock(&mut self, input: &CoreInput<'_>, push: &mut impl FnMut(CoreEvent)) {
        let design = self.design.as_serial().unwrap();
        let shown = self.model.step(input).clone();
        if shown.sync_error {
            push(CoreEvent::SyncError);
        }
        if shown.score_valid {
            push(CoreEvent::Score {
                region: shown.region,
                number: shown.score_index,
                value: shown.score,
            });
        }
        if shown.decision_valid {
            push(CoreEvent::SerialDecision {
                region: shown.region,
                relevance: [shown.srs, shown.trs],
                summary: shown.summary,
            });
        }
        for (port, &value) in shown.forward_pixel.iter().enumerate() {
            if !shown.forward_valid[port] {
                continue;
            }
            let region = match design.feed() {
                PixelFeed::Parallel => port as u32 * design.fold() + shown.forward_slot,
                PixelFeed::Raster => shown.forward_region,
            };
            push(CoreEvent::SerialWord { region, position: shown.forward_position, value });
        }
    }
}

/// A raster core with its external store, if it has one.
pub(crate) struct ObservedRaster {
    design: Design,
    model: RasterRcm,
    /// The words that the core has stored and not taken back.
    store: std::collections::VecDeque<Vec<u16>>,
    word: usize,
}

impl ObservedRaster {
    fn new(design: &Design) -> Self {
        let raster = design.as_raster().unwrap();
        Self {
            design: design.clone(),
            model: RasterRcm::new(raster),
            store: std::collections::VecDeque::new(),
            word: raster.pixels_per_clock() as usize,
        }
    }

    fn clock(&mut self, input: &CoreInput<'_>, push: &mut impl FnMut(CoreEvent)) {
        let before = self.model.output().clone();
        let junk = vec![0; self.word];
        let reference = if before.reference_ready && !input.reset {
            self.store.pop_front().unwrap()
        } else {
            junk
        };
        let input = CoreInput { reference_valid: true, reference_pixels: &reference, ..*input };
        let shown = self.model.step(&input);
        if input.reset {
            self.store.clear();
        }
        if shown.store_valid {
            self.store.push_back(shown.store_pixels.clone());
        }
        if shown.sync_error {
            push(CoreEvent::SyncError);
        }
        let features = self.design.features().len();
        if shown.decision_valid {
            push(CoreEvent::Decision {
                region: shown.region,
                relevance: [shown.srs, shown.trs],
                summary: shown.summary,
                scores: shown.scores[..features].to_vec(),
                count: shown.temporal_count,
            });
        }
        let is_new = !input.reset && (!before.forward_valid || input.forward_ready);
        if shown.forward_valid && is_new {
            let position = shown.forward_position;
            let (number, values) = if shown.forward_summary {
                (block(&self.design, position), shown.forward_pixels[..1].to_vec())
            } else {
                (position / self.word as u32, shown.forward_pixels.clone())
            };
            push(CoreEvent::Word {
                region: shown.forward_region,
                frame: shown.forward_frame.into(),
                number,
                is_mean: shown.forward_summary,
                values,
                is_last: shown.forward_last,
                is_aborted: shown.forward_abort,
            });
        }
        if shown.lost_valid {
            push(CoreEvent::Loss { region: shown.lost_region, frame: shown.lost_frame.into() });
        }
    }
}

/// Returns the number of the block of a region that has the pixel at a position.
fn block(design: &Design, position: u32) -> u32 {
    let (side, periphery) = (design.region_size(), design.periphery().unwrap());
    let block = |at: u32| at / periphery.block_side;
    block(position / side) * periphery.blocks + block(position % side)
}
