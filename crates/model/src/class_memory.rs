// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memory of the classes of all regions, by the rules of `docs/zones.md`. Serial and raster
//! cores with zones have one.
//!
//! ```text
//! edge              1  2  3  4  5  6  7  8  9
//! commit            -  1  -  -  1  -  -  -  -
//! occupied          -  -  -  -  -  F  F  F  -
//! pending (after)   0  1  0  0  1  1  1  1  0
//! used (after)      A  A  B  B  B  B  B  B  C     frame F uses map B
//! ```

use foveate_camera::RegionClass;
use foveate_design::{CLASS_BITS, CLASSES_PER_WORD, Design};

use crate::ClassMapInputs;
use crate::conversions::index;

const BANKS: usize = 2;

/// The memory of classes of a core. A new one is in the state before the first write.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ClassMemory {
    /// A whole map in each bank: the class of every region.
    banks: [Vec<RegionClass>; BANKS],
    /// The number of the bank that is committed.
    committed: usize,
    /// True while frames use the bank that is not committed. Nothing is written then, so it still
    /// has the map before the committed one.
    is_pending: bool,
}

impl ClassMemory {
    /// Makes the memory of a design, or returns `None` if the design has no zones.
    pub(crate) fn of_design(design: &Design) -> Option<Self> {
        let map = design.zones()?.configured_classes().to_vec();
        Some(Self { banks: [map.clone(), map], committed: 0, is_pending: false })
    }

    /// Applies an edge without a reset. `is_occupied` is true if a frame occupies the edge.
    pub(crate) fn step(&mut self, inputs: ClassMapInputs, is_occupied: bool) {
        if self.is_pending {
            self.is_pending = is_occupied;
            return;
        }
        if inputs.write {
            self.write(inputs.address, inputs.word);
        }
        if inputs.commit {
            self.committed = self.other_bank();
            self.is_pending = true;
        }
    }

    /// Applies an edge with `rst_i`: the next frame uses the map that was committed last.
    pub(crate) fn reset(&mut self) {
        self.is_pending = false;
    }

    /// Returns `zone_pending_o` after the last edge.
    pub(crate) fn is_pending(&self) -> bool {
        self.is_pending
    }

    /// Returns the class of a region in the map that frames use. The map stays the same as long as
    /// a frame occupies the edges.
    pub(crate) fn class(&self, region: u32) -> RegionClass {
        let used = if self.is_pending { self.other_bank() } else { self.committed };
        self.banks[used][index(region)]
    }

    /// Returns the number of the bank that is not committed.
    fn other_bank(&self) -> usize {
        (self.committed + 1) % BANKS
    }

    /// Writes a word. Its bits of regions that do not exist have no effect.
    fn write(&mut self, address: u32, word: u32) {
        let other = self.other_bank();
        let first = index(address) * index(CLASSES_PER_WORD);
        let regions = self.banks[other].iter_mut().skip(first).take(index(CLASSES_PER_WORD));
        for (class, place) in regions.zip(0..) {
            *class = class_of_word(word, place);
        }
    }
}

/// Returns the class of region `place` of a word.
fn class_of_word(word: u32, place: u32) -> RegionClass {
    let code = word >> (CLASS_BITS * place) & ((1 << CLASS_BITS) - 1);
    let code = u8::try_from(code).expect("a code has two bits");
    RegionClass::from_code(code).expect("every code of two bits is that of a class")
}
