// SPDX-License-Identifier: MIT OR Apache-2.0
//! A library of cells: their areas, the cells that a mapping needs, and the memories among them.

use std::collections::BTreeMap;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use foveate_tools::{LimitedReader, Source, open_file, sha256_hex, unpacked};

use super::error::SiliconError;
use super::liberty_text::{LibertyGroup, parse_library};
use super::logic_function::truth_table;

/// The name of the file of a library among the sources of a tool.
pub(super) const CELLS: &str = "cells.lib";
/// The largest file in bytes, after decompression. Libraries of a process have 2 to 100 MB.
const FILE_LIMIT: u64 = 400_000_000;

/// A library of cells or of memories, from a liberty file.
#[derive(Clone, Debug)]
pub struct LibertyLibrary {
    /// The file that it comes from.
    pub path: PathBuf,
    /// The name of the library.
    pub name: String,
    /// The hash of the file's text.
    pub sha256: String,
    text: String,
    /// The nominal voltage in volts, if the file has one.
    pub(super) voltage: Option<f64>,
    /// The unit of times in nanoseconds.
    pub(super) time_unit_ns: f64,
    pub(super) cells: BTreeMap<String, LibertyCell>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct LibertyCell {
    /// The area in square micrometres.
    pub(super) area: Option<f64>,
    pub(super) role: CellRole,
}

/// The part of a cell in a circuit, as far as it matters here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CellRole {
    /// One input, and an output with the same value.
    Buffer,
    /// The NAND of two inputs, whose smallest area is that of a gate equivalent.
    Nand2,
    FlipFlop,
    Latch,
    Memory(MemoryShape),
    Other,
}

/// The size of a memory macro.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MemoryShape {
    pub(super) words: u64,
    pub(super) width: u64,
    /// The number of ports that can read at the same time.
    pub(super) ports: usize,
}

impl LibertyLibrary {
    /// Reads a library from a file, which may be compressed by gzip.
    ///
    /// # Errors
    /// Fails if the file cannot be read, is larger than 400 MB, is no liberty file with one
    /// library, or has no cell.
    pub fn read(path: &Path) -> Result<Self, SiliconError> {
        let text = read_text(path)
            .map_err(|source| SiliconError::Unreadable { path: path.to_owned(), source })?;
        let library = parse_library(&text).map_err(|fault| SiliconError::Liberty {
            path: path.to_owned(),
            line: fault.line,
            problem: fault.problem,
        })?;
        let cells: BTreeMap<_, _> = library
            .groups_of("cell")
            .map(|cell| (cell.name.clone(), LibertyCell::from_group(cell)))
            .collect();
        if cells.is_empty() {
            return Err(SiliconError::NoCells { path: path.to_owned() });
        }
        Ok(Self {
            path: path.to_owned(),
            voltage: nominal_voltage(&library),
            time_unit_ns: time_unit_ns(&library),
            name: library.name,
            sha256: sha256_hex(text.as_bytes()),
            cells,
            text,
        })
    }

    /// Returns the text of the file.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// Returns the file of the library, [`CELLS`], for a tool.
    pub(super) fn source(&self) -> Source {
        (CELLS.to_owned(), self.text.clone())
    }

    /// Returns the file of the library for a timer, without a choice of wire loads: wires are in no
    /// figure, and OpenSTA of 2019 adds those that the library chooses, while later versions do
    /// not.
    pub(super) fn source_without_wires(&self) -> Source {
        (CELLS.to_owned(), without_wire_loads(&self.text))
    }

    /// Returns the area of a gate equivalent, that of the smallest NAND of two inputs.
    pub(super) fn gate_area(&self) -> Option<f64> {
        self.areas_of(CellRole::Nand2).map(|(_, area)| area).reduce(f64::min)
    }

    pub(super) fn smallest_buffer(&self) -> Option<&str> {
        let smaller = |a: &(&str, f64), b: &(&str, f64)| a.1.total_cmp(&b.1);
        self.areas_of(CellRole::Buffer).min_by(smaller).map(|(name, _)| name)
    }

    /// Returns the memories with their areas.
    pub(super) fn memories(&self) -> impl Iterator<Item = (&str, MemoryShape, f64)> {
        self.cells.iter().filter_map(|(name, cell)| match cell.role {
            CellRole::Memory(shape) => Some((name.as_str(), shape, cell.positive_area()?)),
            _ => None,
        })
    }

    fn areas_of(&self, role: CellRole) -> impl Iterator<Item = (&str, f64)> {
        let cells = self.cells.iter().filter(move |(_, cell)| cell.role == role);
        cells.filter_map(|(name, cell)| Some((name.as_str(), cell.positive_area()?)))
    }
}

