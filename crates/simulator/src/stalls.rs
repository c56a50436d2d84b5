// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of the stalls of a sink, which a run reads ([`read_stalls`]).

use crate::SimulatorError;
use csv::{ReaderBuilder, StringRecord};
use foveate_tools::{open_file, table_reader};
use std::ops::Range;
use std::path::Path;

/// The largest number of stalls, which take 64 MiB.
const MAX_STALLS: usize = 1 << 22;

/// The largest number of characters of a wrong line in a message.
const SHOWN_CHARACTERS: usize = 60;

/// Reads a table of stalls. It has the columns `clock` and `clocks`: the first edge at which the
/// sink takes no word, and the number of these edges.
///
/// # Errors
/// Fails if the file cannot be read, or if it is no list of stalls in order and without overlaps.
pub fn read_stalls(path: &Path) -> Result<Vec<Range<u64>>, SimulatorError> {
    read_stalls_up_to(path, MAX_STALLS)
}

/// Reads a table of at most `most` stalls.
fn read_stalls_up_to(path: &Path, most: usize) -> Result<Vec<Range<u64>>, SimulatorError> {
    let refuse = |problem: String| SimulatorError::Stalls { path: path.to_owned(), problem };
    let file = open_file(path).map_err(|error| refuse(error.to_string()))?;
    let mut table = table_reader(&ReaderBuilder::new(), file);
    let names = table.headers().map_err(|error| refuse(error.to_string()))?;
    if names.iter().ne(["clock", "clocks"]) {
        let found = shown_line(names);
        return Err(refuse(format!("its first line is `{found}`, and must be `clock,clocks`")));
    }
    let mut stalls: Vec<Range<u64>> = Vec::new();
    for record in table.records() {
        let record = record.map_err(|error| refuse(error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |place: usize| record.get(place).and_then(|text| text.parse::<u64>().ok());
        let (Some(first), Some(length @ 1..)) = (number(0), number(1)) else {
            let text = shown_line(&record);
            return Err(refuse(format!(
                "line {line} is `{text}`, and must be a clock from 0 and a number of clocks from 1"
            )));
        };
        let before = stalls.last().map_or(0, |stall| stall.end);
        if first < before {
            return Err(refuse(format!(
                "the stall of line {line} begins at clock {first}, but the one before it ends at \
                 clock {before}; list stalls in order, without overlaps"
            )));
        }
        if stalls.len() == most {
            return Err(refuse(format!(
                "it has more than {most} stalls; give a rate, or a shorter clip"
            )));
        }
        stalls.push(first..first.saturating_add(length));
    }
    Ok(stalls)
}

/// Returns the start of a line for a message.
fn shown_line(record: &StringRecord) -> String {
    let line = record.iter().collect::<Vec<_>>().join(",");
    let mut characters = line.chars();
    let shown: String = characters.by_ref().take(SHOWN_CHARACTERS).collect();
    if characters.next().is_some() { shown + "..." } else { shown }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THREE_STALLS: &str = "clock,clocks\n0,2\n5,1\n6,3\n";

    fn stalls_of(text: &str, most: usize) -> Result<Vec<Range<u64>>, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        read_stalls_up_to(file.path(), most).map_err(|error| error.to_string())
    }

    #[test]
    fn stalls_are_in_order_and_do_not_overlap() {
        assert_eq!(stalls_of(THREE_STALLS, MAX_STALLS), Ok(vec![0..2, 5..6, 6..9]));
        assert_eq!(stalls_of("clock,clocks\n", MAX_STALLS), Ok(vec![]));
        for (text, part) in [
            ("0,2\n", "its first line is `0,2`, and must be `clock,clocks`"),
            ("clock,clocks\n3,0\n", "line 2 is `3,0`, and must be"),
            ("clock,clocks\n-1,4\n", "line 2 is `-1,4`"),
            (
                "clock,clocks\n0,4\n3,1\n",
                "line 3 begins at clock 3, but the one before it ends at clock 4",
            ),
            ("clock,clocks\n0\n", "found record with 1 fields"),
        ] {
            let error = stalls_of(text, MAX_STALLS).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn a_table_has_at_most_the_largest_number_of_stalls() {
        assert_eq!(stalls_of(THREE_STALLS, 3).unwrap().len(), 3);
        let error = stalls_of(THREE_STALLS, 2).unwrap_err();
        let problem = "it has more than 2 stalls; give a rate, or a shorter clip";
        assert!(error.ends_with(problem), "{error}");
    }
}
