// SPDX-License-Identifier: MIT OR Apache-2.0
//! The recorded activity on the ports of a core, read from the lines that the program prints.

use std::io::BufRead;

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
