// SPDX-License-Identifier: MIT OR Apache-2.0
//! The macros that hold the memories that are not mapped to cells.
//!
//! A memory whose words are read at a clock edge fits in macros with at least as many ports as it
//! reads and writes at a time. Its words are split over macros side by side, and its number of words
//! over macros one after the other; of all macros, those with the smallest area are chosen. The logic
//! that would select among macros is not counted.

use serde::{Deserialize, Serialize};

use super::library::{LibertyLibrary, MemoryShape};
use super::mapping::UnmappedMemory;
use crate::speed::count_to_f64;

/// A memory of a module that is not mapped to cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MemoryFigures {
    /// The place of the memory in the design.
    pub name: String,
    /// The number of such memories.
    pub count: u64,
    /// The number of words of one of them.
    pub words: u64,
    /// The bits of a word.
    pub width: u64,
    /// The macros of one memory, or `None` if none fits.
    pub macros: Option<MacroChoice>,
}

/// The macros of a memory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MacroChoice {
    /// The cell of the library of macros.
    pub name: String,
    /// The number of macros.
    pub count: u64,
    /// The area of all of them in square micrometres.
    pub area_um2: f64,
}

impl MemoryFigures {
    /// Returns the bits of all memories of this size.
    #[must_use]
    pub fn bits(&self) -> u64 {
        self.count * self.words * self.width
    }
}

/// Chooses macros for a memory.
pub(super) fn plan_memory(memory: &UnmappedMemory, libraries: &[LibertyLibrary]) -> MemoryFigures {
    let macros = libraries.iter().flat_map(LibertyLibrary::memories);
    let fitting = macros.filter(|(_, shape, _)| fits(memory, *shape));
    let choices = fitting.map(|(name, shape, area)| {
        let count = memory.words.div_ceil(shape.words) * memory.width.div_ceil(shape.width);
        MacroChoice { name: name.to_owned(), count, area_um2: area * count_to_f64(count) }
    });
    MemoryFigures {
        name: memory.name.clone(),
        count: memory.count,
        words: memory.words,
        width: memory.width,
        macros: choices.min_by(|a, b| a.area_um2.total_cmp(&b.area_um2)),
    }
}

fn fits(memory: &UnmappedMemory, shape: MemoryShape) -> bool {
    memory.is_clocked && shape.ports as u64 >= memory.reads + memory.writes && shape.width > 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn library(cells: &str) -> LibertyLibrary {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.lib");
        std::fs::write(&path, format!("library (m) {{ {cells} }}")).unwrap();
        LibertyLibrary::read(Path::new(&path)).unwrap()
    }

    fn memory(words: u64, width: u64, is_clocked: bool) -> UnmappedMemory {
        UnmappedMemory {
            name: "u".to_owned(),
            width,
            words,
            reads: 1,
            writes: 1,
            is_clocked,
            count: 3,
        }
    }

    fn ram(name: &str, area: u32, (address, width): (u32, u32), ports: usize) -> String {
        let port = "bus (Q) { memory_read () { address : A; } } ".repeat(ports);
        format!(
            "cell ({name}) {{ area : {area}; memory () {{ address_width : {address}; word_width : {width}; }} {port} }} "
        )
    }

    #[test]
    fn the_smallest_macros_with_enough_ports_are_chosen() {
        let one_port = ram("one", 10, (6, 32), 1);
        let libraries = [
            library(&(one_port + &ram("small", 100, (6, 16), 2))),
            library(&ram("large", 350, (8, 16), 2)),
        ];
        let choice = |words, width| {
            plan_memory(&memory(words, width, true), &libraries)
                .macros
                .map(|own| (own.name, own.count, own.area_um2))
        };
        assert_eq!(choice(64, 16), Some(("small".to_owned(), 1, 100.0)));
        assert_eq!(choice(65, 17), Some(("small".to_owned(), 4, 400.0)));
        assert_eq!(choice(256, 16), Some(("large".to_owned(), 1, 350.0)));
        assert_eq!(choice(300, 31), Some(("small".to_owned(), 10, 1000.0)));
        let asynchronous = plan_memory(&memory(64, 16, false), &libraries);
        assert_eq!((asynchronous.bits(), asynchronous.macros), (3 * 64 * 16, None));
    }
}
