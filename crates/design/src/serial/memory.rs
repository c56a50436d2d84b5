// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memory of a lane: which areas a slot has, where, and of what it is built.

use std::fmt;

use crate::{Filter, MemoryKind, Reference, SerialDesign, index_bits};

/// Memory LUTs up to which a lane's memory is distributed, unless the configuration says otherwise. A
/// RAMB18 is to the VU9P's block RAM what 137 memory LUTs are to its distributed RAM.
const MAX_MEMORY_LUTS: u64 = 128;
/// Words of one bit that a memory LUT holds.
const LUT_WORDS: u64 = 64;
/// Bits of a word of a RAMB18, and how many such words it holds. The ninth and the eighteenth bit come with the others.
const RAMB18: [(u64, u64); 5] = [(1, 16_384), (2, 8_192), (4, 4_096), (9, 2_048), (18, 1_024)];

/// What an area of a slot holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AreaKind {
    /// Raw pixels with their halo, (N+2r)^2.
    Raw,
    /// Denoised pixels, S^2.
    Denoised,
    /// The region of the frame it is compared with, n.
    Reference,
}

impl fmt::Display for AreaKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Raw => "raw",
            Self::Denoised => "denoised",
            Self::Reference => "reference",
        })
    }
}

/// A square of pixels in a slot, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// What it holds.
    pub kind: AreaKind,
    /// Address of its first word in the slot.
    pub base: u32,
    /// Side of the square in pixels; a pixel is a word.
    pub side: u32,
}

impl Area {
    /// Words of the area.
    #[must_use]
    pub fn words(&self) -> u32 {
        self.side * self.side
    }
}

impl MemoryKind {
    /// Clocks from address to data.
    #[must_use]
    pub fn read_latency(self) -> u32 {
        match self {
            Self::Distributed => 0,
            Self::Block => 1,
        }
    }
}

/// The memory of one lane; words are pixels of P bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LaneMemory {
    /// The areas of a slot, one behind the other from address 0.
    pub areas: Vec<Area>,
    /// Words of a slot: a power of two that holds the areas. Slot k starts at k times this.
    pub slot_words: u32,
    /// Words of the lane's memory, K times those of a slot.
    pub depth: u64,
    /// Bits of an address in it.
    pub address_bits: u32,
    /// Memory LUTs that it takes as distributed memory.
    pub luts: u64,
    /// RAMB18 that it takes as block memory, if all of them have words of the same width.
    pub blocks: u64,
    /// Of what it is built.
    pub kind: MemoryKind,
    /// Why of that.
    pub why: MemoryChoice,
}

/// Why a lane's memory is of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryChoice {
    /// The configuration says so, `hardware.memory`.
    Configured,
    /// It says nothing: distributed memory while it takes at most so many memory LUTs, block above.
    Limit(u64),
}

impl LaneMemory {
    fn of(design: SerialDesign<'_>) -> Self {
        let denoises = match design.filter() {
            Filter::None => false,
            Filter::Median3x3 => true,
        };
        let reference = design.temporal().reference;
        let keeps_reference = match reference {
            Reference::Previous => !denoises,
            Reference::LastSent => true,
        };
        let candidates = [
            (true, AreaKind::Raw, design.stream_side()),
            (denoises, AreaKind::Denoised, design.denoised_side()),
            (keeps_reference, AreaKind::Reference, design.region_size()),
        ];
        let mut areas = Vec::new();
        let mut words = 0;
        for (_, kind, side) in candidates.into_iter().filter(|(there, _, _)| *there) {
            areas.push(Area { kind, base: words, side });
            words += side * side;
        }
        let slot_words = words.next_power_of_two();
        let depth = u64::from(design.fold()) * u64::from(slot_words);
        // Words hold pixels, and of each what the reference keeps of it.
        let pixel = design.pixel_bits();
        let bits = u64::from(pixel.max(reference.bits_per_pixel(pixel)));
        let luts = bits * depth.div_ceil(LUT_WORDS);
        let blocks = RAMB18.map(|(wide, words)| bits.div_ceil(wide) * depth.div_ceil(words));
        let blocks = blocks.into_iter().min().expect("a block has words");
        let (kind, why) = match design.own().memory {
            Some(kind) => (kind, MemoryChoice::Configured),
            None if luts <= MAX_MEMORY_LUTS => {
                (MemoryKind::Distributed, MemoryChoice::Limit(MAX_MEMORY_LUTS))
            }
            None => (MemoryKind::Block, MemoryChoice::Limit(MAX_MEMORY_LUTS)),
        };
        Self { areas, slot_words, depth, address_bits: index_bits(depth), luts, blocks, kind, why }
    }

    /// Memory LUTs and RAMB18 that it takes, built as it is.
    #[must_use]
    pub fn taken(&self) -> (u64, u64) {
        match self.kind {
            MemoryKind::Distributed => (self.luts, 0),
            MemoryKind::Block => (0, self.blocks),
        }
    }

    /// The area of that kind, if a slot has it.
    #[must_use]
    pub fn area(&self, kind: AreaKind) -> Option<&Area> {
        self.areas.iter().find(|area| area.kind == kind)
    }
}

impl SerialDesign<'_> {
    /// The memory of one lane.
    #[must_use]
    pub fn lane_memory(&self) -> LaneMemory {
        LaneMemory::of(*self)
    }
}
