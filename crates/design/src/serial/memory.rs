// SPDX-License-Identifier: MIT OR Apache-2.0
//! The storage of a serial lane: its memory ([`LaneMemory`]) with the areas of a slot
//! ([`SlotArea`]), and the registers of the lane and of the sequencer ([`LaneWidths`]).
//! [`MemoryChoice`] says why the memory is of its kind.

use crate::{FeatureHardware, LaneMemoryKind, PixelFeed, SerialDesign};
use foveate_camera::{DenoiseFilter, ReferenceWriteTime, SpatialFeature, index_bits};
use std::fmt;

/// Largest number of memory LUTs of the distributed memory of a lane, unless the configuration
/// chooses the kind. A RAMB18 is the same share of the block RAM of a VU9P as 137 memory LUTs are
/// of its distributed RAM.
const MAX_MEMORY_LUTS: u64 = 128;
/// Number of words of one bit that a memory LUT holds.
const LUT_WORDS: u64 = 64;
/// The shapes of a RAMB18: bits of a word, and number of words. Words of 9 and 18 bits include the
/// parity bits.
const RAMB18: [(u64, u64); 5] = [(1, 16_384), (2, 8_192), (4, 4_096), (9, 2_048), (18, 1_024)];

/// The contents of an area of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SlotAreaKind {
    /// Raw pixels with their halo, (N+2r)^2 words.
    Raw,
    /// Denoised pixels, S^2 words.
    Denoised,
    /// The reference of the region, n words.
    Reference,
}

impl fmt::Display for SlotAreaKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Raw => "raw",
            Self::Denoised => "denoised",
            Self::Reference => "reference",
        })
    }
}

/// An area of a slot: a square of pixels in row-major order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SlotArea {
    /// Contents of the area.
    pub kind: SlotAreaKind,
    /// Address of the first word of the area in its slot.
    pub base: u32,
    /// Side of the square in pixels. A pixel is one word.
    pub side: u32,
}

impl SlotArea {
    /// Returns the number of words of the area.
    #[must_use]
    pub fn words(&self) -> u32 {
        self.side * self.side
    }
}

impl LaneMemoryKind {
    /// Returns the clocks from an address to its data.
    #[must_use]
    pub fn read_latency(self) -> u32 {
        match self {
            Self::Distributed => 0,
            Self::Block => 1,
        }
    }
}

/// The memory of one lane. Its words are pixels of P bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LaneMemory {
    /// The areas of a slot, one behind the other from address 0.
    pub areas: Vec<SlotArea>,
    /// Words of a slot: a power of two that is large enough for the areas. Slot k starts at address
    /// k times this.
    pub slot_words: u32,
    /// Words of the memory of the lane: K times the words of a slot.
    pub depth: u64,
    /// Bits of an address of the memory.
    pub address_bits: u32,
    /// Number of memory LUTs as distributed memory.
    pub luts: u64,
    /// Number of RAMB18 as block memory, all with words of the same width.
    pub blocks: u64,
    /// The kind of memory.
    pub kind: LaneMemoryKind,
    /// The reason for the kind of memory.
    pub choice: MemoryChoice,
}

/// The reason for the kind of memory of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryChoice {
    /// The configuration chooses the kind with `hardware.memory`.
    Configured,
    /// The configuration does not choose. The memory is distributed while it takes at most this
    /// many memory LUTs, else block.
    LutLimit(u64),
}

impl LaneMemory {
    fn from_design(design: SerialDesign<'_>) -> Self {
        let denoises = design.filter().has_window();
        let reference = design.temporal().reference;
        let keeps_reference = !denoises || design.copies_reference();
        let candidates = [
            (true, SlotAreaKind::Raw, design.stream_side()),
            (denoises, SlotAreaKind::Denoised, design.denoised_side()),
            (keeps_reference, SlotAreaKind::Reference, design.region_size()),
        ];
        let mut areas = Vec::new();
        let mut words = 0;
        for (_, kind, side) in candidates.into_iter().filter(|(there, _, _)| *there) {
            areas.push(SlotArea { kind, base: words, side });
            words += side * side;
        }
        let slot_words = words.next_power_of_two();
        let depth = u64::from(design.fold()) * u64::from(slot_words);
        // A word holds a pixel or the part of it that the reference stores.
        let pixel = design.pixel_bits();
        let bits = u64::from(pixel.max(reference.bits_per_pixel(pixel)));
        let luts = bits * depth.div_ceil(LUT_WORDS);
        let blocks = RAMB18.map(|(wide, words)| bits.div_ceil(wide) * depth.div_ceil(words));
        let blocks = blocks.into_iter().min().expect("a block has words");
        let (kind, why) = match design.own_hardware().memory {
            Some(kind) => (kind, MemoryChoice::Configured),
            None if luts <= MAX_MEMORY_LUTS => {
                (LaneMemoryKind::Distributed, MemoryChoice::LutLimit(MAX_MEMORY_LUTS))
            }
            None => (LaneMemoryKind::Block, MemoryChoice::LutLimit(MAX_MEMORY_LUTS)),
        };
        Self {
            areas,
            slot_words,
            depth,
            address_bits: index_bits(depth),
            luts,
            blocks,
            kind,
            choice: why,
        }
    }

