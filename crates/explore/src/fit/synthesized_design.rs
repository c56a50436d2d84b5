// SPDX-License-Identifier: MIT OR Apache-2.0
//! A synthesized design with its cost and all its constraints.

use foveate_design::Design;
use foveate_estimate::{FpgaDevice, FrameRate, SiliconReport, ramb36};

use super::FitRequest;
use super::camera_search::ExaminedCamera;
use super::constraints::{ConstraintCheck, all_met, total_excess};
use super::cost_objective::CostObjective;
use crate::ExploreError;
use crate::cost::{DesignArea, SynthesisResult};
use crate::row::count_to_f64;
use crate::target_process::{EnergyClips, ProcessEnergy, ProcessFigures, reachable_clock};

#[derive(Clone, Debug)]
pub(super) struct SynthesizedDesign {
    /// The camera that the design computes, with its figures.
    pub(super) examined: ExaminedCamera,
    pub(super) design: Design,
    pub(super) clocks_per_frame: u64,
    /// The speed at the clock of the request, or at the highest clock in the process, if that is
    /// lower or none was requested; without both, at the clock that is estimated for the FPGA.
    pub(super) speed: Option<FrameRate>,
    pub(super) silicon: DesignArea,
    /// The cost in the process, if there is one.
    pub(super) process: Option<ProcessFigures>,
    /// The report of the process, from which its energy can be measured.
    pub(super) report: Option<SiliconReport>,
    /// All constraints, with the figures of this design. A power that was not measured is not
    /// known.
    pub(super) checks: Vec<ConstraintCheck>,
    /// The cost by which designs are chosen.
    pub(super) objective: CostObjective,
}

impl SynthesizedDesign {
    /// Makes a design from its synthesis and from its report in the process, if there is one.
    pub(super) fn new(
        (examined, design): (&ExaminedCamera, &Design),
        SynthesisResult { silicon, speed: estimated }: SynthesisResult,
        report: Option<SiliconReport>,
        request: &FitRequest<'_>,
    ) -> Self {
        let clocks_per_frame = design.timing().clocks_per_frame();
        let process = report.as_ref().map(ProcessFigures::from_report);
        let at = |mhz| FrameRate::at_given_clock(mhz, clocks_per_frame);
        let given = request.clock_hz.map(|hertz| count_to_f64(hertz) / 1e6);
        let speed = reachable_clock(given, process.as_ref()).map(at).or(estimated);
        let mut checks = examined.checks.clone();
        checks.extend(request.constraints.check_speed(speed.as_ref()));
        checks.extend(request.constraints.check_area(&silicon));
        checks.extend(request.constraints.check_process_area(process.as_ref()));
        checks.extend(request.constraints.check_power(None));
        let (examined, design) = (examined.clone(), design.clone());
        let objective = request.cheapest;
        Self {
            examined,
            design,
            clocks_per_frame,
            speed,
            silicon,
            process,
            report,
            checks,
            objective,
        }
    }

    /// Sets the measured energy, and its constraint.
    pub(super) fn set_energy(&mut self, energy: Option<ProcessEnergy>, request: &FitRequest<'_>) {
        if let Some(process) = &mut self.process {
            process.energy = energy;
        }
        if let Some(found) = request.constraints.check_power(energy.as_ref()) {
            let known = self.checks.iter_mut().find(|check| check.name == found.name);
            *known.expect("each constraint is checked from the start") = found;
        }
    }

    /// Returns true if the energy may decide: the design exceeds no limit except that on power, or
    /// one more, which is binding if the power meets its limit.
    pub(super) fn is_decided_by_energy(&self, request: &FitRequest<'_>) -> bool {
        let exceeded = self.checks.iter().filter(|check| !check.holds).count();
        match request.constraints.max_mw {
            Some(_) => exceeded <= 2,
            None => request.cheapest == CostObjective::Energy && exceeded == 0,
        }
    }

    pub(super) fn measure_halves(
        &mut self,
        [first, second]: &[EnergyClips<'_>; 2],
        request: &FitRequest<'_>,
    ) -> Result<Option<ProcessEnergy>, ExploreError> {
        let Some(report) = &self.report else { return Ok(None) };
        let measure =
            |half: &EnergyClips<'_>| half.measure(request.synthesizer, &self.design, report);
        if self.energy().is_some() {
            return measure(second);
        }
        let (first, second) = rayon::join(|| measure(first), || measure(second));
        self.set_energy(first?, request);
        second
    }

    /// Returns the measured energy.
    pub(super) fn energy(&self) -> Option<&ProcessEnergy> {
        self.process.as_ref().and_then(|process| process.energy.as_ref())
    }

    pub(super) fn meets_limits(&self) -> bool {
        all_met(&self.checks)
    }

    pub(super) fn excess(&self) -> f64 {
        total_excess(&self.checks)
    }

    /// Returns the cost by which designs are chosen; infinite if it is not known.
    pub(super) fn cost(&self) -> f64 {
        match self.objective {
            CostObjective::Bytes | CostObjective::Area => {
                FpgaDevice::xcvu9p().cost(&self.silicon.array)
            }
            CostObjective::Mm2 => {
                let mm2 = self.process.as_ref().and_then(|process| process.mm2);
                mm2.unwrap_or(f64::INFINITY)
            }
            CostObjective::Energy => self.energy().map_or(f64::INFINITY, |energy| energy.usual_mw),
        }
    }

    pub(super) fn cost_text(&self) -> String {
        let area = &self.silicon.array;
        let share = || {
            let (luts, blocks) = (area.lut_total_packed, ramb36(area.bram18));
            format!("{luts} LUTs and {blocks} RAMB36, {:.3} % of the device", self.cost() * 100.0)
        };
        match self.objective {
            CostObjective::Bytes | CostObjective::Area => share(),
            CostObjective::Mm2 if self.cost().is_finite() => format!("{:.3} mm2", self.cost()),
            CostObjective::Mm2 => {
                let bits = self.process.as_ref().map_or(0, |own| own.memory_bits_without_macro);
                format!("no area, because no macro fits {bits} bits of memory")
            }
            CostObjective::Energy => match self.energy() {
                Some(energy) => {
                    format!("{:.4} mW at {} frames/s", energy.usual_mw, energy.frame_rate)
                }
                None => "energy not measured".to_owned(),
            },
        }
    }
}
