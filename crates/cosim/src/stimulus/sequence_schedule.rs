// SPDX-License-Identifier: MIT OR Apache-2.0
//! The order of the sequences of a recording: the directed ones in every round, then the frames of
//! the caller.

use crate::error::CosimError;

/// The number of directed sequences that are recorded.
#[derive(Clone, Copy, Debug)]
pub(super) struct SequenceLimits {
    /// The number of rounds.
    pub(super) rounds: u32,
    /// The largest number of directed sequences per round, from the first on.
    pub(super) max_sequences: usize,
}

impl SequenceLimits {
    /// Returns true if some sequences may be left out.
    pub(super) fn is_brief(self) -> bool {
        self.max_sequences != usize::MAX
    }
}

/// The sequences of a recording, in their order.
pub(super) struct SequenceSchedule<'a, Sequence, Part> {
    pub(super) extent: SequenceLimits,
    pub(super) directed: &'a [Sequence],
    /// The parts of the caller's frames, each a sequence.
    pub(super) caller_parts: Vec<Part>,
}

impl<Sequence, Part> SequenceSchedule<'_, Sequence, Part> {
    /// Records all sequences. `directed` gets the round and the index of its sequence, `given` the
    /// index of its part, and `progress` the number of finished sequences and the number of all.
    pub(super) fn record<Session>(
        self,
        session: &mut Session,
        directed: impl Fn(&mut Session, &Sequence, usize, usize) -> Result<(), CosimError>,
        given: impl Fn(&mut Session, usize, Part) -> Result<(), CosimError>,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), CosimError> {
        let directed_ones = &self.directed[..self.extent.max_sequences.min(self.directed.len())];
        let rounds = self.extent.rounds;
        let total = u64::from(rounds) * directed_ones.len() as u64 + self.caller_parts.len() as u64;
        let mut done = 0;
        progress(done, total);
        for round in 0..rounds as usize {
            for (number, sequence) in directed_ones.iter().enumerate() {
                directed(session, sequence, round, number)?;
                done += 1;
                progress(done, total);
            }
        }
        for (number, part) in self.caller_parts.into_iter().enumerate() {
            given(session, number, part)?;
            done += 1;
            progress(done, total);
        }
        Ok(())
    }
}