    /// Returns the numbers of memory LUTs and of RAMB18 for the kind of memory that the lane has.
    #[must_use]
    pub fn resources(&self) -> (u64, u64) {
        match self.kind {
            LaneMemoryKind::Distributed => (self.luts, 0),
            LaneMemoryKind::Block => (0, self.blocks),
        }
    }

    /// Returns the area of that kind, or `None` if a slot does not have it.
    #[must_use]
    pub fn area(&self, kind: SlotAreaKind) -> Option<&SlotArea> {
        self.areas.iter().find(|area| area.kind == kind)
    }
}

impl SerialDesign<'_> {
    /// Returns true if the reference stays as it is until the last score, and then takes the scored
    /// pixels. In other designs each pixel overwrites its reference once it has been compared.
    #[must_use]
    pub fn copies_reference(&self) -> bool {
        // The search of `flow` reads the whole reference once the pixels are denoised.
        self.displacement_feature().is_some()
            || match self.temporal().reference.write_time() {
                ReferenceWriteTime::EveryFrame => false,
                ReferenceWriteTime::WhenSent => true,
            }
    }

    /// The memory of one lane.
    #[must_use]
    pub fn lane_memory(&self) -> LaneMemory {
        LaneMemory::from_design(*self)
    }
}

/// The widths of the registers of a serial array, in bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LaneWidths {
    /// Width of the accumulator, which is signed.
    pub accumulator: u32,
    /// Width of the second word, which holds a mean, a sum, a quotient or the largest pixel. It is
    /// at least 2.
    pub second: u32,
    /// Width of the word that travels around the ring of lanes: a score, the sum of a block, a mean
    /// or, with raster feed, a pixel.
    pub chain: u32,
    /// Width of the constant that the sequencer shifts from step to step.
    pub scale: u32,
    /// Width of the number of a center in the larger square of centers.
    pub center: u32,
}

impl LaneWidths {
    fn from_design(design: SerialDesign<'_>) -> Self {
        let pixel = design.pixel_bits();
        let raster = match design.feed() {
            PixelFeed::Parallel => 0,
            PixelFeed::Raster => pixel,
        };
        let sums = design.block_mean_division();
        let hardware = |feature: &SpatialFeature| FeatureHardware::in_serial(feature.kind());
        let counts =
            design.features().iter().map(|feature| (hardware(feature).chain_bits)(&design));
        let chain = counts
            .fold(design.max_score_bits(), u32::max)
            .max(raster)
            .max(sums.map_or(0, |sums| sums.passing_bits));
        let filter = match design.filter() {
            DenoiseFilter::None | DenoiseFilter::Median3x3 | DenoiseFilter::Switching3x3 => 1,
            DenoiseFilter::Binomial3x3 => 5,
        };
        // The accumulator holds the difference of two pixels, or of their windows. The scale holds
        // the power of two that the median search starts with.
        let mut widths = Self {
            accumulator: (pixel + filter).max(sums.map_or(0, |sums| sums.sum_bits)),
            second: 2,
            chain,
            scale: pixel,
            center: index_bits(if design.filter().has_window() {
                u64::from(design.denoised_side()).pow(2)
            } else {
                design.region_pixels().into()
            }),
        };
        for feature in design.features() {
            let needs = (hardware(feature).registers)(&design, feature);
            widths.accumulator = widths.accumulator.max(needs.accumulator);
            if hardware(feature).takes_accumulator {
                widths.accumulator = widths.accumulator.max(chain);
            }
            widths.second = widths.second.max(needs.second);
            widths.scale = widths.scale.max(needs.scale);
        }
        widths
    }
}

impl SerialDesign<'_> {
    /// Returns the widths of the registers of the array.
    #[must_use]
    pub fn lane_widths(&self) -> LaneWidths {
        LaneWidths::from_design(*self)
    }
}
