// SPDX-License-Identifier: MIT OR Apache-2.0
//! A recording under way: draws the frames of each sequence and streams them.

use super::super::damage::{Damaged, Delivery, Directed, Stop, directed};
use super::super::motif::{Artist, TELLING};
use super::super::random::Random;
use super::super::sequence::{End, Gaps, PipelinedAim, SEQUENCES, Sequence};
use super::super::turns::{Extent, Turns};
use super::driver::Driver;
use crate::error::CosimError;
use crate::level::Level;
use foveate_design::{PipelinedDesign, PipelinedTiming};
use foveate_frame::Frame;
use foveate_model::{region_border, region_stream};

/// A recording under way.
pub(super) struct Session<'a> {
    design: PipelinedDesign<'a>,
    timing: PipelinedTiming,
    level: Level,
    driver: Driver<'a>,
    random: Random,
    artists: Vec<Artist>,
    /// Clocks after which everything that does not wait for another frame has settled.
    drain: u64,
}

impl<'a> Session<'a> {
    pub(super) fn new(
        design: PipelinedDesign<'a>,
        timing: PipelinedTiming,
        level: Level,
        driver: Driver<'a>,
        mut random: Random,
    ) -> Self {
        // At RPU level a square with its halo is drawn, in an array the frame.
        let (squares, side) = match level {
            Level::Rpu => (1, design.stream_side()),
            Level::Rcm { .. } | Level::Full => (design.regions(), design.region_size()),
        };
        let artists = (0..squares).map(|_| Artist::new(&design, side, random.fork())).collect();
        let drain = u64::from(timing.decision_latency) + 4;
        Self { design, timing, level, driver, random, artists, drain }
    }

    pub(super) fn run(
        &mut self,
        extent: Extent,
        frames: &[Frame],
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), CosimError> {
        let regions = match self.level {
            Level::Rpu => self.design.regions(),
            Level::Rcm { .. } | Level::Full => 1,
        };
        let with_frames = if frames.is_empty() { 0 } else { regions };
        let given = |session: &mut Self, _, region| session.given(region, frames);
        let directed = &directed(SEQUENCES, self.driver.finds_frames());
        let turns = Turns { extent, directed, given: (0..with_frames).collect() };
        let play = |session: &mut Self, sequence: &Directed<Sequence>, round, number| match sequence
        {
            Directed::Usual(sequence) => session.directed(sequence, round, number),
            Directed::Damaged(sequence) => session.damaged(sequence, round, number),
        };
        turns.record(self, play, given, progress)
    }

    /// A damaged stream.
    fn damaged(
        &mut self,
        sequence: &Damaged,
        round: usize,
        number: usize,
    ) -> Result<(), CosimError> {
        let gaps = Gaps::ALL[(round + number) % Gaps::ALL.len()];
        self.driver.name(sequence.name, 0, None);
        self.driver.begin(PipelinedAim::Design, 0)?;
        for (frame, &delivery) in sequence.deliveries.iter().enumerate() {
            if frame > 0 {
                self.driver.name(sequence.name, frame as u64, None);
                let pause = gaps.between_frames(self.drain, &mut self.random);
                self.driver.idle(pause)?;
            }
            for (region, artist) in self.artists.iter_mut().enumerate() {
                artist.draw_near_minimum(TELLING[(frame + round + region) % TELLING.len()]);
            }
            let streams = self.drawn_streams()?;
            self.driver.deliver(&streams, delivery, gaps)?;
        }
        let streams = self.drawn_streams()?;
        match sequence.stop {
            Stop::Drained => self.drain(&streams, gaps),
            Stop::AtOnce => Ok(()),
            Stop::Filling => {
                self.driver.deliver(&streams, Delivery::FIRST, gaps)?;
                let clocks = self.random.up_to(2);
                self.driver.idle(clocks)
            }
        }
    }

