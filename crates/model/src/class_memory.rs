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

#[cfg(test)]
mod tests {
    use foveate_camera::RegionClass::{Always, Keen, Normal, Off};

    use super::*;

    const NOTHING: ClassMapInputs =
        ClassMapInputs { write: false, address: 0, word: 0, commit: false };
    const COMMIT: ClassMapInputs = ClassMapInputs { commit: true, ..NOTHING };

    /// Makes a memory of `regions` regions, all of which are normal.
    fn memory(regions: usize) -> ClassMemory {
        let map = vec![Normal; regions];
        ClassMemory { banks: [map.clone(), map], committed: 0, is_pending: false }
    }

    fn write(address: u32, word: u32) -> ClassMapInputs {
        ClassMapInputs { write: true, address, word, ..NOTHING }
    }

    fn used(memory: &ClassMemory) -> Vec<RegionClass> {
        (0..).zip(&memory.banks[0]).map(|(region, _)| memory.class(region)).collect()
    }

    #[test]
    fn a_word_has_the_classes_of_sixteen_regions() {
        let mut memory = memory(18);
        memory.step(write(1, 0xffff_fff9), false);
        // The memory has no such words.
        memory.step(write(2, u32::MAX), false);
        memory.step(write(u32::MAX, u32::MAX), false);
        memory.step(ClassMapInputs { commit: true, ..write(0, 0xc000_0002) }, false);
        memory.step(NOTHING, false);
        let mut expected = vec![Normal; 18];
        (expected[0], expected[15], expected[16], expected[17]) = (Keen, Always, Off, Keen);
        assert_eq!(used(&memory), expected);
    }

    #[test]
    fn a_commit_is_pending_until_an_edge_that_no_frame_occupies() {
        let mut memory = memory(1);
        let commit = ClassMapInputs { commit: true, ..write(0, 3) };
        for (inputs, is_occupied, expected) in [
            (commit, false, (true, Normal)),
            (NOTHING, true, (true, Normal)),
            (NOTHING, true, (true, Normal)),
            (NOTHING, false, (false, Always)),
            (COMMIT, true, (true, Always)),
            (NOTHING, false, (false, Normal)),
        ] {
            memory.step(inputs, is_occupied);
            assert_eq!((memory.is_pending(), memory.class(0)), expected);
        }
    }

    #[test]
    fn nothing_is_written_or_committed_while_a_commit_is_pending() {
        let mut memory = memory(1);
        memory.step(ClassMapInputs { commit: true, ..write(0, 3) }, true);
        memory.step(ClassMapInputs { commit: true, ..write(0, 2) }, true);
        // Before this edge the commit is still pending.
        memory.step(ClassMapInputs { commit: true, ..write(0, 1) }, false);
        assert_eq!((memory.is_pending(), memory.class(0)), (false, Always));
        memory.step(COMMIT, false);
        memory.step(NOTHING, false);
        assert_eq!(memory.class(0), Normal);
    }

    #[test]
    fn a_write_goes_to_the_bank_with_the_map_before_the_committed_one() {
        let mut memory = memory(17);
        memory.step(write(0, 3), false);
        memory.step(ClassMapInputs { commit: true, ..write(1, 2) }, false);
        memory.step(NOTHING, false);
        memory.step(ClassMapInputs { commit: true, ..write(0, 1) }, false);
        memory.step(NOTHING, false);
        assert_eq!((memory.class(0), memory.class(16)), (Off, Normal));
        memory.step(COMMIT, false);
        memory.step(NOTHING, false);
        assert_eq!((memory.class(0), memory.class(16)), (Always, Keen));
    }

    #[test]
    fn a_reset_ends_a_pending_commit() {
        let mut memory = memory(1);
        memory.step(ClassMapInputs { commit: true, ..write(0, 2) }, true);
        assert_eq!((memory.is_pending(), memory.class(0)), (true, Normal));
        memory.reset();
        assert_eq!((memory.is_pending(), memory.class(0)), (false, Keen));
    }
}
