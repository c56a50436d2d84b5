// SPDX-License-Identifier: MIT OR Apache-2.0
//! Measures the energy of a design: maps a unit, simulates it on stretches of a clip, and adds up.

use std::collections::BTreeSet;
use std::path::Path;

use foveate_cosim::UnitFrames;
use foveate_design::{Design, DesignConfig, OrganizationConfig};
use foveate_estimate::{LibertyLibrary, SiliconReport, map_unit};
use foveate_footage::InputOptions;
use foveate_frame::Frame;
use foveate_toolchain::{Cache, Toolchain};

use crate::activity::NetActivity;
use crate::energy_sum::EnergySum;
use crate::error::EnergyError;
use crate::net_electrics::NetElectrics;
use crate::report::{ENERGY_FORMAT_VERSION, EnergyReport, StretchEnergy};
use crate::simulated_netlist::SimulatedNetlist;
use crate::stretches::{ClipStretch, FRAMES_BEFORE, PlayedClip};
use crate::unit_activity::unit_activity;

/// The largest number of units that are simulated.
const MAX_UNITS: u64 = 1024;
/// The number of units that are simulated even if they take many clocks.
const MIN_UNITS: u64 = 4;
/// The number of clocks of all units that are enough. The vectors of each take some ten bytes.
const ENOUGH_CLOCKS: u64 = 1 << 22;
/// The clocks of a frame up to which a stretch has four frames, and not one.
const FAST_FRAME: u64 = 1 << 12;
/// The changes of a net per clock that tools assume.
const DEFAULT_ACTIVITY: f64 = 0.1;

/// A clip that gives a design its activity.
pub struct EnergyJob {
    clip: PlayedClip,
    name: String,
    frame_rate: f64,
}

impl EnergyJob {
    /// Opens the clip. The design takes its size. Powers are for `frame_rate` frames per second.
    ///
    /// # Errors
    /// Fails if the clip cannot be opened twice or does not fit, and for organization `raster`.
    pub fn open(
        input: &Path,
        config: &DesignConfig,
        options: &InputOptions,
        frame_rate: f64,
    ) -> Result<Self, EnergyError> {
        if matches!(config.hardware.organization, OrganizationConfig::Raster(_)) {
            return Err(EnergyError::Raster);
        }
        let clip = PlayedClip::open(input, config, options)?;
        Ok(Self { clip, name: input.display().to_string(), frame_rate })
    }

    /// Returns the design in the size of the clip.
    #[must_use]
    pub fn design(&self) -> &Design {
        &self.clip.design
    }
}

/// Measures the energy of the design of a job. `silicon` is its report on area, and `clock_mhz` the clock
/// of a design whose clock runs always.
///
/// # Errors
/// Fails if the clip has too few frames, if Yosys fails, if a table is missing in the library, or if the
/// netlist differs from the model.
pub fn measure_energy(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &EnergyJob,
    (library, silicon, clock_mhz): (&LibertyLibrary, &SiliconReport, f64),
) -> Result<EnergyReport, EnergyError> {
    let design = &job.clip.design;
    let length = if design.timing().clocks_per_frame() <= FAST_FRAME { 4 } else { 1 };
    let (frames, stretches) = job.clip.stretches(length)?;
    let shown = job.clip.frames(&stretches)?;
    let flat = map_unit(toolchain, cache, design, (library, silicon.memory_limit))?;
    let cells: BTreeSet<&str> = flat.gates.iter().map(|gate| gate.cell.as_str()).collect();
    let models = library.cell_models(cells)?;
    let netlist = SimulatedNetlist::new(&flat, &models)?;
    let electrics = NetElectrics::of_netlist(&netlist);
    let uniform = NetActivity::uniform(&netlist, DEFAULT_ACTIVITY);
    let array = ArrayEnergies {
        silicon,
        frame_rate: job.frame_rate,
        clock_mhz,
        shared_growth: shared_growth(&netlist, silicon),
        default: EnergySum::of_activity(&netlist, &electrics, &uniform),
    };
    let mut report = array.report(&job.name, frames);
    for stretch in &stretches {
        let frames: Vec<Frame> =
            stretch.simulated().filter_map(|at| shown.get(&at).cloned()).collect();
        let max_parts = affordable_units(design, frames.len() as u64);
        let vectors = UnitFrames { frames: &frames, max_parts };
        let recording = vectors.record(design, toolchain.cancel_flag())?;
        let counted = FRAMES_BEFORE..FRAMES_BEFORE + stretch.frames;
        let activity = unit_activity(&netlist, &recording, &counted, toolchain.cancel_flag())?;
        let sum = EnergySum::of_activity(&netlist, &electrics, &activity);
        report.simulated_units = recording.sequences();
        report.stretches.push(array.stretch(
            stretch,
            sum,
            (activity.clocks, recording.sequences()),
        ));
    }
    Ok(report)
}

