// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison of a candidate with the ideal, frame by frame.

use foveate_camera::Camera;
use foveate_engine::FrameOutcome;
use foveate_ideal::IdealOutcome;
use foveate_pixels::{ByteFrame, FramePixels};

use super::sample::FrameConverter;
use crate::areas::{DecisionAreas, DecisionState, FrameOrder, NO_AREAS};
use crate::overlap::GridCells;
use crate::sample::PixelSample;
use crate::scores::ScorePair;
use crate::screens::ScreenComparison;
use crate::staleness::StalenessTracker;
use crate::{ErrorTally, FidelityError};

/// A comparison over the frames of one clip. It allocates memory with the first frame.
#[derive(Clone, Debug)]
pub struct Fidelity {
    ideal: Camera,
    candidate: Camera,
    cells: GridCells,
    pairs: Vec<ScorePair>,
    /// The decisions of the ideal and of the candidate.
    states: [Vec<DecisionState>; 2],
    pixel_comparison: PixelComparison,
    tally: ErrorTally,
}

/// The results of a candidate for one frame.
#[derive(Clone, Copy, Debug)]
pub struct CandidateFrame<'a> {
    /// The outcome of the candidate's engine.
    pub outcome: &'a FrameOutcome,
    /// The candidate's screen after the frame, at its depth.
    pub screen: FramePixels<'a>,
    /// The candidate's denoised frame without padding, at its depth, in row-major order.
    pub denoised: &'a [u16],
}

/// The comparison of pixels, in the type that the ideal's pixels need.
#[derive(Clone, Debug)]
enum PixelComparison {
    Bytes(TypedPixelComparison<u8>),
    Words(TypedPixelComparison<u16>),
}

