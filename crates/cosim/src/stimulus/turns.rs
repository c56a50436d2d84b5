// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a recording, one after the other: the directed ones in every round, then the frames of the caller.

use crate::error::CosimError;

/// What is recorded, in this order.
pub(super) struct Turns<'a, Sequence, Part> {
    /// How often the directed sequences are run through.
    pub(super) rounds: u32,
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
        let total = u64::from(self.rounds) * self.directed.len() as u64 + self.given.len() as u64;
        let mut done = 0;
        progress(done, total);
        for round in 0..self.rounds as usize {
            for (number, sequence) in self.directed.iter().enumerate() {
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