impl LibertyCell {
    fn from_group(cell: &LibertyGroup) -> Self {
        let area = cell.attribute("area").and_then(|area| area.trim().parse::<f64>().ok());
        let area = area.filter(|area| area.is_finite() && *area >= 0.0);
        Self { area, role: CellRole::from_group(cell) }
    }

    /// Returns the area of a cell that takes any.
    fn positive_area(&self) -> Option<f64> {
        self.area.filter(|&area| area > 0.0)
    }
}

impl CellRole {
    fn from_group(cell: &LibertyGroup) -> Self {
        let has = |kind| cell.groups_of(kind).next().is_some();
        if let Some(shape) = MemoryShape::from_group(cell) {
            return Self::Memory(shape);
        }
        if has("ff") || has("ff_bank") {
            return Self::FlipFlop;
        }
        if has("latch") || has("latch_bank") {
            return Self::Latch;
        }
        let is_excluded = cell.attribute("dont_use").is_some_and(|value| value == "true");
        let pins = |direction: &'static str| {
            let pins = cell.groups_of("pin");
            pins.filter(move |pin| pin.attribute("direction") == Some(direction))
        };
        let inputs: Vec<&str> = pins("input").map(|pin| pin.name.as_str()).collect();
        let outputs: Vec<&LibertyGroup> = pins("output").collect();
        let &[output] = outputs.as_slice() else { return Self::Other };
        let function = output.attribute("function").unwrap_or_default();
        let has_states = output.attribute("three_state").is_some();
        match truth_table(function, &inputs).as_deref() {
            _ if is_excluded || has_states => Self::Other,
            Some([false, true]) => Self::Buffer,
            Some([true, true, true, false]) => Self::Nand2,
            _ => Self::Other,
        }
    }
}

impl MemoryShape {
    fn from_group(cell: &LibertyGroup) -> Option<Self> {
        let memory = cell.groups_of("memory").next()?;
        let number = |name| memory.attribute(name)?.trim().parse().ok();
        let (address_width, width): (u32, u64) =
            (number("address_width")?, number("word_width")?.into());
        let pins = cell.groups_of("bus").chain(cell.groups_of("pin"));
        let ports = pins.filter(|pin| pin.groups_of("memory_read").next().is_some()).count();
        Some(Self { words: 1_u64.checked_shl(address_width)?, width, ports })
    }
}

/// Returns the voltage of the library, or that of its default operating conditions.
fn nominal_voltage(library: &LibertyGroup) -> Option<f64> {
    let number = |text: &str| {
        text.trim().parse().ok().filter(|volts: &f64| volts.is_finite() && *volts > 0.0)
    };
    let of_conditions = || {
        let name = library.attribute("default_operating_conditions")?;
        let conditions = library.groups_of("operating_conditions").find(|own| own.name == name)?;
        conditions.attribute("voltage").and_then(number)
    };
    library.attribute("nom_voltage").and_then(number).or_else(of_conditions)
}

/// Replaces the attributes by which a library chooses wire loads by comments.
fn without_wire_loads(text: &str) -> String {
    const CHOICES: [&str; 3] =
        ["default_wire_load", "default_wire_load_selection", "wire_load_selection"];
    let is_of_name = |letter: char| letter.is_alphanumeric() || letter == '_';
    let (mut replaced, mut rest) = (String::with_capacity(text.len()), text);
    while let Some(start) = rest.find(is_of_name) {
        let (before, at) = rest.split_at(start);
        let (name, behind) = at.split_at(at.find(|letter| !is_of_name(letter)).unwrap_or(at.len()));
        let is_choice = CHOICES.contains(&name) && behind.trim_start().starts_with(':');
        replaced.extend([before, if is_choice { "comment" } else { name }]);
        rest = behind;
    }
    replaced + rest
}

/// Returns the unit of times, which is a nanosecond if the library does not say.
fn time_unit_ns(library: &LibertyGroup) -> f64 {
    match library.attribute("time_unit").map(str::trim) {
        Some("100ps") => 0.1,
        Some("10ps") => 0.01,
        Some("1ps") => 0.001,
        _ => 1.0,
    }
}

