// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a recording, one after the other: the directed ones in every round, then the frames of the caller.

use crate::error::CosimError;

/// How much is recorded of the directed sequences.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// How often they are run through.
    pub(super) rounds: u32,
    /// How many of them, from the first on.
    pub(super) most: usize,
}

impl Extent {
    /// Whether some sequences may be left out.
    pub(super) fn is_brief(self) -> bool {
        self.most != usize::MAX
    }
}

/// What is recorded, in this order.
pub(super) struct Turns<'a, Sequence, Part> {
    pub(super) extent: Extent,
    pub(super) directed: &'a [Sequence],
    /// The parts of the caller's frames, each a sequence.
    pub(super) given: Vec<Part>,
}

impl<Sequence, Part> Turns<'_, Sequence, Part> {
    /// Records all of it in a session. `directed` is told the round and the number of its sequence, `given` the
    /// number of its part, and `progress` how many sequences of how many are done.
    pub(super) fn record<Session>(
        self,
        session: &mut Session,
        directed: impl Fn(&mut Session, &Sequence, usize, usize) -> Result<(), CosimError>,
        given: impl Fn(&mut Session, usize, Part) -> Result<(), CosimError>,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), CosimError> {
        let directed_ones = &self.directed[..self.extent.most.min(self.directed.len())];
        let rounds = self.extent.rounds;
        let total = u64::from(rounds) * directed_ones.len() as u64 + self.given.len() as u64;
        let mut done = 0;
        progress(done, total);
        for round in 0..rounds as usize {
            for (number, sequence) in directed_ones.iter().enumerate() {
                directed(session, sequence, round, number)?;
                done += 1;
                progress(done, total);
            }
        }
        for (number, part) in self.given.into_iter().enumerate() {
            given(session, number, part)?;
            done += 1;
            progress(done, total);
        }
        Ok(())
    }
}
