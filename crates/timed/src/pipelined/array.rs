// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stages of an RPU, by the edges at which they step.

use foveate_design::{Design, PipelinedTiming};

use super::tail::Tail;
use super::window::Window;
use crate::BeatOffer;
use crate::clocks::FrameClocks;
use crate::timed_core::{CoreContext, CoreFrame, TimedCore};

/// All RPUs of a pipelined array. They step at the same edges.
#[derive(Debug)]
pub(crate) struct PipelinedCore {
    /// The pixels of the stream of a region.
    stream_pixels: u64,
    /// The windows in the order of the stages, each with the clocks from its step to that of the
    /// next stage.
    windows: Vec<(Window, u64)>,
    /// The clocks from the pixel port to the tail if there is no window.
    tail_delay: u64,
    /// The edges of tail steps that a reset could still prevent.
    later_steps: Vec<u64>,
    tail: Tail,
}

impl PipelinedCore {
    pub(crate) fn new(design: &Design, timing: PipelinedTiming) -> Self {
        let neighborhood = design.neighborhood();
        let mut windows = Vec::new();
        if design.filter().has_window() {
            let filter_window = Window::new(neighborhood, design.stream_side());
            windows.push((filter_window, u64::from(timing.filter_registers)));
        }
        if design.has_feature_window() {
            windows.push((Window::new(neighborhood, design.denoised_side()), 0));
        }
        Self {
            stream_pixels: design.stream_pixels().into(),
            windows,
            tail_delay: timing.tail_delay.into(),
            later_steps: Vec::new(),
            tail: Tail::new(
                timing,
                design.regions(),
                design.region_pixels(),
                design.periphery().copied(),
            ),
        }
    }

    /// Lets pixels at these edges, and with `flushes` nothing after them, pass all stages. Yields
    /// the transactions before edge `end`.
    fn pass_stages(
        &mut self,
        mut edges: Vec<u64>,
        flushes: bool,
        end: u64,
        context: &mut CoreContext<'_>,
    ) {
        for (window, delay) in &mut self.windows {
            let mut steps = Vec::with_capacity(edges.len() + 1);
            edges.iter().for_each(|&edge| window.take(edge, &mut steps));
            if flushes {
                window.flush(&mut steps);
            }
            steps.iter_mut().for_each(|step| *step += *delay);
            edges = steps;
        }
        self.later_steps.extend(edges.into_iter().map(|edge| edge + self.tail_delay));
        let certain = self.later_steps.partition_point(|&edge| edge < end);
        self.tail.step(self.later_steps.drain(..certain), context);
    }
}

impl TimedCore for PipelinedCore {
    fn open_from(&self) -> u64 {
        0
    }

    fn has_ready_output(&self) -> bool {
        false
    }

    fn take_edge(&self, offers: &[BeatOffer], beat: u64) -> u64 {
        clocks(offers).edge(beat)
    }

    fn take_frame(&mut self, frame: CoreFrame<'_>, end: u64, context: &mut CoreContext<'_>) {
        self.tail.push_frame(frame.pixels);
        let clocks = clocks(frame.offers);
        let edges: Vec<u64> =
            clocks.edges(self.stream_pixels).take_while(|&edge| edge < end).collect();
        self.pass_stages(edges, false, end.min(frame.next), context);
    }

    fn finish(&mut self, end: u64, context: &mut CoreContext<'_>) {
        self.pass_stages(Vec::new(), true, end, context);
        self.tail.send_run(context);
    }

    fn reset(&mut self, _edge: u64) {
        self.windows.iter_mut().for_each(|(window, _)| window.reset());
        self.later_steps.clear();
        self.tail.reset();
    }
}

/// Returns the edges of a frame, which an RPU takes as the source offers it.
fn clocks(offers: &[BeatOffer]) -> FrameClocks {
    FrameClocks::new(0, offers.iter().map(|offer| (offer.beat, offer.clock)))
}
