// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run on the buses leaves: the activity on the ports of a core ([`BusRecord`]), read
//! from the lines that the program prints, and, if the run fails, the first difference
//! ([`BusMismatch`]) and a folder that reproduces it ([`BusReplay`]).

use crate::error::CosimError;
use crate::harness::render;
use crate::mismatch::{Mismatch, PortMismatch};
use crate::replay::{
    README, REPLAY, SCRIPT, TRAFFIC_FILE, copy_waves, make_executable, write_file,
};
use askama::Template;
use foveate_tools::escaping::shell_word;
use foveate_tools::{Source, StagedFolder};
use std::fmt::LowerHex;
use std::fs;
use std::io::BufRead;
use std::path::{Path, PathBuf};

#[derive(Template)]
#[template(path = "axi_replay.sh")]
struct BusReplayScript<'a> {
    top: &'a str,
    seed: u64,
    files: Vec<String>,
}

#[derive(Template)]
#[template(path = "axi_replay.md")]
struct BusReplayReadme<'a> {
    top: &'a str,
    mismatch: &'a Mismatch,
    version: &'a str,
    seed: u64,
    fingerprint: &'a str,
}

/// The contents of a replay folder.
pub(super) struct BusReplay<'a> {
    pub(super) top: &'a str,
    pub(super) sources: &'a [Source],
    pub(super) program: &'a str,
    pub(super) traffic: &'a str,
    /// The file with the recorded port activity; `waves` is the file with waves, if they were asked
    /// for.
    pub(super) record_file: &'a Path,
    pub(super) wave_file: Option<&'a Path>,
    pub(super) mismatch: &'a Mismatch,
    pub(super) version: &'a str,
    pub(super) seed: u64,
    pub(super) fingerprint: &'a str,
}

impl BusReplay<'_> {
    /// Writes the folder in place of an earlier one.
    pub(super) fn write(&self, folder: &Path) -> Result<PathBuf, CosimError> {
        let staged = StagedFolder::new(folder, REPLAY, true)?;
        self.fill(staged.folder()).map_err(|error| error.with_final_paths(&staged))?;
        staged.commit()?;
        Ok(folder.to_owned())
    }

    fn fill(&self, dir: &Path) -> Result<(), CosimError> {
        let &Self { top, mismatch, version, seed, fingerprint, .. } = self;
        let files = self.sources.iter().map(|(name, _)| shell_word(name).into_owned()).collect();
        for (name, contents) in self.sources {
            write_file(dir, name, contents)?;
        }
        write_file(dir, "axi.cpp", self.program)?;
        write_file(dir, TRAFFIC_FILE, self.traffic)?;
        write_file(dir, SCRIPT, &render(&BusReplayScript { top, seed, files }))?;
        write_file(
            dir,
            README,
            &render(&BusReplayReadme { top, mismatch, version, seed, fingerprint }),
        )?;
        make_executable(&dir.join(SCRIPT))?;
        let to = dir.join("heard_then.txt");
        fs::copy(self.record_file, &to).map_err(CosimError::io("write", &to))?;
        self.wave_file.map_or(Ok(()), |waves| copy_waves(waves, dir))
    }
}

/// A packet that has left the core.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct RecordedPacket {
    /// The clock at which the first word was taken; `clock` is the clock of the last word.
    pub(super) first_clock: u64,
    pub(super) last_clock: u64,
    pub(super) bytes: Vec<u8>,
    /// True if the last word was marked with `tlast`; otherwise a reset came first.
    pub(super) is_whole: bool,
}

/// A violation of the rules of the buses that the program has found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BusViolation {
    pub(super) clock: u64,
    pub(super) port: String,
    pub(super) message: String,
}

/// The activity between two resets.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct SessionRecord {
    /// The first clock after the reset.
    pub(super) start: u64,
    pub(super) packets: Vec<RecordedPacket>,
    /// The registers that were read: clock, address and value.
    pub(super) reads: Vec<(u64, u32, u32)>,
    /// The counts of rising edges on `interrupt_o`.
    pub(super) interrupt_counts: Vec<InterruptCount>,
}

/// The number of rising edges of `interrupt_o`, counted up to a clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct InterruptCount {
    pub(super) clock: u64,
    pub(super) count: u64,
    /// The number of rising edges at a clock edge at which a write that clears the event was taken.
    pub(super) met_clears: u64,
}

/// The complete record of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct BusRecord {
    pub(super) sessions: Vec<SessionRecord>,
    pub(super) violations: Vec<BusViolation>,
    /// The number of clocks of the run; `None` if the program ended early.
    pub(super) clocks: Option<u64>,
}

impl BusRecord {
    /// Reads a record from the lines of the program.
    ///
    /// # Errors
    /// Fails if a line cannot be read or has another form.
    pub(super) fn read(lines: impl BufRead) -> std::io::Result<Self> {
        let mut record = Self::default();
        for line in lines.lines() {
            let line = line?;
            record.parse_line(&line).ok_or_else(|| {
                std::io::Error::new(std::io::ErrorKind::InvalidData, format!("`{line}`"))
            })?;
        }
        Ok(record)
    }

