// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which step of its work the array is at, and what is seen of it.

use foveate_design::{Feed, Phase, SerialDesign, SerialTiming};

/// What the outputs show in a step, if anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Seen {
    /// Score `number` of the region of one lane, with its decision or without.
    Score { number: u32, lane: u32, decides: bool },
    /// A pixel of every lane.
    Pixels { position: u32 },
    /// A pixel of one lane.
    Pixel { position: u32, lane: u32 },
}

/// The steps of a frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Schedule {
    lanes: u32,
    fold: u32,
    regions: u32,
    /// Steps of a rotation before the first that shows a score.
    settling: u64,
    /// Clocks from T0 to the clock of the first step.
    lead: u64,
    slot_steps: u64,
    steps: u64,
    /// Clocks from T0 until `ready_o` is 1 again.
    ready: u64,
    visible: Vec<Visible>,
}

/// A phase of a slot of which something is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Visible {
    /// Steps of the slot before it.
    start: u64,
    steps: u64,
    what: What,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    Rotation { number: u32, decides: bool },
    UnloadLanes,
    UnloadRaster,
}

impl Schedule {
    pub(super) fn new(design: SerialDesign<'_>) -> Self {
        let timing = SerialTiming::of(design);
        Self {
            lanes: design.lanes(),
            fold: design.fold(),
            regions: design.regions(),
            settling: timing.settling().into(),
            lead: timing.edges_to_step(0),
            slot_steps: timing.slot_steps(),
            steps: timing.steps(),
            ready: timing.edges_to_ready(),
            visible: visible(design, timing.phases()),
        }
    }

    /// The slot and what is seen of it, so many clocks after T0.
    pub(super) fn at(&self, clock: u64) -> Option<(u32, Seen)> {
        let step = clock.checked_sub(self.lead).filter(|&step| step < self.steps)?;
        let slot = narrow(step / self.slot_steps);
        let step = step % self.slot_steps;
        let phase = self.visible.iter().rfind(|phase| phase.start <= step)?;
        let step = step - phase.start;
        if step >= phase.steps {
            return None;
        }
        Some((slot, self.seen(phase.what, step)?))
    }

    /// Clocks from so many after T0 to the first at which something may be seen; `None` after the last.
    pub(super) fn until_seen(&self, clock: u64) -> Option<u64> {
        let lead = self.lead.saturating_sub(clock);
        let step = (clock + lead - self.lead) % self.slot_steps;
        if clock + lead - self.lead >= self.steps {
            return None;
        }
        let to = |phase: &Visible| {
            let is_over = step >= phase.start + phase.steps;
            (!is_over).then(|| phase.start.saturating_sub(step))
        };
        // The last phase of a slot, in which pixels leave, is one of them.
        self.visible.iter().find_map(to).map(|steps| lead + steps)
    }

    fn seen(&self, what: What, step: u64) -> Option<Seen> {
        match what {
            What::Rotation { number, decides } => {
                let lane = narrow(step.checked_sub(self.settling)?);
                Some(Seen::Score { number, lane, decides })
            }
            What::UnloadLanes => Some(Seen::Pixels { position: narrow(step) }),
            What::UnloadRaster => {
                // A round: a step to fetch the pixels, then one for each lane.
                let round = u64::from(self.lanes) + 1;
                let lane = (step % round).checked_sub(1)?;
                Some(Seen::Pixel { position: narrow(step / round), lane: narrow(lane) })
            }
        }
    }

    pub(super) fn lanes(&self) -> u32 {
        self.lanes
    }

    /// The region that a lane serves in a slot; `None` if the slot is empty.
    pub(super) fn region(&self, lane: u32, slot: u32) -> Option<u32> {
        Some(lane * self.fold + slot).filter(|&region| region < self.regions)
    }

    /// Clocks until `ready_o` is 1 again, so many clocks after T0.
    pub(super) fn clocks_until_ready(&self, clock: u64) -> u64 {
        self.ready.saturating_sub(clock)
    }
}

/// The phases that show something. Scores are numbered in the order in which they pass the ports; the
/// decision comes with the last.
fn visible(design: SerialDesign<'_>, phases: &[(Phase, u64)]) -> Vec<Visible> {
    let (mut visible, mut start, mut number) = (Vec::new(), 0, 0);
    for &(phase, steps) in phases {
        let what = match phase {
            Phase::DenoiseTemporal
            | Phase::Border
            | Phase::Temporal
            | Phase::Pass(_)
            | Phase::Copy
            | Phase::Means
            | Phase::UnloadMeans => None,
            Phase::RotateCount | Phase::RotateScore(_) => {
                number += 1;
                let decides = number == design.score_count();
                Some(What::Rotation { number: number - 1, decides })
            }
            Phase::Unload => Some(match design.feed() {
                Feed::Parallel => What::UnloadLanes,
                Feed::Raster => What::UnloadRaster,
            }),
        };
        visible.extend(what.map(|what| Visible { start, steps, what }));
        start += steps;
    }
    visible
}

/// Numbers of slots, lanes and positions fit into 32 bits.
fn narrow(value: u64) -> u32 {
    u32::try_from(value).expect("slots, lanes and positions are numbered in 32 bits")
}
