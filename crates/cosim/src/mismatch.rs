// SPDX-License-Identifier: MIT OR Apache-2.0
//! The first difference between a simulation and its recording, in terms of the vectors: every
//! port that differs, with its place, its time and its region ([`Mismatch`]). Differences are
//! found in two files of records ([`compare`]), or in the output of a replay bench
//! ([`parse_mismatch`]).

use crate::core_activity::{CoreActivity, core_activities};
use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::level::CosimLevel;
use crate::recording::{Recording, open_buffered};
use foveate_design::{BeatRegion, Design, PortRole};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::io::Read;
use std::path::Path;

/// The first output that differs, and the other ports that differ until the end of its sequence.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mismatch {
    /// The name of the sequence of frames.
    pub sequence: String,
    /// The index of the frame in the sequence that was entering, from 0.
    pub frame: u64,
    /// The clock edge, counted from the first edge of the run.
    pub clock: u64,
    /// The clock edge, counted from the first edge of the frame.
    pub clock_in_frame: u64,
    /// The region; `None` if a single RPU gets generated pixels.
    pub region: Option<u32>,
    /// The output port.
    pub port: String,
    /// The score at the ports of a serial array, if the port belongs to a score: the name of a
    /// feature, or `temporal count`.
    pub score: Option<String>,
    /// The activity of the hardware: the pixel that enters, or the slot, phase and step of its
    /// work.
    #[serde(rename = "at")]
    pub activity: String,
    /// The value of the model, in hexadecimal.
    pub expected: String,
    /// The value of the simulator, in hexadecimal; unknown digits are `x`.
    #[serde(rename = "got")]
    pub actual: String,
    /// The ports that differ before the sequence ends, each at its first clock. Ports that differ
    /// at the same clock are in the order of the module. The first one is that of the fields above.
    pub ports: Vec<PortMismatch>,
}

/// The first clock at which a port differs. The fields are those of [`Mismatch`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "they are those of Mismatch")]
pub struct PortMismatch {
    pub port: String,
    pub clock: u64,
    pub region: Option<u32>,
    pub score: Option<String>,
    #[serde(rename = "at")]
    pub activity: String,
    pub expected: String,
    #[serde(rename = "got")]
    pub actual: String,
}

impl Mismatch {
    /// Returns the mismatch for the differences of one sequence, which are in order, or `None` if
    /// there are none.
    pub(crate) fn from_differences(
        differences: &[PortDifference],
        design: &Design,
        recording: &Recording,
        level: CosimLevel,
    ) -> Result<Option<Self>, CosimError> {
        let clocks: Vec<u64> = differences.iter().map(|difference| difference.clock).collect();
        let moments = core_activities(design, recording, &clocks)?;
        let named = |(difference, moment): (&PortDifference, &CoreActivity)| {
            port_mismatch(difference, moment, design, recording, level)
        };
        let ports: Vec<PortMismatch> =
            differences.iter().zip(&moments).map(named).collect::<Result<_, _>>()?;
        let Some(first) = ports.first().cloned() else { return Ok(None) };
        let span = recording.span(first.clock);
        let PortMismatch { port, clock, region, score, activity, expected, actual } = first;
        let sequence = span.map_or_else(String::new, |span| span.sequence.clone());
        let frame = span.map_or(0, |span| span.frame);
        let clock_in_frame = clock - span.map_or(0, |span| span.first_clock);
        #[rustfmt::skip]
        let mismatch = Self {
            sequence, frame, clock, clock_in_frame, region, port, score, activity, expected, actual, ports,
        };
        Ok(Some(mismatch))
    }
}

fn port_mismatch(
    difference: &PortDifference,
    moment: &CoreActivity,
    design: &Design,
    recording: &Recording,
    level: CosimLevel,
) -> Result<PortMismatch, CosimError> {
    let PortDifference { clock, port, expected, got, .. } = difference.clone();
    let record = recording.expected_at(clock)?;
    let first = recording.span(clock).and_then(|span| span.region);
    let layout = recording.outputs();
    let region = region_of_difference(design, level, layout, &record, difference, first);
    let role = layout.fields().iter().find(|field| field.port.name == port).map(|f| f.port.role);
    let is_score = matches!(
        role,
        Some(
            PortRole::ScoreValid
                | PortRole::ScoreIndex
                | PortRole::Region
                | PortRole::AnyScore
                | PortRole::DisplacementX
                | PortRole::DisplacementY
        )
    );
    let score = moment.score().filter(|_| is_score).map(str::to_owned);
    Ok(PortMismatch {
        port,
        clock,
        region,
        score,
        activity: moment.to_string(),
        expected,
        actual: got,
    })
}

impl fmt::Display for PortMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { port, clock, region, score, activity, expected, actual } = self;
        write!(f, "clock {clock}: {port}")?;
        if let Some(score) = score {
            write!(f, " ({score})")?;
        }
        if let Some(region) = region {
            write!(f, ", region {region},")?;
        }
        write!(f, " is 'h{actual}, expected 'h{expected}; {activity}")
    }
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { sequence, frame, clock, clock_in_frame, region, port, .. } = self;
        write!(f, "sequence \"{sequence}\", frame {frame}, clock {clock_in_frame} of it")?;
        write!(f, " ({clock} of the run)")?;
        if let Some(region) = region {
            write!(f, ", region {region}")?;
        }
        write!(f, ": {port}")?;
        if let Some(score) = &self.score {
            write!(f, " ({score})")?;
        }
        write!(f, " is 'h{}, expected 'h{}", self.actual, self.expected)
    }
}

