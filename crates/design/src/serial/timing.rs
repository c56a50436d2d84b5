// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timing of a serial array: the phases of a frame in order, and their steps.

use std::fmt;

use crate::timing::DepartureTiming;
use crate::{DesignTiming, FeatureHardware, Pipelining, PixelFeed, SerialDesign};
use foveate_camera::{DenoiseFilter, FeatureKind, SpatialFeature};

/// A phase of the lanes for one slot. The variants are in the order of the phases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SerialPhase {
    /// The classes of the regions of the slot go to their lanes.
    PassClasses,
    /// The pixels are denoised. Each of them is compared with its reference.
    DenoiseAndCompare,
    /// The denoised pixels beyond the border of the frame are replaced by repetitions of those at
    /// the border.
    RepeatBorder,
    /// The raw pixels are compared with their reference.
    CompareRaw,
    /// The temporal counts of the lanes pass the ports.
    RotateCount,
    /// The means of blocks are computed, and pass to the comparison with the means that the screen
    /// shows.
    ComputeMeans,
    /// The score of a feature is computed.
    FeaturePass(FeatureKind),
    /// The scores of a feature pass the ports.
    RotateScore(FeatureKind),
    /// The scored pixels become the reference, with `last-sent` those that are sent.
    CopyReference,
    /// The pixels of active regions leave.
    UnloadPixels,
    /// The means of regions that send their summary leave.
    UnloadMeans,
}

impl fmt::Display for SerialPhase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PassClasses => f.pad("classes"),
            Self::DenoiseAndCompare => f.pad("denoise and temporal"),
            Self::RepeatBorder => f.pad("border"),
            Self::CompareRaw => f.pad("temporal"),
            Self::RotateCount => f.pad("rotate count"),
            Self::ComputeMeans => f.pad("means"),
            Self::FeaturePass(kind) => f.pad(kind.name()),
            Self::RotateScore(kind) => f.pad(&format!("rotate {kind}")),
            Self::CopyReference => f.pad("copy"),
            Self::UnloadPixels => f.pad("unload"),
            Self::UnloadMeans => f.pad("unload means"),
        }
    }
}

/// The timing of a serial array: all numbers of `docs/serial.md`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SerialTiming {
    phases: Vec<(SerialPhase, u64)>,
    slots: u32,
    read_latency: u32,
    settling_steps: u32,
    load_pixels: u64,
    load_clocks: u64,
}

impl SerialTiming {
    /// Returns the timing of the design.
    #[must_use]
    pub fn from_design(design: SerialDesign<'_>) -> Self {
        let stream = u64::from(design.stream_pixels());
        let (load_pixels, load_clocks) = match design.feed() {
            PixelFeed::Parallel => {
                let pixels = u64::from(design.fold()) * stream;
                (pixels, pixels)
            }
            PixelFeed::Raster => {
                let regions = u64::from(design.regions());
                (regions * u64::from(design.region_pixels()), regions * stream)
            }
        };
        Self {
            phases: phases(design),
            slots: design.fold(),
            read_latency: read_latency(design),
            settling_steps: settling_steps(design),
            load_pixels,
            load_clocks,
        }
    }

    /// Returns the phases of one slot that the design has, in order, each with its number of steps.
    /// They are the same for every slot.
    #[inline]
    #[must_use]
    pub fn phases(&self) -> &[(SerialPhase, u64)] {
        &self.phases
    }

    /// Returns the number of slots, K.
    #[must_use]
    pub fn slots(&self) -> u32 {
        self.slots
    }

    /// Returns the clocks from the address of a word to the accumulator, Q, 0 to 3.
    #[must_use]
    pub fn read_latency(&self) -> u32 {
        self.read_latency
    }

    /// Returns the number of steps at the start of a rotation in which no score is on the ports, s,
    /// 0 or 1.
    #[must_use]
    pub fn settling_steps(&self) -> u32 {
        self.settling_steps
    }

    /// Returns the number of steps for one slot.
    #[inline]
    #[must_use]
    pub fn slot_steps(&self) -> u64 {
        self.phases.iter().map(|(_, steps)| steps).sum()
    }

    /// Returns the number of steps for a frame, J.
    #[inline]
    #[must_use]
    pub fn steps(&self) -> u64 {
        u64::from(self.slots) * self.slot_steps()
    }

    /// Returns the number of pixels that are taken for a frame, U: per lane with parallel feed, in
    /// all with raster feed.
    #[must_use]
    pub fn load_pixels(&self) -> u64 {
        self.load_pixels
    }

    /// Returns the clocks that taking a frame without gaps needs, U'. It is more than U for raster
    /// feed with a halo.
    #[must_use]
    pub fn load_clocks(&self) -> u64 {
        self.load_clocks
    }

    /// Returns the edges from T0 to the edge before the clock of step `j` (0..J), 1 + Q + j.
    #[inline]
    #[must_use]
    pub fn edges_to_step(&self, j: u64) -> u64 {
        1 + u64::from(self.read_latency) + j
    }

    /// Returns the edges from T0 to the edge after which the array is ready again, 1 + J.
    #[inline]
    #[must_use]
    pub fn edges_to_ready(&self) -> u64 {
        1 + self.steps()
    }

    /// Returns the clocks from one frame to the next that follows at once, U' + J + 1.
    #[must_use]
    pub fn clocks_per_frame(&self) -> u64 {
        self.load_clocks + self.steps() + 1
    }

