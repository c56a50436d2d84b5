// SPDX-License-Identifier: MIT OR Apache-2.0
//! The model ([`TimedModel`]): it searches the deliveries of a source for frames, by the rules
//! of `docs/sync.md` ([`StreamState`]), and gives them to the core behind it.

use super::delivery::NEVER;
use super::transaction::KeptPixels;
use crate::clocks::FrameClocks;
use crate::timed_core::{CoreContext, CoreFrame, TimedCore};
use crate::{BeatOffer, CoreTiming, FrameDelivery, Sink, TimedError, Transaction};
use foveate_design::Design;
use foveate_engine::{Engine, EngineOptions};
use foveate_pixels::FramePixels;

/// A design with its state between two deliveries. A new one is in the state after a reset, and the
/// first edge has number 0.
#[derive(Debug)]
pub struct TimedModel {
    engine: Engine,
    core: Box<dyn TimedCore>,
    sink: Box<dyn Sink>,
    /// The number of beats of a frame.
    beats: u64,
    has_frame_sync: bool,
    state: StreamState,
    /// The first edge at which the next beat of the source can come, because of those before it.
    next_beat: u64,
}

impl TimedModel {
    /// Makes the array or core of the design, in front of a sink.
    #[must_use]
    pub fn new(design: &Design, sink: Box<dyn Sink>) -> Self {
        Self::with_timing(design, CoreTiming::from_design(design), sink)
    }

    /// Makes the array or core with an engine of these options, which do not change what the model
    /// yields.
    ///
    /// # Errors
    /// Fails as [`Engine::with_options`] does.
    pub fn with_options(
        design: &Design,
        options: EngineOptions,
        sink: Box<dyn Sink>,
    ) -> Result<Self, TimedError> {
        let engine = Engine::with_options(design, options)?;
        Ok(Self { engine, ..Self::new(design, sink) })
    }

    /// Makes a model with the values of a design and with another timing. Tests plant faults with
    /// it.
    #[doc(hidden)]
    #[must_use]
    pub fn with_timing(design: &Design, timing: CoreTiming, sink: Box<dyn Sink>) -> Self {
        Self {
            engine: Engine::new(design),
            core: timing.core(design),
            sink,
            beats: design.timing().pixels_per_frame(),
            has_frame_sync: design.has_frame_sync(),
            state: StreamState::Seek { idle_from: 0 },
            next_beat: 0,
        }
    }

    /// Returns the first edge at which the core can take the first beat of the next delivery.
    #[must_use]
    pub fn next_edge(&self) -> u64 {
        self.core.open_from().max(self.next_beat)
    }

