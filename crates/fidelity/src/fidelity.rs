// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison of a candidate with the ideal, frame by frame.

use foveate_camera::Camera;
use foveate_engine::FrameOutcome;
use foveate_frame::{Plane, Raster};
use foveate_ideal::IdealOutcome;

use crate::areas::{EMPTY, state};
use crate::overlap::Cells;
use crate::picture::Comparison;
use crate::planes::Planes;
use crate::sample::Sample;
use crate::scores::Pair;
use crate::stale::Watch;
use crate::{ErrorTally, FidelityError};

/// A comparison over the frames of one clip. It allocates memory with the first frame.
#[derive(Clone, Debug)]
pub struct Fidelity {
    ideal: Camera,
    candidate: Camera,
    cells: Cells,
    pairs: Vec<Pair>,
    /// The decisions of the ideal and of the candidate.
    states: [Vec<u8>; 2],
    eye: Eye,
    tally: ErrorTally,
}

/// The comparison of pixels, in the type that the ideal's pixels need.
#[derive(Clone, Debug)]
enum Eye {
    Bytes(Sight<u8>),
    Words(Sight<u16>),
}

#[derive(Clone, Debug)]
struct Sight<T: Sample> {
    planes: Planes<T>,
    comparison: Comparison<T>,
    watch: Watch<T>,
}

impl Fidelity {
    /// Creates a comparison of the results of `candidate` with those of `ideal`. The cameras may
    /// differ in everything but the size of a frame.
    ///
    /// # Errors
    /// Fails if the sizes differ.
    pub fn new(ideal: &Camera, candidate: &Camera) -> Result<Self, FidelityError> {
        let size = |camera: &Camera| (camera.width(), camera.height());
        if size(ideal) != size(candidate) {
            let name = |camera: &Camera| format!("{}x{}", camera.width(), camera.height());
            return Err(FidelityError::FrameSize {
                ideal: name(ideal),
                candidate: name(candidate),
            });
        }
        let pairs = Pair::all(ideal, candidate);
        let tally = ErrorTally {
            peak: ideal.pixel_max(),
            scores: pairs.iter().map(Pair::tally).collect(),
            ..ErrorTally::default()
        };
        Ok(Self {
            cells: Cells::new(ideal, candidate),
            pairs,
            states: [Vec::new(), Vec::new()],
            eye: match ideal.pixel_bits() <= 8 {
                true => Eye::Bytes(Sight::new(ideal, candidate)),
                false => Eye::Words(Sight::new(ideal, candidate)),
            },
            tally,
            ideal: ideal.clone(),
            candidate: candidate.clone(),
        })
    }

    /// Adds one frame: the input of the ideal camera, the ideal camera's outcome, the outcome of
    /// the candidate's engine, and the candidate's screen after it.
    ///
    /// # Errors
    /// Fails if something does not have the size or depth of its camera; nothing has been added
    /// then.
    pub fn add(
        &mut self,
        input: &Raster,
        ideal: &IdealOutcome,
        candidate: &FrameOutcome,
        screen: Plane<'_>,
    ) -> Result<(), FidelityError> {
        self.check(input, ideal, candidate, screen)?;
        let Self { pairs, eye, tally, .. } = self;
        for (pair, tally) in pairs.iter().zip(&mut tally.scores) {
            pair.add(ideal, candidate, tally);
        }
        match eye {
            Eye::Bytes(sight) => sight.look(input, ideal, screen, tally),
            Eye::Words(sight) => sight.look(input, ideal, screen, tally),
        }
        self.decisions(ideal, candidate);
        self.tally.frames += 1;
        self.tally.pixels += u64::from(self.ideal.width()) * u64::from(self.ideal.height());
        Ok(())
    }

    /// Declares that the next frame is the first of another clip with frames of this size, so that
    /// no region has been stale before it.
    pub fn next_clip(&mut self) {
        match &mut self.eye {
            Eye::Bytes(sight) => sight.watch.end(),
            Eye::Words(sight) => sight.watch.end(),
        }
    }

    /// Returns the sums so far.
    #[must_use]
    pub fn tally(&self) -> &ErrorTally {
        &self.tally
    }

    /// Returns the sums, and ends the comparison.
    #[must_use]
    pub fn into_tally(self) -> ErrorTally {
        self.tally
    }

