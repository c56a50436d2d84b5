// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds the first output that differs: in two files of records, or in what a replay bench prints.

use crate::error::CosimError;
use crate::layout::Layout;
use crate::recording::{Recording, open};
use std::io::Read;
use std::path::Path;

/// The first output that differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The clock, from 0.
    pub clock: u64,
    /// The port.
    pub port: String,
    /// The lane of the port.
    pub lane: u32,
    /// What the model says, hexadecimal.
    pub expected: String,
    /// What the simulator says, hexadecimal; `x` and `z` as Icarus prints them.
    pub got: String,
}

/// How far two files agree.
pub(crate) struct Compared {
    /// Complete records that the simulator wrote, up to the first difference.
    pub(crate) records: u64,
    pub(crate) difference: Option<Difference>,
}

/// Compares what a simulator wrote with what the recording expects.
pub(crate) fn compare(recording: &Recording, actual: &Path) -> Result<Compared, CosimError> {
    let layout = recording.outputs();
    let bytes = layout.record_bytes();
    let batch = (1 << 18) / bytes.max(1) + 1;
    let expected_path = recording.expected_path();
    let (mut expected, mut actual_file) = (open(&expected_path)?, open(actual)?);
    let (mut wanted, mut got) = (vec![0; batch * bytes], vec![0; batch * bytes]);
    let mut records = 0;
    loop {
        let read =
            read_up_to(&mut actual_file, &mut got).map_err(CosimError::io("read", actual))?;
        let complete = read / bytes.max(1);
        let wanted = &mut wanted[..complete * bytes];
        let filled =
            read_up_to(&mut expected, wanted).map_err(CosimError::io("read", &expected_path))?;
        let pairs = wanted[..filled].chunks_exact(bytes).zip(got.chunks_exact(bytes));
        for (wanted, got) in pairs {
            if wanted != got
                && let Some(difference) = first_difference(layout, records, wanted, got)
            {
                return Ok(Compared { records, difference: Some(difference) });
            }
            records += 1;
        }
        if complete < batch {
            return Ok(Compared { records, difference: None });
        }
    }
}

fn read_up_to(file: &mut impl Read, buffer: &mut [u8]) -> std::io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match file.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(count) => filled += count,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
}

fn first_difference(layout: &Layout, clock: u64, wanted: &[u8], got: &[u8]) -> Option<Difference> {
    let differing = layout.fields().iter().filter(|field| field.slice(wanted) != field.slice(got));
    differing.into_iter().find_map(|field| {
        let mut lanes = layout.compared_lanes(field, wanted);
        let lane = lanes.find(|&lane| field.get(wanted, lane) != field.get(got, lane))?;
        let digits = field.port.width.div_ceil(4) as usize;
        let hex = |record| format!("{:0digits$x}", field.get(record, lane));
        let port = field.port.name.clone();
        Some(Difference { clock, port, lane, expected: hex(wanted), got: hex(got) })
    })
}

/// Reads a line that a replay bench prints for a mismatch.
pub(crate) fn parse_mismatch(line: &str) -> Option<Difference> {
    let mut words = line.strip_prefix("MISMATCH ")?.split_whitespace();
    let mut difference = Difference {
        clock: 0,
        port: String::new(),
        lane: 0,
        expected: String::new(),
        got: String::new(),
    };
    while let (Some(key), Some(value)) = (words.next(), words.next()) {
        match key {
            "clock" => difference.clock = value.parse().ok()?,
            "port" => difference.port = value.to_owned(),
            "lane" => difference.lane = value.parse().ok()?,
            "expected" => difference.expected = value.to_owned(),
            "got" => difference.got = value.to_owned(),
            _ => return None,
        }
    }
    Some(difference)
}

/// Reads how many clocks a replay bench says it has passed.
pub(crate) fn parse_clocks(line: &str) -> Option<u64> {
    line.strip_prefix("PASS ")?.strip_suffix(" clocks")?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Recorder;
    use crate::testing::port;
    use foveate_design::Direction;

    #[test]
    fn lines_of_the_bench_are_read() {
        let line = "MISMATCH clock 12 port srs_o lane 3 expected 1 got x";
        let difference = parse_mismatch(line).unwrap();
        assert_eq!((difference.clock, difference.lane), (12, 3));
        assert_eq!((difference.port.as_str(), difference.got.as_str()), ("srs_o", "x"));
        assert!(parse_mismatch("MISMATCH clock x").is_none());
        assert_eq!(parse_clocks("PASS 17 clocks"), Some(17));
        assert_eq!(parse_clocks("FAIL 17 clocks"), None);
    }

    /// A recording of `clocks` clocks whose output is the clock number, in two lanes.
    fn counting(clocks: u8) -> Recording {
        let ports = [port("a_i", Direction::Input, 1, 1), port("b_o", Direction::Output, 4, 2)];
        let mut recorder = Recorder::new(&ports).unwrap();
        (0..clocks).for_each(|clock| recorder.push(&[0], &[clock]).unwrap());
        recorder.finish().unwrap()
    }

    #[test]
    fn the_first_difference_is_found_at_its_lane() {
        let recording = counting(200);
        let actual = recording.folder().join("actual");
        let mut bytes: Vec<u8> = (0..200).collect();
        std::fs::write(&actual, &bytes).unwrap();
        assert!(compare(&recording, &actual).unwrap().difference.is_none());
        (bytes[0x73], bytes[0x90]) = (0x63, 0);
        std::fs::write(&actual, &bytes).unwrap();
        let found = compare(&recording, &actual).unwrap().difference.unwrap();
        assert_eq!((found.clock, found.lane), (0x73, 1));
        assert_eq!((found.expected.as_str(), found.got.as_str()), ("7", "6"));
    }

    #[test]
    fn a_short_file_is_noticed() {
        let recording = counting(200);
        let actual = recording.folder().join("actual");
        std::fs::write(&actual, [0, 1, 2]).unwrap();
        let compared = compare(&recording, &actual).unwrap();
        assert_eq!((compared.records, compared.difference), (3, None));
    }
}