    /// Takes the next delivery, and yields the transactions that are certain then, whatever
    /// follows. The others come with later deliveries, or with [`TimedModel::finish`].
    ///
    /// # Errors
    /// Fails if the delivery is not possible. The state is unchanged then.
    pub fn step(
        &mut self,
        delivery: &FrameDelivery<'_>,
        visit: &mut dyn FnMut(&Transaction<'_>),
    ) -> Result<(), TimedError> {
        self.check_delivery(delivery)?;
        let end = delivery.reset.unwrap_or(NEVER).min(NEVER);
        let rest = self.take_beats(delivery, end, visit);
        self.drop_beats(delivery, rest, end, visit);
        if delivery.reset.is_some() {
            self.reset(end, visit);
        }
        Ok(())
    }

    /// Yields the transactions that still come if no other delivery follows.
    pub fn finish(mut self, visit: &mut dyn FnMut(&Transaction<'_>)) {
        self.finish_until(NEVER, visit);
    }

    fn finish_until(&mut self, end: u64, visit: &mut dyn FnMut(&Transaction<'_>)) {
        let state = std::mem::replace(&mut self.state, StreamState::Start);
        if let StreamState::Inside(mut frame) = state {
            // The beats that the source does not deliver never come.
            frame.delay_next(NEVER);
            self.take_frame(frame.pixels(), &frame.offers, end, visit);
        }
        let mut context = CoreContext { engine: &mut self.engine, sink: &mut *self.sink, visit };
        self.core.finish(end, &mut context);
    }

    /// Applies a reset at edge `edge`.
    fn reset(&mut self, edge: u64, visit: &mut dyn FnMut(&Transaction<'_>)) {
        self.finish_until(edge, visit);
        self.engine.reset();
        self.core.reset(edge);
        self.state = StreamState::Seek { idle_from: 0 };
        self.next_beat = edge + 1;
    }

    /// Lets the core take as many beats of a delivery as fit. Returns the number of the first beat
    /// that is dropped.
    fn take_beats(
        &mut self,
        delivery: &FrameDelivery<'_>,
        end: u64,
        visit: &mut dyn FnMut(&Transaction<'_>),
    ) -> u64 {
        let given = self.given_beats(delivery);
        let starts = delivery.is_marked || !self.has_frame_sync;
        let offers = self.delayed_offers(delivery.offers);
        match std::mem::replace(&mut self.state, StreamState::Start) {
            StreamState::Inside(frame) if starts => {
                self.complete_frame(frame, &offers, end, visit);
                1
            }
            StreamState::Inside(mut frame) => {
                let beats = given.min(self.beats - frame.beats);
                frame.append(&offers, beats);
                self.continue_frame(frame, end, visit);
                beats
            }
            StreamState::Seek { idle_from } if !starts || offers[0].clock < idle_from => {
                self.state = StreamState::Seek { idle_from };
                0
            }
            StreamState::Start if !starts => 0,
            StreamState::Seek { .. } | StreamState::Start if given < self.beats => {
                let frame = UnfinishedFrame::new(delivery.pixels, &offers, given);
                self.continue_frame(frame, end, visit);
                given
            }
            StreamState::Seek { .. } | StreamState::Start => {
                let own = offers.partition_point(|offer| offer.beat < self.beats);
                self.take_frame(delivery.pixels, &offers[..own], end, visit);
                self.beats
            }
        }
    }

    /// Lets the core complete a frame, because the first beat of these offers is that of another.
    fn complete_frame(
        &mut self,
        mut frame: UnfinishedFrame,
        offers: &[BeatOffer],
        end: u64,
        visit: &mut dyn FnMut(&Transaction<'_>),
    ) {
        frame.delay_next(offers[0].clock);
        let error = self.core.take_edge(&frame.offers, frame.beats);
        if error < end {
            visit(&Transaction::SyncError { clock: error });
        }
        frame.delay_next(error + 1);
        let last = self.core.take_edge(&frame.offers, self.beats - 1);
        let idle_from = if self.core.has_ready_output() { 0 } else { last + 1 };
        self.state = StreamState::Seek { idle_from };
        // The beats and resets that follow do not wait until the frame is complete.
        self.next_beat = error + 1;
        self.give_frame(frame.pixels(), &frame.offers, end, visit);
    }

    /// Takes a frame if all of its beats were delivered, and else keeps it.
    fn continue_frame(
        &mut self,
        frame: UnfinishedFrame,
        end: u64,
        visit: &mut dyn FnMut(&Transaction<'_>),
    ) {
        if frame.beats == self.beats {
            self.take_frame(frame.pixels(), &frame.offers, end, visit);
            return;
        }
        self.next_beat = self.core.take_edge(&frame.offers, frame.beats - 1) + 1;
        self.state = StreamState::Inside(frame);
    }

    fn take_frame(
        &mut self,
        pixels: FramePixels<'_>,
        offers: &[BeatOffer],
        end: u64,
        visit: &mut dyn FnMut(&Transaction<'_>),
    ) {
        self.next_beat = self.core.take_edge(offers, self.beats - 1) + 1;
        self.give_frame(pixels, offers, end, visit);
    }

    /// Gives the core a frame, after which the next beat can come at `next_beat`.
    fn give_frame(
        &mut self,
        pixels: FramePixels<'_>,
        offers: &[BeatOffer],
        end: u64,
        visit: &mut dyn FnMut(&Transaction<'_>),
    ) {
        let frame = CoreFrame { pixels, offers, next: self.next_beat };
        let mut context = CoreContext { engine: &mut self.engine, sink: &mut *self.sink, visit };
        self.core.take_frame(frame, end, &mut context);
    }

    /// Drops the beats of a delivery from number `first` on, as they come.
    fn drop_beats(
        &mut self,
        delivery: &FrameDelivery<'_>,
        first: u64,
        end: u64,
        visit: &mut dyn FnMut(&Transaction<'_>),
    ) {
        let Some(last) = (self.given_beats(delivery) - 1).checked_sub(first) else { return };
        let offers = delivery.offers.iter().filter(|offer| offer.beat >= first);
        let offers = offers.map(|offer| (offer.beat - first, offer.clock));
        let clocks = FrameClocks::new(self.next_edge(), offers);
        match self.state {
            StreamState::Start => {
                if clocks.edge(0) < end {
                    visit(&Transaction::SyncError { clock: clocks.edge(0) });
                }
                self.state = StreamState::Seek { idle_from: 0 };
            }
            StreamState::Seek { .. } | StreamState::Inside(_) => {}
        }
        self.next_beat = clocks.edge(last) + 1;
    }

    fn given_beats(&self, delivery: &FrameDelivery<'_>) -> u64 {
        delivery.beats.unwrap_or(self.beats)
    }

    /// Returns the pauses of a delivery. Its first beat comes after all beats of those before.
    fn delayed_offers(&self, offers: &[BeatOffer]) -> Vec<BeatOffer> {
        let first = offers.first().filter(|offer| offer.beat == 0).map_or(0, |offer| offer.clock);
        let first = BeatOffer { beat: 0, clock: self.next_beat.max(first) };
        std::iter::once(first).chain(offers.iter().copied()).collect()
    }

    /// Checks that a delivery is possible.
    pub(crate) fn check_delivery(&self, delivery: &FrameDelivery<'_>) -> Result<(), TimedError> {
        self.engine.check_pixels(delivery.pixels)?;
        let (given, expected) = (self.given_beats(delivery), self.beats);
        if given == 0 {
            return Err(TimedError::NoBeats);
        }
        if given != expected && !self.has_frame_sync {
            return Err(TimedError::Beats { given, expected });
        }
        if let Some(pair) = delivery.offers.windows(2).find(|pair| pair[0].beat > pair[1].beat) {
            return Err(TimedError::OfferOrder { beat: pair[1].beat, before: pair[0].beat });
        }
        let earliest = self.next_edge();
        match delivery.reset {
            Some(reset) if reset < earliest => Err(TimedError::EarlyReset { reset, earliest }),
            Some(_) | None => Ok(()),
        }
    }
}

/// The position of the stream between two deliveries.
#[derive(Debug)]
pub(crate) enum StreamState {
    /// No frame is under way. The core completes no frame from edge `idle_from` on.
    Seek {
        /// The first edge at which a beat that comes is not dropped because the core completes a
        /// frame.
        idle_from: u64,
    },
    /// A frame has just received its last beat.
    Start,
    /// A frame is under way, and the source has not delivered all of its beats.
    Inside(UnfinishedFrame),
}

/// A frame of which some beats were delivered.
#[derive(Debug)]
pub(crate) struct UnfinishedFrame {
    /// The pixels of the whole frame.
    pixels: KeptPixels,
    /// The pauses before its beats.
    pub(crate) offers: Vec<BeatOffer>,
    /// The number of beats that were delivered.
    pub(crate) beats: u64,
}

impl UnfinishedFrame {
    /// Makes a frame whose first `beats` beats are delivered with these pauses.
    pub(crate) fn new(pixels: FramePixels<'_>, offers: &[BeatOffer], beats: u64) -> Self {
        let mut frame = Self { pixels: KeptPixels::copy_of(pixels), offers: Vec::new(), beats: 0 };
        frame.append(offers, beats);
        frame
    }

    pub(crate) fn pixels(&self) -> FramePixels<'_> {
        self.pixels.borrow()
    }

    /// Appends the first `beats` beats of another delivery, with their pauses.
    pub(crate) fn append(&mut self, offers: &[BeatOffer], beats: u64) {
        let own = offers.iter().take_while(|offer| offer.beat < beats);
        let start = self.beats;
        self.offers.extend(own.map(|offer| BeatOffer { beat: start + offer.beat, ..*offer }));
        self.beats += beats;
    }

    /// Lets the next beat come not before an edge.
    pub(crate) fn delay_next(&mut self, clock: u64) {
        self.offers.push(BeatOffer { beat: self.beats, clock });
    }
}