/// Returns the number of units whose simulation is affordable.
fn affordable_units(design: &Design, frames: u64) -> usize {
    let clocks = (design.timing().clocks_per_frame() * frames).max(1);
    let units = (ENOUGH_CLOCKS / clocks).clamp(MIN_UNITS, MAX_UNITS);
    usize::try_from(units).unwrap_or(usize::MAX)
}

/// Returns the flip-flops that the units of the array share, over those of an array of one unit.
#[allow(clippy::cast_precision_loss, reason = "there are fewer than 2^53 flip-flops")]
fn shared_growth(netlist: &SimulatedNetlist<'_>, silicon: &SiliconReport) -> f64 {
    let is_shared = |gate: &&usize| !netlist.gates[**gate].is_in_unit;
    let own = netlist.flip_flops.iter().filter(is_shared).count().max(1);
    silicon.shared.flip_flops as f64 / own as f64
}

/// The figures from which energies of an array follow.
struct ArrayEnergies<'a> {
    silicon: &'a SiliconReport,
    frame_rate: f64,
    clock_mhz: f64,
    /// The flip-flops that all units share, over those of an array of one unit. The energy of the shared
    /// logic is taken to grow as their number does.
    shared_growth: f64,
    default: EnergySum,
}

impl ArrayEnergies<'_> {
    /// Returns a report without stretches.
    fn report(&self, clip: &str, frames: u64) -> EnergyReport {
        EnergyReport {
            format_version: ENERGY_FORMAT_VERSION,
            clip: clip.to_owned(),
            frames,
            unit: self.silicon.unit.name.clone(),
            units: self.silicon.unit.count,
            simulated_units: 0,
            regions: self.silicon.regions,
            frame_rate: self.frame_rate,
            clock_mhz: self.clock_mhz,
            leakage_mw: self.silicon.leakage_nw * 1e-6,
            stretches: Vec::new(),
        }
    }

    /// Returns the energies of a stretch from the sum over `clocks` clocks of `units` units.
    #[allow(clippy::cast_precision_loss, reason = "there are fewer than 2^53 units and clocks")]
    fn stretch(
        &self,
        stretch: &ClipStretch,
        sum: EnergySum,
        (clocks, units): (f64, u64),
    ) -> StretchEnergy {
        let frames_of_units = (units * stretch.frames) as f64;
        let (count, regions) = (self.silicon.unit.count as f64, self.silicon.regions as f64);
        let shared_pj = sum.shared.scaled(self.shared_growth / frames_of_units);
        let frame_pj = sum.unit.scaled(count / frames_of_units).plus(shared_pj);
        let leakage_mw = self.silicon.leakage_nw * 1e-6;
        let frames_mw = frame_pj.total() * self.frame_rate * 1e-9;
        let idle_clocks = self.clock_mhz * 1e6 - clocks / frames_of_units * self.frame_rate;
        let shared_clock_pj = sum.shared.clock * self.shared_growth;
        let clock_pj = (sum.unit.clock * count + shared_clock_pj) / clocks;
        StretchEnergy {
            name: stretch.name.to_owned(),
            first_frame: stretch.first,
            frames: stretch.frames,
            sent_share: stretch.sent_share,
            clocks_per_frame: clocks / frames_of_units,
            unit_pj_per_clock: sum.unit.scaled(1.0 / clocks),
            region_nj_per_frame: frame_pj.scaled(1e-3 / regions),
            stopped_clock_mw: frames_mw + leakage_mw,
            running_clock_mw: (idle_clocks >= 0.0)
                .then_some(frames_mw + leakage_mw + clock_pj * idle_clocks * 1e-9),
            default_activity_pj_per_clock: self.default.unit.total(),
        }
    }
}
