// SPDX-License-Identifier: MIT OR Apache-2.0
//! The number of times that situations occurred, in one run or in several.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A situation that a design can have, and the number of times that it occurred.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Occurrence {
    /// The name of the situation.
    pub situation: String,
    /// The number of times that it occurred.
    pub count: u64,
}

/// All situations that a design can have, each with its count.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Occurrences(pub Vec<Occurrence>);

impl Occurrences {
    /// Adds `count` to a situation, which is new or already in the list.
    pub(crate) fn add(&mut self, situation: &str, count: u64) {
        match self.0.iter_mut().find(|own| own.situation == situation) {
            Some(own) => own.count += count,
            None => self.0.push(Occurrence { situation: situation.to_owned(), count }),
        }
    }

    /// Returns the sums over several runs. One run may reach a situation that another cannot.
    #[must_use]
    pub fn sum_of<'a>(runs: impl IntoIterator<Item = &'a Self>) -> Self {
        let mut all = Self::default();
        for Occurrence { situation, count } in runs.into_iter().flat_map(|run| &run.0) {
            all.add(situation, *count);
        }
        all
    }

    /// Returns the names of the situations that did not occur.
    #[must_use]
    pub fn missing(&self) -> Vec<&str> {
        let missing = self.0.iter().filter(|own| own.count == 0);
        missing.map(|own| own.situation.as_str()).collect()
    }
}

impl fmt::Display for Occurrences {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let missing = self.missing();
        write!(f, "{} of {} occurred", self.0.len() - missing.len(), self.0.len())?;
        if !missing.is_empty() {
            write!(f, "; missing: {}", missing.join(", "))?;
        }
        Ok(())
    }
}
