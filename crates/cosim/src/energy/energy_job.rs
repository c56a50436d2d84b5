// SPDX-License-Identifier: MIT OR Apache-2.0
//! Measures the energy of a design: maps a unit, simulates it on stretches of a clip, and adds up.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::atomic::AtomicBool;

use crate::{Recording, UnitFrames};
use foveate_design::{Design, DesignConfig, Organization};
use foveate_estimate::{LibertyLibrary, SiliconReport, count_to_f64, map_unit};
use foveate_media::{ClipReading, InputOptions, RunClips};
use foveate_pixels::Frame;
use foveate_tools::{Cache, Toolchain};

use super::energy_sum::NetElectrics;
use crate::energy::activity::NetActivity;
use crate::energy::energy_sum::{EnergySum, PartEnergies};
use crate::energy::error::EnergyError;
use crate::energy::report::{ENERGY_FORMAT_VERSION, EnergyReport, StretchEnergy};
use crate::energy::simulated_netlist::SimulatedNetlist;
use crate::energy::stretches::{ActivityClip, ClipStretch, FRAMES_BEFORE};
use crate::energy::unit_activity::unit_activity;

/// The largest number of units that are simulated.
const MAX_UNITS: u64 = 1024;
/// The clocks of a frame up to which a stretch has four frames, and not one.
const FAST_FRAME: u64 = 1 << 12;
/// The changes of a net per clock that tools assume.
const DEFAULT_ACTIVITY: f64 = 0.1;

/// A design with the activity that a clip gives it.
#[derive(Debug)]
pub struct EnergyJob {
    design: Design,
    name: String,
    /// The number of frames of the clip.
    frames: u64,
    stretches: Vec<ClipStretch>,
    /// The vectors of the units in each stretch, by its first frame.
    recordings: BTreeMap<u64, Recording>,
    frame_rate: f64,
}

impl EnergyJob {
    /// Plays the clip of an input to a design, which takes the size of the clip; see
    /// [`EnergyJob::record`].
    ///
    /// # Errors
    /// Fails if the input is not one clip that can be read twice, or as [`EnergyJob::record`] does.
    pub fn open(
        input: &Path,
        config: &DesignConfig,
        options: &InputOptions,
        frame_rate: f64,
        cancel: &AtomicBool,
    ) -> Result<Self, EnergyError> {
        check_organization(config.hardware.organization.kind())?;
        let clips = RunClips::new(&[input.to_owned()], &[], &config.camera, options)?;
        if clips.clips().len() > 1 {
            return Err(EnergyError::SeveralClips { input: clips.inputs().join(", ") });
        }
        let (width, height) = clips.common_format(ClipReading::Repeated)?.size;
        let design = config.validate_for_frames(width, height)?;
        let clip = ActivityClip { clips: &clips, clip: 0, frames: 0..u64::MAX };
        let job = Self::record(&clip, &design, frame_rate, cancel)?;
        Ok(Self { name: input.display().to_string(), ..job })
    }

    /// Plays a clip to a design of its size, finds the stretches to measure, and records what units
    /// take and what the model makes of it. Powers are for `frame_rate` frames per second.
    ///
    /// # Errors
    /// Fails if the clip cannot be read, is not complete, is too short or does not fit, for
    /// organization `raster`, if there is no room for the vectors, or if `cancel` was set.
    pub fn record(
        clip: &ActivityClip<'_>,
        design: &Design,
        frame_rate: f64,
        cancel: &AtomicBool,
    ) -> Result<Self, EnergyError> {
        check_organization(design.organization())?;
        let is_fast = design.timing().clocks_per_frame() <= FAST_FRAME;
        let (frames, stretches) = clip.stretches(design, if is_fast { 4 } else { 1 }, cancel)?;
        let shown = clip.read_stretches(&stretches, design.pixel_bits(), cancel)?;
        let mut recordings = BTreeMap::new();
        for stretch in &stretches {
            if let Entry::Vacant(entry) = recordings.entry(stretch.first) {
                let frames = stretch.simulated().filter_map(|at| shown.get(&at).cloned());
                let frames: Vec<Frame> = frames.collect();
                let vectors = UnitFrames { frames: &frames, max_parts: MAX_UNITS };
                entry.insert(vectors.record(design, cancel)?);
            }
        }
        let name = clip.clips.clips()[clip.clip].name.clone();
        Ok(Self { design: design.clone(), name, frames, stretches, recordings, frame_rate })
    }

    /// Returns the design in the size of the clip.
    #[must_use]
    pub fn design(&self) -> &Design {
        &self.design
    }
}

