// SPDX-License-Identifier: MIT OR Apache-2.0
//! The schedule of a frame: the step of the array in every clock, and the outputs of that step.

use foveate_camera::Periphery;
use foveate_design::{PixelFeed, SerialDesign, SerialPhase, SerialTiming};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StepOutput {
    /// Score `number` of the region of one lane is on the ports. With `decides`, the decision is
    /// too.
    Score { number: u32, lane: u32, decides: bool },
    /// Pixel or mean `number` of a slot leaves: from all lanes, or from one.
    Forwarded { what: ForwardedKind, number: u32, lane: Option<u32> },
}

/// The kind of values that leave in a phase: pixels of active regions, or means of summaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ForwardedKind {
    Pixel,
    Mean,
}

/// The steps of a frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SerialSchedule {
    lanes: u32,
    fold: u32,
    regions: u32,
    /// Number of steps of a rotation before the first score.
    settling: u64,
    /// Clocks from T0 to the clock of the first step.
    lead: u64,
    slot_steps: u64,
    steps: u64,
    /// Clocks from T0 until `ready_o` is 1 again.
    ready: u64,
    visible: Vec<VisiblePhase>,
}

/// A phase of a slot with outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct VisiblePhase {
    /// Number of steps of the slot before this phase.
    start: u64,
    steps: u64,
    what: PhaseOutput,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum PhaseOutput {
    Rotation { number: u32, decides: bool },
    Unload { what: ForwardedKind, rounds: UnloadOrder },
}

/// The order in which the lanes output their values, number after number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum UnloadOrder {
    /// All lanes output a value together, in the last of `steps` steps.
    AllLanes { steps: u64 },
    /// The lanes output a value one after the other, behind a step without outputs.
    LaneByLane,
}

impl SerialSchedule {
    pub(super) fn new(design: SerialDesign<'_>) -> Self {
        let timing = SerialTiming::from_design(design);
        Self {
            lanes: design.lanes(),
            fold: design.fold(),
            regions: design.regions(),
            settling: timing.settling_steps().into(),
            lead: timing.edges_to_step(0),
            slot_steps: timing.slot_steps(),
            steps: timing.steps(),
            ready: timing.edges_to_ready(),
            visible: visible_phases(design, timing.phases()),
        }
    }

    /// Returns the slot and the output `clock` clocks after T0.
    pub(super) fn output_at(&self, clock: u64) -> Option<(u32, StepOutput)> {
        let step = clock.checked_sub(self.lead).filter(|&step| step < self.steps)?;
        let slot = to_u32(step / self.slot_steps);
        let step = step % self.slot_steps;
        let phase = self.visible.iter().rfind(|phase| phase.start <= step)?;
        let step = step - phase.start;
        if step >= phase.steps {
            return None;
        }
        Some((slot, self.step_output(phase.what, step)?))
    }

    /// Returns the number of clocks from `clock` clocks after T0 to the next clock that may have an
    /// output, or `None` if no such clock follows in the frame.
    pub(super) fn clocks_until_output(&self, clock: u64) -> Option<u64> {
        let lead = self.lead.saturating_sub(clock);
        let step = (clock + lead - self.lead) % self.slot_steps;
        if clock + lead - self.lead >= self.steps {
            return None;
        }
        let steps_to = |phase: &VisiblePhase| {
            let is_over = step >= phase.start + phase.steps;
            (!is_over).then(|| phase.start.saturating_sub(step))
        };
        // A slot always has one: its last phase, in which pixels or means leave.
        self.visible.iter().find_map(steps_to).map(|steps| lead + steps)
    }

    fn step_output(&self, what: PhaseOutput, step: u64) -> Option<StepOutput> {
        match what {
            PhaseOutput::Rotation { number, decides } => {
                let lane = to_u32(step.checked_sub(self.settling)?);
                Some(StepOutput::Score { number, lane, decides })
            }
            PhaseOutput::Unload { what, rounds } => {
                let (number, lane) = self.round_and_lane(rounds, step)?;
                Some(StepOutput::Forwarded { what, number, lane })
            }
        }
    }

    /// Returns the number of the round, and the lane that outputs a value, or `None` for all lanes.
    fn round_and_lane(&self, rounds: UnloadOrder, step: u64) -> Option<(u32, Option<u32>)> {
        match rounds {
            UnloadOrder::AllLanes { steps } => {
                (step % steps == steps - 1).then(|| (to_u32(step / steps), None))
            }
            UnloadOrder::LaneByLane => {
                let round = u64::from(self.lanes) + 1;
                let lane = (step % round).checked_sub(1)?;
                Some((to_u32(step / round), Some(to_u32(lane))))
            }
        }
    }

    pub(super) fn lanes(&self) -> u32 {
        self.lanes
    }

    /// Returns the region that a lane serves in a slot, or `None` if the slot is empty.
    pub(super) fn region(&self, lane: u32, slot: u32) -> Option<u32> {
        Some(lane * self.fold + slot).filter(|&region| region < self.regions)
    }

    /// Returns the clocks until `ready_o` is 1 again, `clock` clocks after T0.
    pub(super) fn clocks_until_ready(&self, clock: u64) -> u64 {
        self.ready.saturating_sub(clock)
    }
}

/// Returns the phases with outputs. Scores are numbered in the order in which they pass the ports.
/// The decision comes with the last score.
fn visible_phases(design: SerialDesign<'_>, phases: &[(SerialPhase, u64)]) -> Vec<VisiblePhase> {
    let pixels = design.region_pixels();
    let means = design.periphery().map_or(0, Periphery::mean_count);
    let (mut visible, mut start, mut number) = (Vec::new(), 0, 0);
    for &(phase, steps) in phases {
        let what = match phase {
            SerialPhase::PassClasses
            | SerialPhase::DenoiseAndCompare
            | SerialPhase::RepeatBorder
            | SerialPhase::CompareRaw
            | SerialPhase::FeaturePass(_)
            | SerialPhase::CopyReference
            | SerialPhase::ComputeMeans => None,
            SerialPhase::RotateCount | SerialPhase::RotateScore(_) => {
                number += 1;
                let decides = number == design.score_count();
                Some(PhaseOutput::Rotation { number: number - 1, decides })
            }
            SerialPhase::UnloadPixels => Some(PhaseOutput::Unload {
                what: ForwardedKind::Pixel,
                rounds: unload_order(design, steps, pixels),
            }),
            SerialPhase::UnloadMeans => Some(PhaseOutput::Unload {
                what: ForwardedKind::Mean,
                rounds: unload_order(design, steps, means),
            }),
        };
        visible.extend(what.map(|what| VisiblePhase { start, steps, what }));
        start += steps;
    }
    visible
}

/// Returns the order of a phase in which `things` values of every region leave.
fn unload_order(design: SerialDesign<'_>, steps: u64, values: u32) -> UnloadOrder {
    match design.feed() {
        PixelFeed::Parallel => UnloadOrder::AllLanes { steps: steps / u64::from(values) },
        PixelFeed::Raster => UnloadOrder::LaneByLane,
    }
}

/// Converts the number of a slot, a lane, a pixel or a mean, which fits into 32 bits.
fn to_u32(value: u64) -> u32 {
    u32::try_from(value).expect("slots, lanes, pixels and means are numbered in 32 bits")
}