fn read_text(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    LimitedReader::new(unpacked(open_file(path)?)?, FILE_LIMIT).read_to_end(&mut bytes)?;
    // Comments may have letters in other encodings.
    let text = String::from_utf8_lossy(&bytes);
    Ok(text.trim_start_matches('\u{feff}').to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;

    const CELLS: &str = r#"library (tiny) {
        nom_voltage : 1.8;
        cell (INV) { area : 3; pin (A) { direction : input; } pin (Y) { direction : output; function : "(!A)"; } }
        cell (BUF2) { area : 5; pin (A) { direction : input; } pin (Y) { direction : output; function : "A"; } }
        cell (BUF1) { area : 4; pin (A) { direction : input; } pin (Y) { direction : output; function : "A"; } }
        cell (DLY) { area : 1; dont_use : true; pin (A) { direction : input; } pin (Y) { direction : output; function : "A"; } }
        cell (TBUF) { area : 1; pin (A) { direction : input; } pin (E) { direction : input; }
            pin (Y) { direction : output; function : "A"; three_state : "!E"; } }
        cell (ND4) { area : 9; pin (A) { direction : input; } pin (B) { direction : input; }
            pin (Y) { direction : output; function : "!(A B)"; } }
        cell (ND1) { area : 6; pin (A) { direction : input; } pin (B) { direction : input; }
            pin (Y) { direction : output; function : "!A + !B"; } }
        cell (DFF) { area : 20; ff (IQ, IQN) { clocked_on : "CK"; } pin (D) { direction : input; } }
        cell (LAT) { latch (IQ, IQN) { enable : "G"; } }
        cell (RAM) { area : 5000; memory () { type : ram; address_width : 6; word_width : 32; }
            bus (A_DOUT) { memory_read () { address : A; } } bus (B_DOUT) { memory_read () { address : B; } } }
    }"#;

    #[test]
    fn no_wire_load_is_chosen_for_a_timer() {
        let text = "default_wire_load : \"Small\" ; default_wire_load_mode : top;\n\
                    default_wire_load_selection:\"s\";\n  wire_load_selection : \"s\";\n\
                    wire_load_selection (\"s\") { wire_load_from_area (0, 1, \"Small\"); } wire_load (\"Small\") {}";
        let expected = "comment : \"Small\" ; default_wire_load_mode : top;\n\
                        comment:\"s\";\n  comment : \"s\";\n\
                        wire_load_selection (\"s\") { wire_load_from_area (0, 1, \"Small\"); } wire_load (\"Small\") {}";
        assert_eq!(without_wire_loads(text), expected);
    }

    #[test]
    fn cells_have_areas_and_roles() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("tiny.lib");
        std::fs::write(&path, CELLS).unwrap();
        let library = LibertyLibrary::read(&path).unwrap();
        assert_eq!((library.name.as_str(), library.voltage), ("tiny", Some(1.8)));
        assert_eq!((library.gate_area(), library.smallest_buffer()), (Some(6.0), Some("BUF1")));
        let role = |name: &str| library.cells[name].role;
        for (name, expected) in [
            ("INV", CellRole::Other),
            ("BUF2", CellRole::Buffer),
            ("DLY", CellRole::Other),
            ("TBUF", CellRole::Other),
            ("ND4", CellRole::Nand2),
            ("DFF", CellRole::FlipFlop),
            ("LAT", CellRole::Latch),
        ] {
            assert_eq!(role(name), expected, "{name}");
        }
        assert_eq!(library.cells["LAT"].area, None);
        let shape = MemoryShape { words: 64, width: 32, ports: 2 };
        assert_eq!(library.memories().collect::<Vec<_>>(), [("RAM", shape, 5000.0)]);
    }

    #[test]
    fn a_compressed_library_is_the_same() {
        let dir = tempfile::tempdir().unwrap();
        let (plain, packed) = (dir.path().join("a.lib"), dir.path().join("b.lib.gz"));
        std::fs::write(&plain, CELLS).unwrap();
        let file = std::fs::File::create(&packed).unwrap();
        let mut gzip = flate2::write::GzEncoder::new(file, flate2::Compression::default());
        gzip.write_all(CELLS.as_bytes()).unwrap();
        gzip.finish().unwrap();
        let [plain, packed] = [plain, packed].map(|path| LibertyLibrary::read(&path).unwrap());
        assert_eq!((plain.sha256, plain.cells), (packed.sha256, packed.cells));
    }

    #[test]
    fn other_files_are_refused_with_their_name() {
        let dir = tempfile::tempdir().unwrap();
        for (name, content, words) in [
            ("a.lib", &b"library (a) {"[..], "line 1: the file ends within a group"),
            ("b.lib", b"library (b) { }", "has no cell"),
            ("c.lib", &[0xFF, 0xFE], "line 1"),
            ("d.lib", &[0x1F, 0x8B, 1, 2], "d.lib"),
            ("e.lib", b"module rpu (); endmodule", "e.lib"),
        ] {
            let path = dir.path().join(name);
            std::fs::write(&path, content).unwrap();
            let message = LibertyLibrary::read(&path).unwrap_err().to_string();
            assert!(message.contains(words) && message.contains(name), "{message}");
        }
        let missing = LibertyLibrary::read(&dir.path().join("none.lib")).unwrap_err().to_string();
        assert!(missing.contains("none.lib"), "{missing}");
    }
}