/// Measures the energy of the design of a job. `silicon` is its report on area, and `clock_mhz` the
/// clock of a design whose clock runs always.
///
/// # Errors
/// Fails if Yosys fails, if a table is missing in the library, or if the
/// netlist differs from the model.
pub fn measure_energy(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &EnergyJob,
    (library, silicon, clock_mhz): (&LibertyLibrary, &SiliconReport, f64),
) -> Result<EnergyReport, EnergyError> {
    let design = &job.design;
    let flat = map_unit(toolchain, cache, design, (library, silicon.memory_limit))?;
    let cells: BTreeSet<&str> = flat.gates.iter().map(|gate| gate.cell.as_str()).collect();
    let models = library.cell_models(cells)?;
    let netlist = SimulatedNetlist::new(&flat, &models)?;
    let electrics = NetElectrics::of_netlist(&netlist);
    let uniform = NetActivity::uniform(&netlist, DEFAULT_ACTIVITY);
    let array = ArrayEnergies {
        silicon,
        clocks_per_frame: count_to_f64(design.timing().clocks_per_frame()),
        frame_rate: job.frame_rate,
        clock_mhz,
        shared_growth: shared_growth(&netlist, silicon),
        default: EnergySum::of_activity(&netlist, &electrics, &uniform),
    };
    let mut report = array.report(job);
    // Stretches of a short clip may be the same.
    let mut sums = BTreeMap::new();
    for stretch in &job.stretches {
        let recording = &job.recordings[&stretch.first];
        let units = recording.sequences();
        let (sum, clocks) = match sums.entry(stretch.first) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(entry) => {
                let first = FRAMES_BEFORE + delay_of_work(design);
                let counted = first..first + stretch.frames;
                let activity =
                    unit_activity(&netlist, recording, &counted, toolchain.cancel_flag())?;
                let sum = EnergySum::of_activity(&netlist, &electrics, &activity);
                *entry.insert((sum, activity.clocks))
            }
        };
        report.simulated_units = units;
        report.stretches.push(array.stretch(stretch, sum, (clocks, units)));
    }
    Ok(report)
}

/// Refuses an organization whose energy cannot be measured.
fn check_organization(organization: Organization) -> Result<(), EnergyError> {
    match organization {
        Organization::Pipelined | Organization::Serial => Ok(()),
        Organization::Raster => Err(EnergyError::Raster),
    }
}

/// Returns the number of frames that a unit is behind the frame that it takes. An RPU scores pixels
/// as they come, and a lane works on a frame while it takes the next one.
fn delay_of_work(design: &Design) -> u64 {
    match design.organization() {
        Organization::Serial => 1,
        Organization::Pipelined | Organization::Raster => 0,
    }
}

/// Returns the ratio of the flip-flops that the units of the array share to those of an array of
/// one unit.
fn shared_growth(netlist: &SimulatedNetlist<'_>, silicon: &SiliconReport) -> f64 {
    let is_shared = |gate: &&usize| !netlist.gates[**gate].is_in_unit;
    let own = netlist.flip_flops.iter().filter(is_shared).count().max(1);
    count_to_f64(silicon.shared.flip_flops) / count_to_f64(own as u64)
}

/// The figures from which energies of an array follow.
struct ArrayEnergies<'a> {
    clocks_per_frame: f64,
    silicon: &'a SiliconReport,
    frame_rate: f64,
    clock_mhz: f64,
    /// The ratio of the flip-flops that all units share to those of an array of one unit. The
    /// energy of the shared logic is taken to grow as their number does.
    shared_growth: f64,
    default: EnergySum,
}

impl ArrayEnergies<'_> {
    /// Returns a report without stretches.
    fn report(&self, job: &EnergyJob) -> EnergyReport {
        EnergyReport {
            format_version: ENERGY_FORMAT_VERSION,
            clip: job.name.clone(),
            frames: job.frames,
            unit: self.silicon.unit.name.clone(),
            units: self.silicon.unit.count,
            simulated_units: 0,
            regions: self.silicon.regions,
            unmeasured_cells: match job.design.organization() {
                Organization::Pipelined => self.silicon.shared.cells,
                Organization::Serial | Organization::Raster => 0,
            },
            frame_rate: self.frame_rate,
            clock_mhz: self.clock_mhz,
            leakage_mw: self.leakage_mw(),
            stretches: Vec::new(),
        }
    }

    fn leakage_mw(&self) -> f64 {
        self.silicon.leakage_nw * 1e-6
    }

    /// Returns the energies of a stretch from the sum over `clocks` clocks of `units` units.
    fn stretch(
        &self,
        stretch: &ClipStretch,
        sum: EnergySum,
        (clocks, units): (f64, u64),
    ) -> StretchEnergy {
        let frames_of_units = count_to_f64(units * stretch.frames);
        let count = count_to_f64(self.silicon.unit.count);
        let of_array = |unit: PartEnergies, shared: PartEnergies| {
            unit.scaled(count).plus(shared.scaled(self.shared_growth))
        };
        let clock_pj = of_array(sum.unit, sum.shared).clock / clocks;
        // In an array, lanes wait for each other. Only the clock takes energy then.
        let waiting_clocks = (self.clocks_per_frame - clocks / frames_of_units).max(0.0);
        let frame_pj = of_array(sum.unit, sum.shared)
            .scaled(1.0 / frames_of_units)
            .plus(PartEnergies { clock: clock_pj * waiting_clocks, ..PartEnergies::default() });
        let clocks_per_frame = clocks / frames_of_units + waiting_clocks;
        let leakage_mw = self.leakage_mw();
        let frames_mw = frame_pj.total() * self.frame_rate * 1e-9;
        let idle_clocks = self.clock_mhz * 1e6 - clocks_per_frame * self.frame_rate;
        StretchEnergy {
            name: stretch.name.to_owned(),
            first_frame: stretch.first,
            frames: stretch.frames,
            sent_share: stretch.sent_share,
            clocks_per_frame,
            unit_pj_per_clock: sum.unit.scaled(1.0 / clocks),
            region_nj_per_frame: frame_pj.scaled(1e-3 / count_to_f64(self.silicon.regions)),
            stopped_clock_mw: frames_mw + leakage_mw,
            running_clock_mw: (idle_clocks >= 0.0)
                .then_some(frames_mw + leakage_mw + clock_pj * idle_clocks * 1e-9),
            default_activity_pj_per_clock: self.default.unit.total(),
        }
    }
}
