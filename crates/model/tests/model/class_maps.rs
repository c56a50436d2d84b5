// SPDX-License-Identifier: MIT OR Apache-2.0
//! The maps of classes that frames use, by the rules of `docs/zones.md`: a log of all edges, from
//! which every answer is computed anew. It shares no code with the memory of the models.

use foveate_model::ClassMapInputs;

use crate::frames::SeededRandom;
use crate::parameters::DesignParameters;

/// A write that had an effect.
#[derive(Clone, Copy, Debug)]
struct LoggedWrite {
    /// The number of commits at earlier edges, so that the write belongs to the commit after them.
    commits_before: usize,
    address: u32,
    word: u32,
}

/// A log of all edges since the start. Before it, both maps are `normal` everywhere.
#[derive(Clone, Debug)]
pub(crate) struct ClassMapLog {
    regions: usize,
    /// For every edge from 0 on, the last edge up to it that no frame occupied.
    last_free: Vec<i64>,
    /// The edges of the commits that had an effect.
    commits: Vec<i64>,
    writes: Vec<LoggedWrite>,
}

impl ClassMapLog {
    pub(crate) fn new(recipe: &DesignParameters) -> Self {
        let regions = (recipe.columns() * recipe.rows()) as usize;
        Self { regions, last_free: vec![0], commits: Vec::new(), writes: Vec::new() }
    }

    pub(crate) fn edge(&self) -> i64 {
        self.last_free.len() as i64 - 1
    }

    /// Appends an edge without a reset.
    pub(crate) fn push(&mut self, inputs: ClassMapInputs, is_occupied: bool) {
        let has_effect = !self.is_pending_after(self.edge());
        let edge = self.edge() + 1;
        let free = if is_occupied { self.last_free[edge as usize - 1] } else { edge };
        self.last_free.push(free);
        if has_effect && inputs.write {
            let ClassMapInputs { address, word, .. } = inputs;
            let commits_before = self.commits.len();
            self.writes.push(LoggedWrite { commits_before, address, word });
        }
        if has_effect && inputs.commit {
            self.commits.push(edge);
        }
    }

    /// Appends an edge with a reset, whatever its other inputs are.
    pub(crate) fn push_reset(&mut self) {
        self.last_free.push(self.edge() + 1);
    }

    /// Returns `zone_pending_o` after an edge: no edge between it and the last commit was free.
    pub(crate) fn is_pending_after(&self, edge: i64) -> bool {
        let last_commit = self.commits.iter().rfind(|&&commit| commit <= edge);
        last_commit.is_some_and(|&commit| commit >= self.last_free[edge as usize])
    }

    /// Returns the map of a frame whose first pixel or word is taken at this edge.
    pub(crate) fn map_of_frame(&self, first: i64) -> Vec<u8> {
        self.map_after(self.commits.iter().filter(|&&commit| commit <= first - 2).count())
    }

    /// Returns the map that is committed after this number of commits. Its bank is that of every
    /// second commit.
    fn map_after(&self, commits: usize) -> Vec<u8> {
        let mut map = vec![0; self.regions];
        let is_in_bank = |write: &&LoggedWrite| {
            write.commits_before < commits && (commits - write.commits_before) % 2 == 1
        };
        for write in self.writes.iter().filter(is_in_bank) {
            for place in 0..16 {
                if let Some(code) = map.get_mut((write.address * 16 + place) as usize) {
                    *code = (write.word >> (2 * place) & 3) as u8;
                }
            }
        }
        map
    }
}

/// A writer of random maps: all words in random order, some of them twice, some that do not exist,
/// and then a commit. It does not care whether the memory takes them.
#[derive(Clone, Debug)]
pub(crate) struct ClassMapWriter {
    random: SeededRandom,
    words: i64,
    /// One more than the largest number that the port of addresses can have.
    addresses: i64,
    /// The inputs of the next edges with inputs, the last one first.
    planned: Vec<ClassMapInputs>,
    /// The mean number of clocks between two inputs in the middle of a frame.
    pace: i64,
}

impl ClassMapWriter {
    /// Makes a writer for frames of about `clocks` clocks.
    pub(crate) fn new(recipe: &DesignParameters, clocks: i64, seed: u64) -> Self {
        let words = (recipe.columns() * recipe.rows() + 15) / 16;
        let mut addresses = 2;
        while addresses < words {
            addresses *= 2;
        }
        let pace = 1 + clocks / 12;
        Self { random: SeededRandom(seed), words, addresses, planned: Vec::new(), pace }
    }

    /// Returns the inputs of the next edge. Near the first or the last edge of a frame, half of the
    /// edges have inputs.
    pub(crate) fn next(&mut self, is_near_end: bool) -> ClassMapInputs {
        let pace = if is_near_end { 2 } else { self.pace };
        if self.random.below(pace) > 0 {
            return ClassMapInputs { write: false, commit: false, ..self.write() };
        }
        if self.planned.is_empty() {
            self.plan();
        }
        self.planned.pop().unwrap()
    }

    /// Returns a write of a random word.
    fn write(&mut self) -> ClassMapInputs {
        let address = self.random.below(self.addresses) as u32;
        ClassMapInputs {
            write: true,
            address,
            word: self.random.below(1 << 32) as u32,
            commit: false,
        }
    }

    fn plan(&mut self) {
        let mut planned: Vec<_> = (0..self.words)
            .map(|address| ClassMapInputs { address: address as u32, ..self.write() })
            .collect();
        for _ in 0..self.random.below(3) {
            planned.push(self.write());
        }
        for place in 0..planned.len() {
            planned.swap(place, self.random.below(place as i64 + 1) as usize);
        }
        // Some maps are not complete, and some only exchange the banks.
        if self.random.below(4) == 0 {
            planned.truncate(self.random.below(self.words) as usize);
        }
        // The last word comes with the commit or before it.
        match planned.first_mut() {
            Some(last) if self.random.below(2) == 0 => last.commit = true,
            _ => {
                let commit = ClassMapInputs { write: false, commit: true, ..self.write() };
                planned.insert(0, commit);
            }
        }
        self.planned = planned;
    }
}