    /// One directed sequence. Gaps differ from sequence to sequence and from round to round.
    fn directed(
        &mut self,
        sequence: &Sequence,
        round: usize,
        number: usize,
    ) -> Result<(), CosimError> {
        let gaps = Gaps::ALL[(round + number) % Gaps::ALL.len()];
        let border = u8::try_from(self.random.up_to(15)).expect("four bits");
        self.driver.name(sequence.name, 0, None);
        self.driver.begin(sequence.thresholds, border)?;
        let configured = self.driver.thresholds_are_configured();
        let last = sequence.motifs.len() - 1;
        for frame in 0..=last {
            let before = self.aim_square().to_vec();
            for (region, artist) in self.artists.iter_mut().enumerate() {
                let motif = sequence.motifs[(frame + region) % sequence.motifs.len()];
                if configured && self.random.one_in(2) {
                    artist.draw_near_minimum(motif);
                } else {
                    artist.draw(motif);
                }
            }
            let now = self.aim_square().to_vec();
            if frame > 0 {
                self.driver.name(sequence.name, frame as u64, None);
            }
            self.driver.aim_levels(&now, &before);
            let streams = self.drawn_streams()?;
            let cut = match (sequence.end, frame == last) {
                (End::InFrame, true) => self.random.up_to(u64::from(self.design.stream_pixels())),
                _ => u64::MAX,
            };
            self.driver.stream(&streams, usize::try_from(cut).expect("less than a frame"), gaps)?;
            if frame < last {
                let pause = gaps.between_frames(self.drain, &mut self.random);
                self.driver.idle(pause)?;
            }
        }
        match sequence.end {
            End::InFrame => Ok(()),
            End::InFlush => {
                let clocks = self.random.up_to(self.drain);
                self.driver.idle(clocks)
            }
            End::Drained => {
                let streams = self.drawn_streams()?;
                self.drain(&streams, gaps)
            }
        }
    }

    /// The caller's frames, through one RPU or through the array.
    fn given(&mut self, region: u32, frames: &[Frame]) -> Result<(), CosimError> {
        let gaps = Gaps::ALL[region as usize % Gaps::ALL.len()];
        let (border, name) = match self.level {
            Level::Rpu => (region_border(&self.design, region), Some(region)),
            Level::Rcm { .. } | Level::Full => (0, None),
        };
        self.driver.name("frames", 0, name);
        self.driver.begin(PipelinedAim::Design, border)?;
        let mut streams = Vec::new();
        for (number, frame) in (0..).zip(frames) {
            if number > 0 {
                self.driver.name("frames", number, name);
                let pause = gaps.between_frames(self.drain, &mut self.random);
                self.driver.idle(pause)?;
            }
            streams.clear();
            match self.level {
                Level::Rpu => region_stream(&self.design, frame, region, &mut streams),
                Level::Rcm { .. } | Level::Full => self.array_streams(frame, &mut streams)?,
            }
            self.driver.stream(&streams, usize::MAX, gaps)?;
        }
        self.drain(&streams, gaps)
    }

    /// Lets everything leave: silence, then the last frame again, as often as forwarding needs it.
    fn drain(&mut self, streams: &[u16], gaps: Gaps) -> Result<(), CosimError> {
        for _ in 0..self.timing.forward_frames {
            let pause = self.random.up_to(self.drain);
            self.driver.idle(pause)?;
            self.driver.stream(streams, usize::MAX, gaps)?;
        }
        self.driver.idle(self.drain)
    }

    /// The square at whose pixels levels are aimed.
    fn aim_square(&mut self) -> &[u16] {
        &self.artists[0].pixels
    }

    /// What the artists have drawn, as one stream per lane.
    fn drawn_streams(&mut self) -> Result<Vec<u16>, CosimError> {
        let design = self.design;
        if self.level == Level::Rpu {
            return Ok(self.artists[0].pixels.clone());
        }
        let (n, columns) = (design.region_size(), design.columns());
        let frame = Frame::from_fn(design.width(), design.height(), design.pixel_bits(), |x, y| {
            let artist = &self.artists[(y / n * columns + x / n) as usize];
            artist.pixels[(y % n * n + x % n) as usize]
        });
        let frame = frame.map_err(|error| CosimError::Model { reason: error.to_string() })?;
        let mut streams = Vec::new();
        self.array_streams(&frame, &mut streams)?;
        Ok(streams)
    }

    /// A frame as one stream per lane. A grid that is smaller than the frame shows its upper left.
    fn array_streams(&self, frame: &Frame, streams: &mut Vec<u16>) -> Result<(), CosimError> {
        let (width, height) = (self.design.width(), self.design.height());
        let part =
            Frame::from_fn(width, height, frame.bits(), |x, y| frame.clamped(x.into(), y.into()));
        let part = part.map_err(|error| CosimError::Model { reason: error.to_string() })?;
        for region in 0..self.design.regions() {
            region_stream(&self.design, &part, region, streams);
        }
        Ok(())
    }
}