    fn decisions(&mut self, ideal: &IdealOutcome, candidate: &FrameOutcome) {
        let Self { cells, states: [own, other], tally, .. } = self;
        own.clear();
        own.extend(
            (0..ideal.srs.len()).map(|at| state(ideal.srs[at], ideal.trs[at], ideal.actions[at])),
        );
        other.clear();
        other.extend(
            (0..candidate.srs.len())
                .map(|at| state(candidate.srs[at], candidate.trs[at], candidate.actions[at])),
        );
        let mut table = EMPTY;
        cells.count(own, other, &mut table);
        tally.areas.count(&table);
    }

    fn check(
        &self,
        input: &Raster,
        ideal: &IdealOutcome,
        candidate: &FrameOutcome,
        screen: Plane<'_>,
    ) -> Result<(), FidelityError> {
        let expected = (self.ideal.width(), self.ideal.height(), self.ideal.pixel_bits());
        let given = (input.width(), input.height(), input.bits());
        if given != expected {
            let kind = |(width, height, bits)| format!("{width}x{height} pixels of {bits} bits");
            return Err(FidelityError::FrameKind { given: kind(given), expected: kind(expected) });
        }
        let bits = self.candidate.pixel_bits();
        let (len, name) = match screen {
            Plane::Bytes(pixels) => (pixels.len(), "u8"),
            Plane::Words(pixels) => (pixels.len(), "u16"),
        };
        let needed = if bits <= 8 { "u8" } else { "u16" };
        if name != needed {
            return Err(FidelityError::LaneWidth { bits, expected: needed, given: name });
        }
        let pixels = self.ideal.width() as usize * self.ideal.height() as usize;
        let camera = &self.ideal;
        let regions = camera.regions() as usize;
        same("ideal, srs", ideal.srs.len(), regions)?;
        same("ideal, trs", ideal.trs.len(), regions)?;
        same("ideal, actions", ideal.actions.len(), regions)?;
        same("ideal, changed pixels", ideal.changed.len(), regions)?;
        same("ideal, features", ideal.scores.len(), camera.features().len())?;
        each("ideal, scores", ideal.scores.iter().map(Vec::len), regions)?;
        same("ideal, denoised pixels", ideal.denoised.len(), pixels)?;
        same("ideal, rendered pixels", ideal.rendered.len(), pixels)?;
        let camera = &self.candidate;
        let regions = camera.regions() as usize;
        same("candidate, srs", candidate.srs.len(), regions)?;
        same("candidate, trs", candidate.trs.len(), regions)?;
        same("candidate, actions", candidate.actions.len(), regions)?;
        same("candidate, changed pixels", candidate.temporal_count.len(), regions)?;
        same("candidate, features", candidate.scores.len(), camera.features().len())?;
        each("candidate, scores", candidate.scores.iter().map(Vec::len), regions)?;
        same("candidate, pixels of the screen", len, pixels)
    }
}

fn same(what: &'static str, given: usize, expected: usize) -> Result<(), FidelityError> {
    if given == expected {
        return Ok(());
    }
    Err(FidelityError::Length { what, given, expected })
}

fn each(
    what: &'static str,
    mut given: impl Iterator<Item = usize>,
    expected: usize,
) -> Result<(), FidelityError> {
    given.try_for_each(|given| same(what, given, expected))
}

impl<T: Sample> Sight<T> {
    fn new(ideal: &Camera, candidate: &Camera) -> Self {
        let (width, height) = (ideal.width() as usize, ideal.height() as usize);
        Self {
            planes: Planes::new(ideal, candidate),
            comparison: Comparison::new(width, height, ideal.pixel_max()),
            watch: Watch::new(ideal),
        }
    }

    fn look(
        &mut self,
        input: &Raster,
        ideal: &IdealOutcome,
        screen: Plane<'_>,
        tally: &mut ErrorTally,
    ) {
        // The types have been checked, so this always succeeds.
        let Some(pictures) = self.planes.take(input.plane(), ideal, screen) else { return };
        let [to_ideal, to_input] = self.comparison.compare(pictures);
        tally.to_ideal.add(&to_ideal);
        tally.to_input.add(&to_input);
        self.watch.look(&ideal.srs, pictures.denoised, pictures.screen, &mut tally.stale);
    }
}
