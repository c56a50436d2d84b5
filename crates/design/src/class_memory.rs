// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memory of classes of a serial or raster core with zones, by the rules of `docs/zones.md`:
//! its words and its ports.

use crate::interface::{CoreStream, StreamRole};
use crate::{Design, Hardware, Port, PortDirection, PortRole};
use foveate_camera::{RegionClass, index_bits};

/// Number of classes in a word of the map.
pub const CLASSES_PER_WORD: u32 = 16;

/// Bits of the code of a class.
pub const CLASS_BITS: u32 = 2;

/// Bits of a word of the map.
pub const CLASS_WORD_BITS: u32 = CLASSES_PER_WORD * CLASS_BITS;

impl Design {
    /// Returns true if the core has a memory of classes. A pipelined core takes classes at its
    /// ports.
    #[must_use]
    pub fn has_class_memory(&self) -> bool {
        match self.hardware() {
            Hardware::Pipelined(_) => false,
            Hardware::Serial(_) | Hardware::Raster(_) => self.zones().is_some(),
        }
    }

    /// Returns the number of words of a map of classes, ceil(M / 16).
    #[must_use]
    pub fn class_words(&self) -> u32 {
        self.regions().div_ceil(CLASSES_PER_WORD)
    }

    /// Returns the bits of the number of a word of a map of classes. They are at least 1.
    #[must_use]
    pub fn class_address_bits(&self) -> u32 {
        index_bits(self.class_words().into()).max(1)
    }
}

/// Returns the word with the codes of up to [`CLASSES_PER_WORD`] classes, the first one in the
/// lowest bits.
#[must_use]
pub fn class_word(classes: &[RegionClass]) -> u32 {
    classes.iter().rev().fold(0, |word, class| word << CLASS_BITS | u32::from(class.code()))
}

/// Returns the streams of a core with a memory of classes: its words and its commits. A design
/// without zones has none.
pub(crate) fn class_streams(design: &Design) -> Vec<CoreStream> {
    if design.zones().is_none() {
        return Vec::new();
    }
    let input = |role, width, doc| Port::scalar(PortDirection::Input, role, width, doc);
    let word = "16 classes of 2 bits: 0 normal, 1 off, 2 keen, 3 always";
    let words = CoreStream::into_core(
        StreamRole::ClassWords,
        "a word of the map of classes",
        input(PortRole::ClassWrite, 1, "a word of the map of classes is written"),
        vec![
            input(PortRole::ClassAddress, design.class_address_bits(), "number of that word"),
            input(PortRole::ClassWord, CLASS_WORD_BITS, word),
        ],
    );
    let pending = "frames do not use the committed map yet; writes and commits have no effect";
    let commits = CoreStream {
        status: vec![Port::scalar(PortDirection::Output, PortRole::ClassPending, 1, pending)],
        ..CoreStream::into_core(
            StreamRole::ClassCommits,
            "a map of classes that is complete",
            input(PortRole::ClassCommit, 1, "frames use the map that has been written"),
            Vec::new(),
        )
    };
    vec![words, commits]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_class_has_the_lowest_bits() {
        use RegionClass::{Always, Keen, Normal, Off};
        assert_eq!(class_word(&[]), 0);
        assert_eq!(class_word(&[Off, Normal, Keen]), 0b10_00_01);
        assert_eq!(class_word(&[Always; 16]), u32::MAX);
    }
}
