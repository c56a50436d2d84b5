// SPDX-License-Identifier: MIT OR Apache-2.0
//! The speed of Verilator's model: it runs once from files, with every output compared, then from
//! memory.
//!
//! A co-simulation spends much of its time on files. To measure the model alone, the harness keeps
//! the inputs in memory and clocks them again, without files and without reading the outputs. A
//! recording begins with a reset, so every pass does the same work.

use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::recording::{Recording, open_buffered};
use crate::simulation::{DesignUnderTest, SimulationRun};
use foveate_tools::{Tool, verilator};
use std::io::Read as _;
use std::path::Path;
use std::time::{Duration, Instant};

/// The agreement of outputs with those of a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutputAgreement {
    /// The number of values that were compared.
    pub compared: u64,
    /// The number of values that differ.
    pub differing: u64,
}

impl OutputAgreement {
    /// Compares one more record and adds it to the counts.
    pub fn add(&mut self, layout: &RecordLayout, expected: &[u8], got: &[u8]) {
        self.compared += layout.compared_values(expected);
        self.differing += layout.differing_values(expected, got);
    }
}

/// The result of a timed run.
#[derive(Clone, Debug)]
pub struct TimedRun {
    /// The version of Verilator.
    pub version: String,
    /// The time to build the program.
    pub build: Duration,
    /// True if the program was found in the cache.
    pub is_cached: bool,
    /// The agreement of the outputs over all clocks.
    pub agreement: OutputAgreement,
    /// The time for one pass over the recording, from file to file.
    pub file_pass: Duration,
    /// The number of passes from memory.
    pub passes: u64,
    /// The time for all passes from memory, in seconds.
    pub memory_seconds: f64,
    /// The part of [`TimedRun::memory_seconds`] that unpacking the inputs takes.
    pub unpacking_seconds: f64,
    /// The largest memory of the process in bytes before it kept the inputs; `None` if the system
    /// does not report it.
    pub peak_bytes: Option<u64>,
}

impl SimulationRun<'_> {
    /// Builds Verilator's model, compares it with the recording, and times it from memory for
    /// `at_least`.
    ///
    /// # Errors
    /// Fails if there is no result; differences are a result.
    pub fn run_timed(
        &self,
        dut: &DesignUnderTest,
        recording: &Recording,
        at_least: Duration,
    ) -> Result<TimedRun, CosimError> {
        let version = self.toolchain.find(Tool::Verilator)?.banner;
        let is_cached = verilator::is_built(self.toolchain, self.cache, &self.verilator_job(dut))?;
        let start = Instant::now();
        let program = self.build(dut)?;
        let build = start.elapsed();

        let actual = recording.create_run_folder()?.join("actual.bin");
        let harness = self.harness_invocation(&program, recording, &actual);
        let start = Instant::now();
        let output = self.toolchain.run(&harness)?;
        let files = start.elapsed();
        if !output.is_success() {
            return Err(self.short_run_error(recording, 0, &output));
        }
        let agreement = compare_outputs(recording, &actual)?;

        let harness = harness.arg(at_least.as_secs_f64().max(1e-6).to_string());
        let output = self.toolchain.run(&harness)?;
        let log = output.log();
        let Some(line) = log.lines().rev().find_map(parse_timed) else {
            return Err(self.short_run_error(recording, 0, &output));
        };
        let peak_bytes = line.kilobytes.checked_mul(1024).filter(|&bytes| bytes > 0);
        let HarnessTimes { passes, seconds, unpacking_seconds: applying, .. } = line;
        Ok(TimedRun {
            version,
            build,
            is_cached,
            agreement,
            file_pass: files,
            passes,
            memory_seconds: seconds,
            unpacking_seconds: applying,
            peak_bytes,
        })
    }
}

/// Compares all that a simulator wrote. A missing record differs in every value.
fn compare_outputs(recording: &Recording, actual: &Path) -> Result<OutputAgreement, CosimError> {
    let layout = recording.outputs();
    let expected_path = recording.expected_path();
    let (mut expected, mut actual_file) = (open_buffered(&expected_path)?, open_buffered(actual)?);
    let (mut wanted, mut got) = (layout.zero_record(), layout.zero_record());
    let mut agreement = OutputAgreement::default();
    for _ in 0..recording.clocks() {
        expected.read_exact(&mut wanted).map_err(CosimError::io("read", &expected_path))?;
        match actual_file.read_exact(&mut got) {
            Ok(()) => agreement.add(layout, &wanted, &got),
            Err(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
                agreement.compared += layout.compared_values(&wanted);
                agreement.differing += layout.compared_values(&wanted);
            }
            Err(error) => return Err(CosimError::io("read", actual)(error)),
        }
    }
    Ok(agreement)
}

/// The line in which the harness reports its times.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HarnessTimes {
    passes: u64,
    seconds: f64,
    unpacking_seconds: f64,
    kilobytes: u64,
}

fn parse_timed(line: &str) -> Option<HarnessTimes> {
    let mut words = line.strip_prefix("TIMED ")?.split_whitespace();
    let mut value = |name| if words.next()? == name { words.next() } else { None };
    Some(HarnessTimes {
        passes: value("passes")?.parse().ok()?,
        seconds: value("seconds")?.parse().ok()?,
        unpacking_seconds: value("applying")?.parse().ok()?,
        kilobytes: value("kilobytes")?.parse().ok()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Recorder;
    use crate::testing::port;
    use foveate_design::PortDirection;

    #[test]
    fn the_line_of_the_harness_is_read() {
        let line = "TIMED passes 3 seconds 1.5 applying 0.25 kilobytes 4096";
        let wanted =
            HarnessTimes { passes: 3, seconds: 1.5, unpacking_seconds: 0.25, kilobytes: 4096 };
        assert_eq!(parse_timed(line), Some(wanted));
        for line in ["TIMED passes 3", "TIMED seconds 3 passes 1", "done"] {
            assert_eq!(parse_timed(line), None, "{line}");
        }
    }

    #[test]
    fn every_difference_counts_and_so_does_what_is_missing() {
        let ports =
            [port("a_i", PortDirection::Input, 1, 1), port("b_o", PortDirection::Output, 4, 2)];
        let mut recorder = Recorder::new(&ports).unwrap();
        (0..100).for_each(|clock| recorder.push(&[0], &[clock]).unwrap());
        let recording = recorder.finish().unwrap();
        let actual = recording.folder().join("actual");
        let mut bytes: Vec<u8> = (0..100).collect();
        let counted = |bytes: &[u8]| {
            std::fs::write(&actual, bytes).unwrap();
            let OutputAgreement { compared, differing } =
                compare_outputs(&recording, &actual).unwrap();
            (compared, differing)
        };
        assert_eq!(counted(&bytes), (200, 0));
        (bytes[0x13], bytes[0x20]) = (0x14, 0x31);
        assert_eq!(counted(&bytes), (200, 3));
        assert_eq!(counted(&bytes[..90]), (200, 3 + 20));
    }
}