#[derive(Clone, Debug)]
struct TypedPixelComparison<T: PixelSample> {
    planes: FrameConverter<T>,
    comparison: ScreenComparison<T>,
    staleness: StalenessTracker<T>,
    own_staleness: StalenessTracker<T>,
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
        let pairs = ScorePair::comparable_pairs(ideal, candidate);
        let tally = ErrorTally {
            peak: ideal.pixel_max(),
            scores: pairs.iter().map(ScorePair::empty_tally).collect(),
            ..ErrorTally::default()
        };
        Ok(Self {
            cells: GridCells::new(ideal, candidate),
            pairs,
            states: [Vec::new(), Vec::new()],
            pixel_comparison: match ideal.pixel_bits() <= 8 {
                true => PixelComparison::Bytes(TypedPixelComparison::new(ideal, candidate)),
                false => PixelComparison::Words(TypedPixelComparison::new(ideal, candidate)),
            },
            tally,
            ideal: ideal.clone(),
            candidate: candidate.clone(),
        })
    }

    /// Adds one frame: the input of the ideal camera, the ideal camera's outcome, and the results
    /// of the candidate. Returns the areas of its decisions, which have been added, too.
    ///
    /// # Errors
    /// Fails if something does not have the size or depth of its camera; nothing has been added
    /// then.
    pub fn add(
        &mut self,
        input: &ByteFrame,
        ideal: &IdealOutcome,
        candidate: CandidateFrame<'_>,
        order: FrameOrder,
    ) -> Result<DecisionAreas, FidelityError> {
        self.check_inputs(input, ideal, candidate)?;
        let Self { pairs, pixel_comparison: comparison, tally, .. } = self;
        for (pair, tally) in pairs.iter().zip(&mut tally.scores) {
            pair.add_frame(ideal, candidate.outcome, tally);
        }
        match comparison {
            PixelComparison::Bytes(typed) => typed.compare_frame(input, ideal, candidate, tally),
            PixelComparison::Words(typed) => typed.compare_frame(input, ideal, candidate, tally),
        }
        let areas = self.decision_areas(ideal, candidate.outcome, order);
        self.tally.areas.add(&areas);
        self.tally.frames += 1;
        Ok(areas)
    }

    /// Declares that the next frame is the first of another clip with frames of this size, so that
    /// no region has been stale before it.
    pub fn next_clip(&mut self) {
        match &mut self.pixel_comparison {
            PixelComparison::Bytes(typed) => typed.end_runs(),
            PixelComparison::Words(typed) => typed.end_runs(),
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

    fn decision_areas(
        &mut self,
        ideal: &IdealOutcome,
        candidate: &FrameOutcome,
        order: FrameOrder,
    ) -> DecisionAreas {
        let Self { cells, states: [ideal_states, candidate_states], .. } = self;
        let [srs, trs] = [&ideal.srs, &ideal.trs];
        ideal_states.clear();
        ideal_states.extend(DecisionState::of_regions(srs, trs, &ideal.actions));
        let [srs, trs] = [&candidate.srs, &candidate.trs];
        candidate_states.clear();
        candidate_states.extend(DecisionState::of_regions(srs, trs, &candidate.actions));
        let (mut table, mut areas) = (NO_AREAS, DecisionAreas::default());
        cells.add_areas(ideal_states, candidate_states, &mut table);
        areas.add_table(&table, order);
        areas
    }

    fn check_inputs(
        &self,
        input: &ByteFrame,
        ideal: &IdealOutcome,
        CandidateFrame { outcome: candidate, screen, denoised }: CandidateFrame<'_>,
    ) -> Result<(), FidelityError> {
        let expected = (self.ideal.width(), self.ideal.height(), self.ideal.pixel_bits());
        let given = (input.width(), input.height(), input.bits());
        if given != expected {
            let description =
                |(width, height, bits)| format!("{width}x{height} pixels of {bits} bits");
            return Err(FidelityError::FrameFormat {
                given: description(given),
                expected: description(expected),
            });
        }
        let bits = self.candidate.pixel_bits();
        let (len, name) = match screen {
            FramePixels::Bytes(pixels) => (pixels.len(), "u8"),
            FramePixels::Words(pixels) => (pixels.len(), "u16"),
        };
        let needed = if bits <= 8 { "u8" } else { "u16" };
        if name != needed {
            return Err(FidelityError::PixelType { bits, expected: needed, given: name });
        }
        let pixels = self.ideal.width() as usize * self.ideal.height() as usize;
        let camera = &self.ideal;
        let regions = camera.regions() as usize;
        check_length("ideal, srs", ideal.srs.len(), regions)?;
        check_length("ideal, trs", ideal.trs.len(), regions)?;
        check_length("ideal, actions", ideal.actions.len(), regions)?;
        check_length("ideal, changed pixels", ideal.changed.len(), regions)?;
        check_length("ideal, features", ideal.scores.len(), camera.features().len())?;
        check_lengths("ideal, scores", ideal.scores.iter().map(Vec::len), regions)?;
        check_length("ideal, denoised pixels", ideal.denoised.len(), pixels)?;
        check_length("ideal, rendered pixels", ideal.rendered.len(), pixels)?;
        let camera = &self.candidate;
        let regions = camera.regions() as usize;
        check_length("candidate, srs", candidate.srs.len(), regions)?;
        check_length("candidate, trs", candidate.trs.len(), regions)?;
        check_length("candidate, actions", candidate.actions.len(), regions)?;
        check_length("candidate, changed pixels", candidate.temporal_count.len(), regions)?;
        check_length("candidate, features", candidate.scores.len(), camera.features().len())?;
        check_lengths("candidate, scores", candidate.scores.iter().map(Vec::len), regions)?;
        check_length("candidate, denoised pixels", denoised.len(), pixels)?;
        check_length("candidate, pixels of the screen", len, pixels)
    }
}

fn check_length(what: &'static str, given: usize, expected: usize) -> Result<(), FidelityError> {
    if given == expected {
        return Ok(());
    }
    Err(FidelityError::ResultLength { what, given, expected })
}

fn check_lengths(
    what: &'static str,
    mut given: impl Iterator<Item = usize>,
    expected: usize,
) -> Result<(), FidelityError> {
    given.try_for_each(|given| check_length(what, given, expected))
}

impl<T: PixelSample> TypedPixelComparison<T> {
    fn new(ideal: &Camera, candidate: &Camera) -> Self {
        let (width, height) = (ideal.width() as usize, ideal.height() as usize);
        Self {
            planes: FrameConverter::new(ideal, candidate),
            comparison: ScreenComparison::new(width, height, ideal.pixel_max()),
            staleness: StalenessTracker::new(ideal),
            own_staleness: StalenessTracker::new(ideal),
        }
    }

    fn end_runs(&mut self) {
        self.staleness.end_runs();
        self.own_staleness.end_runs();
    }

    fn compare_frame(
        &mut self,
        input: &ByteFrame,
        ideal: &IdealOutcome,
        CandidateFrame { screen, denoised, .. }: CandidateFrame<'_>,
        tally: &mut ErrorTally,
    ) {
        // The types have been checked, so this always succeeds.
        let pixels = input.borrowed_pixels();
        let Some(compared_frames) = self.planes.convert(pixels, ideal, (screen, denoised)) else {
            return;
        };
        let [to_ideal, to_input] = self.comparison.compare(compared_frames);
        tally.to_ideal.add(&to_ideal);
        tally.to_input.add(&to_input);
        self.staleness.add_frame(
            &ideal.srs,
            compared_frames.denoised,
            compared_frames.screen,
            &mut tally.stale,
        );
        self.own_staleness.add_frame(
            &ideal.srs,
            compared_frames.own_denoised,
            compared_frames.screen,
            &mut tally.stale_to_own,
        );
    }
}
