// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search for the first difference of each port: in two files of records, or in the output of a
//! replay bench.

use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::recording::{Recording, open_buffered};
use std::io::Read;
use std::path::Path;

/// A port that differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PortDifference {
    /// The clock, from 0.
    pub clock: u64,
    /// The name of the port.
    pub port: String,
    /// The lane of the port.
    pub lane: u32,
    /// The value of the model, in hexadecimal.
    pub expected: String,
    /// The value of the simulator, in hexadecimal; `x` and `z` are those that Icarus prints.
    pub got: String,
}

/// The result of a comparison of two files.
pub(crate) struct FileComparison {
    /// The number of complete records that the simulator wrote, up to the end of the sequence with
    /// the first difference.
    pub(crate) records: u64,
    /// The first difference of each port until the end of that sequence.
    pub(crate) differences: Vec<PortDifference>,
}

/// Compares the outputs of a simulator with those of the recording, up to the end of the first
/// sequence with a difference.
pub(crate) fn compare(recording: &Recording, actual: &Path) -> Result<FileComparison, CosimError> {
    let layout = recording.outputs();
    let bytes = layout.record_bytes();
    let batch = (1 << 18) / bytes.max(1) + 1;
    let expected_path = recording.expected_path();
    let (mut expected, mut actual_file) = (open_buffered(&expected_path)?, open_buffered(actual)?);
    let (mut wanted, mut got) = (vec![0; batch * bytes], vec![0; batch * bytes]);
    let (mut records, mut end, mut differences) = (0, u64::MAX, Vec::new());
    loop {
        let read =
            read_up_to(&mut actual_file, &mut got).map_err(CosimError::io("read", actual))?;
        let complete = read / bytes.max(1);
        let wanted = &mut wanted[..complete * bytes];
        let filled =
            read_up_to(&mut expected, wanted).map_err(CosimError::io("read", &expected_path))?;
        let pairs = wanted[..filled].chunks_exact(bytes).zip(got.chunks_exact(bytes));
        for (wanted, got) in pairs {
            if records >= end {
                return Ok(FileComparison { records, differences });
            }
            if wanted != got {
                add_differences(&mut differences, layout, records, wanted, got);
                if let Some(first) = differences.first() {
                    end = recording.sequence(first.clock).end;
                }
            }
            records += 1;
        }
        if complete < batch {
            return Ok(FileComparison { records, differences });
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

/// Adds the ports that differ at this clock and are not among `found`, each with its first lane.
fn add_differences(
    found: &mut Vec<PortDifference>,
    layout: &RecordLayout,
    clock: u64,
    wanted: &[u8],
    got: &[u8],
) {
    for field in
        layout.fields().iter().filter(|field| field.bytes_in(wanted) != field.bytes_in(got))
    {
        let is_known = found.iter().any(|difference| difference.port == field.port.name);
        let mut lanes = layout.compared_lanes(field, wanted);
        let differs = |&lane: &u32| field.get(wanted, lane) != field.get(got, lane);
        if let (false, Some(lane)) = (is_known, lanes.find(differs)) {
            let digits = field.port.width.div_ceil(4) as usize;
            let hex = |record| format!("{:0digits$x}", field.get(record, lane));
            let port = field.port.name.clone();
            found.push(PortDifference { clock, port, lane, expected: hex(wanted), got: hex(got) });
        }
    }
}

/// Parses a line that a replay bench prints for a mismatch.
pub(crate) fn parse_mismatch(line: &str) -> Option<PortDifference> {
    let mut words = line.strip_prefix("MISMATCH ")?.split_whitespace();
    let mut difference = PortDifference {
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

/// Parses the number of clocks in the line that a replay bench prints at its end.
pub(crate) fn parse_clocks(line: &str) -> Option<u64> {
    line.strip_prefix("PASS ")?.strip_suffix(" clocks")?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Recorder;
    use crate::testing::port;
    use foveate_design::PortDirection;

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

    /// Returns a recording of `clocks` clocks whose output is the clock number, in two lanes.
    fn counting(clocks: u8) -> Recording {
        let ports =
            [port("a_i", PortDirection::Input, 1, 1), port("b_o", PortDirection::Output, 4, 2)];
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
        assert_eq!(compare(&recording, &actual).unwrap().differences, []);
        (bytes[0x73], bytes[0x90]) = (0x63, 0);
        std::fs::write(&actual, &bytes).unwrap();
        let compared = compare(&recording, &actual).unwrap();
        let [found] = &compared.differences[..] else { panic!("{:?}", compared.differences) };
        assert_eq!((found.clock, found.lane), (0x73, 1));
        assert_eq!((found.expected.as_str(), found.got.as_str()), ("7", "6"));
    }

    #[test]
    fn every_port_is_found_at_its_first_clock_until_the_sequence_ends() {
        let output = |name| port(name, PortDirection::Output, 8, 1);
        let ports = [port("a_i", PortDirection::Input, 1, 1), output("b_o"), output("c_o")];
        let mut recorder = Recorder::new(&ports).unwrap();
        for clock in 0..30u8 {
            if clock % 5 == 0 {
                recorder.begin_frame("two frames", u64::from(clock / 5 % 2), None);
            }
            recorder.push(&[0], &[clock, clock]).unwrap();
        }
        let recording = recorder.finish().unwrap();
        assert_eq!(recording.sequence(12), 10..20);
        let actual = recording.folder().join("actual");
        let found = |wrong: &[(usize, usize)]| {
            let mut bytes: Vec<u8> = (0..30).flat_map(|clock| [clock, clock]).collect();
            wrong.iter().for_each(|&(clock, port)| bytes[2 * clock + port] = 99);
            std::fs::write(&actual, &bytes).unwrap();
            let differences = compare(&recording, &actual).unwrap().differences;
            differences.into_iter().map(|d| (d.clock, d.port)).collect::<Vec<_>>()
        };
        let (b, c) = ("b_o".to_owned(), "c_o".to_owned());
        assert_eq!(found(&[(12, 1), (13, 1), (19, 0)]), [(12, c.clone()), (19, b.clone())]);
        assert_eq!(found(&[(12, 0), (12, 1)]), [(12, b), (12, c.clone())]);
        assert_eq!(found(&[(12, 1), (20, 0)]), [(12, c)], "a reset is between them");
    }

    #[test]
    fn a_short_file_is_noticed() {
        let recording = counting(200);
        let actual = recording.folder().join("actual");
        std::fs::write(&actual, [0, 1, 2]).unwrap();
        let compared = compare(&recording, &actual).unwrap();
        assert_eq!((compared.records, compared.differences), (3, Vec::new()));
    }
}