    fn parse_line(&mut self, line: &str) -> Option<()> {
        let (kind, rest) = line.split_once(' ')?;
        let (clock, rest) = rest.split_once(' ').unwrap_or((rest, ""));
        let clock = clock.parse().ok()?;
        match kind {
            "reset" => {
                self.sessions.push(SessionRecord { start: clock, ..SessionRecord::default() });
                Some(())
            }
            "packet" => self.add_word(clock, rest),
            "read" => {
                let (address, value) = rest.split_once(' ')?;
                let hex = |digits| u32::from_str_radix(digits, 16).ok();
                self.sessions.last_mut()?.reads.push((clock, hex(address)?, hex(value)?));
                Some(())
            }
            "rises" => {
                let (count, met) = rest.split_once(' ')?;
                let (count, met) = (count.parse().ok()?, met.parse().ok()?);
                self.sessions.last_mut()?.interrupt_counts.push(InterruptCount {
                    clock,
                    count,
                    met_clears: met,
                });
                Some(())
            }
            "wrong" => {
                let (port, what) = rest.split_once(' ')?;
                let (port, what) = (port.to_owned(), what.to_owned());
                self.violations.push(BusViolation { clock, port, message: what });
                Some(())
            }
            "end" => {
                self.clocks = Some(clock);
                Some(())
            }
            _ => None,
        }
    }

    fn add_word(&mut self, clock: u64, rest: &str) -> Option<()> {
        let (word, last) = rest.split_once(' ')?;
        let packets = &mut self.sessions.last_mut()?.packets;
        if packets.last().is_none_or(|packet| packet.is_whole) {
            packets.push(RecordedPacket {
                first_clock: clock,
                last_clock: clock,
                bytes: Vec::new(),
                is_whole: false,
            });
        }
        let packet = packets.last_mut()?;
        packet.bytes.extend(u64::from_str_radix(word, 16).ok()?.to_le_bytes());
        packet.last_clock = clock;
        packet.is_whole = last == "1";
        Some(())
    }
}

/// The port on which packets leave.
pub(super) const PACKETS: &str = "m_axis_packets";

/// A difference between what a core showed on its buses and what it had to show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BusMismatch {
    pub(super) clock: u64,
    /// The number of the frame in its packets.
    pub(super) frame: u64,
    pub(super) region: Option<u32>,
    pub(super) port: String,
    /// The subject of the comparison, in words.
    pub(super) subject: String,
    pub(super) expected: String,
    pub(super) got: String,
}

impl BusMismatch {
    /// Makes a difference between two numbers on the packet port.
    pub(super) fn from_numbers(
        at: impl Into<String>,
        expected: impl LowerHex,
        got: impl LowerHex,
    ) -> Self {
        Self {
            clock: 0,
            frame: 0,
            region: None,
            port: PACKETS.to_owned(),
            subject: at.into(),
            expected: format!("{expected:x}"),
            got: format!("{got:x}"),
        }
    }

    /// Makes a difference about something that is missing (`must` is true) or must not be there
    /// (`must` is false); the numbers are 1 for present and 0 for absent.
    pub(super) fn from_presence(at: impl Into<String>, must: bool) -> Self {
        Self::from_numbers(at, u8::from(must), u8::from(!must))
    }

    pub(super) fn with_region(self, region: u32) -> Self {
        Self { region: Some(region), ..self }
    }

    /// Converts the difference to a mismatch of the scene `scene`.
    pub(super) fn into_mismatch(self, scene: &str) -> Mismatch {
        let Self { clock, frame, region, port, subject: at, expected, got } = self;
        let one = PortMismatch {
            port: port.clone(),
            clock,
            region,
            score: None,
            activity: at.clone(),
            expected: expected.clone(),
            actual: got.clone(),
        };
        Mismatch {
            sequence: scene.to_owned(),
            frame,
            clock,
            clock_in_frame: clock,
            region,
            port,
            score: None,
            activity: at,
            expected,
            actual: got,
            ports: vec![one],
        }
    }
}

impl From<&BusViolation> for BusMismatch {
    fn from(breach: &BusViolation) -> Self {
        let BusViolation { clock, port, message: what } = breach.clone();
        Self { clock, port, ..Self::from_presence(what, false) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_become_packets_by_session() {
        let text = "reset 4\npacket 9 00000000000000fa 0\npacket 11 0000000000000001 1\npacket 12 2 0\nreset 20\n\
                    read 25 1c 5f5e100\nrises 27 4 1\nwrong 30 s_axi_b nothing was written\nend 40 3\n";
        let record = BusRecord::read(text.as_bytes()).unwrap();
        let [first, second] = record.sessions.as_slice() else { panic!("{record:?}") };
        let bytes = [250, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0].to_vec();
        assert_eq!(
            first.packets[0],
            RecordedPacket { first_clock: 9, last_clock: 11, bytes, is_whole: true }
        );
        assert_eq!((first.start, second.start), (4, 20));
        assert!(first.packets.len() == 2 && !first.packets[1].is_whole);
        assert_eq!(second.reads, [(25, 0x1c, 100_000_000)]);
        assert_eq!(
            second.interrupt_counts,
            [InterruptCount { clock: 27, count: 4, met_clears: 1 }]
        );
        assert_eq!((record.violations.len(), record.clocks), (1, Some(40)));
        assert!(BusRecord::read("hello\n".as_bytes()).is_err());
    }
}