    /// Returns the timing in terms that every organization has.
    pub(super) fn to_design_timing(&self) -> DesignTiming {
        let phases: Vec<_> =
            self.phases.iter().map(|(phase, steps)| (phase.to_string(), *steps)).collect();
        let listed: Vec<_> =
            phases.iter().map(|(phase, steps)| format!("{phase} {steps}")).collect();
        let (clocks, slot) = (self.clocks_per_frame(), self.slot_steps());
        let (load, steps) = (self.load_clocks, self.steps());
        DesignTiming {
            clocks_per_frame: clocks,
            pixels_per_frame: self.load_pixels,
            figures: vec![
                ("cycles_per_frame", clocks),
                ("load_pixels", self.load_pixels),
                ("load_clocks", load),
                ("steps", steps),
                ("slot_steps", slot),
            ],
            phases,
            descriptions: vec![
                ("steps per slot", format!("{slot}: {}", listed.join(", "))),
                (
                    "cycles per frame",
                    format!("{clocks}: {load} to take the frame, {steps} steps, 1 between"),
                ),
            ],
            departure: DepartureTiming {
                take_clocks: load,
                decision_frames: 0,
                decision_clocks: self.edges_to_step(self.steps_to_decisions() - 1),
                forward_frames: 0,
                forward_clocks: self.edges_to_step(slot - 1),
                slot_clocks: slot,
                buffered_rows: None,
                has_independent_units: false,
            },
        }
    }

    /// Returns the number of steps of a slot up to its last decision, which comes with the last
    /// score.
    fn steps_to_decisions(&self) -> u64 {
        let is_score =
            |(phase, _): &(SerialPhase, u64)| matches!(phase, SerialPhase::RotateScore(_));
        let last = self.phases.iter().rposition(is_score).expect("a design has a feature");
        self.phases[..=last].iter().map(|(_, steps)| steps).sum()
    }
}

/// Returns Q. A deep lane has a register for the word, and one for the operand if a feature
/// computes it from the word.
fn read_latency(design: SerialDesign<'_>) -> u32 {
    let word = match design.pipelining() {
        Pipelining::Plain => 0,
        Pipelining::Deep => {
            let hardware = |f: &SpatialFeature| FeatureHardware::in_serial(f.kind());
            1 + u32::from(design.features().iter().any(|f| hardware(f).computes_operand))
        }
    };
    design.lane_memory().kind.read_latency() + word
}

/// Returns s. A deep lane has a register behind the hit.
fn settling_steps(design: SerialDesign<'_>) -> u32 {
    match design.pipelining() {
        Pipelining::Plain => 0,
        Pipelining::Deep => 1,
    }
}

/// Returns the steps that denoise a pixel and compare it with its reference, without Q.
fn filter_steps(design: SerialDesign<'_>) -> u64 {
    // A reference that is not copied is the word that the denoised pixel overwrites.
    let looked_up = u64::from(design.copies_reference());
    let median = 10 * u64::from(design.pixel_bits()) + 3 + looked_up;
    match design.filter() {
        DenoiseFilter::None => 0,
        DenoiseFilter::Median3x3 => median,
        DenoiseFilter::Switching3x3 => median + 19,
        // The weights of the window are 16. The reference is subtracted 16 times, too.
        DenoiseFilter::Binomial3x3 => 51,
    }
}

fn phases(design: SerialDesign<'_>) -> Vec<(SerialPhase, u64)> {
    let n = u64::from(design.region_pixels());
    let lanes = u64::from(design.lanes());
    let read = u64::from(read_latency(design));
    let rotation = u64::from(settling_steps(design)) + lanes;
    let mut list = Vec::new();
    if design.zones().is_some() {
        list.push((SerialPhase::PassClasses, lanes));
    }
    match design.filter() {
        DenoiseFilter::Median3x3 | DenoiseFilter::Switching3x3 | DenoiseFilter::Binomial3x3 => {
            let pixels = u64::from(design.denoised_side()).pow(2);
            list.push((SerialPhase::DenoiseAndCompare, pixels * (filter_steps(design) + read)));
            if design.needs_border() {
                let side = u64::from(design.denoised_side());
                list.push((SerialPhase::RepeatBorder, 4 * side * (2 + read)));
            }
        }
        DenoiseFilter::None => {
            // The pixel overwrites the reference, or is copied later.
            let compared = if design.copies_reference() { 3 } else { 3 + read };
            list.push((SerialPhase::CompareRaw, n * compared));
        }
    }
    list.push((SerialPhase::RotateCount, rotation));
    if let Some(periphery) = design.periphery() {
        let mean = u64::from(periphery.block_pixels()) + 2;
        list.push((
            SerialPhase::ComputeMeans,
            u64::from(periphery.mean_count()) * (mean + rotation),
        ));
    }
    for feature in design.features() {
        list.push((
            SerialPhase::FeaturePass(feature.kind()),
            (FeatureHardware::in_serial(feature.kind()).pass_steps)(&design, feature),
        ));
        list.push((SerialPhase::RotateScore(feature.kind()), rotation));
    }
    if design.copies_reference() {
        list.push((SerialPhase::CopyReference, n * (2 + read)));
    }
    let unload = match design.feed() {
        PixelFeed::Parallel => n,
        PixelFeed::Raster => n * (1 + lanes),
    };
    list.push((SerialPhase::UnloadPixels, unload));
    if let Some(periphery) = design.periphery() {
        let round = match design.feed() {
            // The means of all lanes pass around the ring. Then every lane writes its own means and
            // reads them.
            PixelFeed::Parallel => lanes + 2 + read,
            PixelFeed::Raster => 1 + lanes,
        };
        list.push((SerialPhase::UnloadMeans, u64::from(periphery.mean_count()) * round));
    }
    list
}