/// Returns the region of a difference, if the expected outputs of that clock show it. `first` is
/// the region of the caller's frame that goes through the only RPU or lane, if it is known.
pub(crate) fn region_of_difference(
    design: &Design,
    level: CosimLevel,
    layout: &RecordLayout,
    expected: &[u8],
    difference: &PortDifference,
    first: Option<u32>,
) -> Option<u32> {
    let in_array = region_in_array(design, layout, expected, difference);
    match level {
        CosimLevel::Rpu if design.unit().regions == 1 => first,
        CosimLevel::Rpu => Some(first? + in_array?),
        CosimLevel::Rcm { .. } | CosimLevel::Full => in_array,
    }
}

/// Returns the region in the simulated array. The stream of the port gives it, by its lane or by
/// the port that numbers the region of a beat.
fn region_in_array(
    design: &Design,
    layout: &RecordLayout,
    expected: &[u8],
    difference: &PortDifference,
) -> Option<u32> {
    let fields = layout.fields();
    let says = |role| {
        let field = fields.iter().find(|field| field.port.role == role)?;
        let mut lanes = layout.compared_lanes(field, expected);
        u32::try_from(field.get(expected, lanes.next()?)).ok()
    };
    let role = fields.iter().find(|field| field.port.name == difference.port)?.port.role;
    match design.rcm_interface().stream_with_port(role)?.region {
        BeatRegion::None => None,
        BeatRegion::Lane => Some(difference.lane),
        BeatRegion::Slot(slot) => Some(difference.lane * design.slots() + says(slot)?),
        BeatRegion::Number(region) => says(region),
    }
}

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
    use foveate_design::{DesignConfig, PortDirection, PortRole};

    fn design(hardware: &str) -> Design {
        let toml = format!(
            "[frame]\nwidth = 24\nheight = 16\n[hardware]\norganization = \"serial\"\n{hardware}"
        );
        DesignConfig::from_toml(&toml).unwrap().validate().unwrap()
    }

    /// Returns the region of a difference at a port and lane, for a record with the given values.
    fn located_region(
        design: &Design,
        shown: &[(PortRole, u32, u64)],
        port: &str,
        lane: u32,
    ) -> Option<u32> {
        let layout = RecordLayout::outputs(&design.rcm_ports());
        let mut expected = layout.zero_record();
        for &(role, lane, value) in shown {
            let field = layout.fields().iter().find(|field| field.port.role == role).unwrap();
            field.set(&mut expected, lane, value);
        }
        let (port, expected_hex, got) = (port.to_owned(), String::new(), String::new());
        let difference = PortDifference { clock: 0, port, lane, expected: expected_hex, got };
        region_of_difference(design, CosimLevel::Full, &layout, &expected, &difference, None)
    }

    #[test]
    fn a_score_belongs_to_the_region_that_is_shown() {
        let design = design("");
        let shown = [(PortRole::ScoreValid, 0, 1), (PortRole::Region, 0, 4)];
        assert_eq!(located_region(&design, &shown, "score_o", 0), Some(4));
        assert_eq!(located_region(&design, &shown, "trs_o", 0), Some(4));
        assert_eq!(located_region(&design, &shown[1..], "score_valid_o", 0), None);
    }

    #[test]
    fn a_word_of_a_store_outside_belongs_to_no_region() {
        let toml = "[frame]\nwidth = 40\nheight = 16\n[hardware]\norganization = \"raster\"\n\
                    store = \"external\"\n";
        let design = DesignConfig::from_toml(toml).unwrap().validate().unwrap();
        let shown = [(PortRole::DecisionValid, 0, 1), (PortRole::Region, 0, 4)];
        assert_eq!(located_region(&design, &shown, "temporal_count_o", 0), Some(4));
        for port in ["reference_ready_o", "store_valid_o", "underrun_o"] {
            assert_eq!(located_region(&design, &shown, port, 0), None, "{port}");
        }
    }

    #[test]
    fn a_pixel_belongs_to_its_lane_and_slot_or_to_the_region_that_is_shown() {
        let plain = design("");
        assert_eq!(located_region(&plain, &[], "forward_valid_o", 5), Some(5));
        let folded = design("fold = 4\n");
        let shown = [(PortRole::ForwardValid, 0, 1), (PortRole::ForwardSlot, 0, 1)];
        assert_eq!(located_region(&folded, &shown, "forward_pixel_o", 1), Some(5));
        assert_eq!(located_region(&folded, &[], "forward_valid_o", 1), None);
        let raster = design("feed = \"raster\"\nfold = 4\n");
        let shown = [(PortRole::ForwardValid, 0, 1), (PortRole::ForwardRegion, 0, 3)];
        assert_eq!(located_region(&raster, &shown, "forward_pixel_o", 0), Some(3));
        assert_eq!(located_region(&raster, &shown, "forward_position_o", 0), Some(3));
    }

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
