// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report on the energy of a design ([`EnergyReport`]), with its text for a terminal and as
//! Markdown.

pub use crate::energy::energy_sum::PartEnergies;
use foveate_output::number_text::{grouped, real_number};
use foveate_output::report::{Report, ReportPart, ReportTable};
use serde::{Deserialize, Serialize};

/// The version of the JSON report. It grows when a field changes its meaning or is removed.
pub const ENERGY_FORMAT_VERSION: u32 = 1;

/// The energy of a design, from the activity of a clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergyReport {
    /// The version of the format, [`ENERGY_FORMAT_VERSION`].
    pub format_version: u32,
    /// The clip.
    pub clip: String,
    /// The number of its frames that were played.
    pub frames: u64,
    /// The name of the unit for people: `RPU` or `lane`.
    pub unit: String,
    /// The number of units of the array.
    pub units: u64,
    /// The number of units that were simulated, spread evenly over the frame.
    pub simulated_units: u64,
    /// The number of regions.
    pub regions: u64,
    /// The number of cells that RPUs share. Their energy is in no figure. It is 0 for lanes,
    /// because the energy of the cells that they share is in all figures.
    pub unmeasured_cells: u64,
    /// The frames per second for which powers are given.
    pub frame_rate: f64,
    /// The clock in MHz of a design whose clock runs always.
    pub clock_mhz: f64,
    /// The leakage of the array in milliwatts, which is part of every power.
    pub leakage_mw: f64,
    /// The measured stretches: a quiet, a usual and the busiest one.
    pub stretches: Vec<StretchEnergy>,
}

/// The energy during a stretch of a clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StretchEnergy {
    /// `quiet`, `usual` or `busiest`, by the number of sent regions.
    pub name: String,
    /// The number of the first frame, from 0.
    pub first_frame: u64,
    /// The number of frames.
    pub frames: u64,
    /// The share of regions that are sent.
    pub sent_share: f64,
    /// The number of clocks of a frame of the array.
    pub clocks_per_frame: f64,
    /// The energy of one unit in a clock, in picojoules.
    pub unit_pj_per_clock: PartEnergies,
    /// The energy of a region in a frame, in nanojoules, with its share of the logic that units
    /// share.
    pub region_nj_per_frame: PartEnergies,
    /// The power of the array in milliwatts if the clock stops when a frame is done.
    pub stopped_clock_mw: f64,
    /// The power of the array in milliwatts if the clock runs always; `None` if the clock is too
    /// slow for the frames.
    pub running_clock_mw: Option<f64>,
    /// The energy of one unit in a clock, in picojoules, if every net changed at every tenth clock,
    /// which tools assume without a measured activity.
    pub default_activity_pj_per_clock: f64,
}

const COLUMNS: [&str; 8] =
    ["stretch", "frames", "sent %", "pJ/clock", "nJ/region", "mW stops", "mW runs", "pJ at 0.1"];

impl EnergyReport {
    /// Returns the report as tables and sentences; 80 columns of a terminal are enough.
    #[must_use]
    pub fn tables(&self) -> Report {
        let [energies, parts] = [energy_table(self), part_table(self)].map(ReportPart::Table);
        Report(vec![energies, parts, ReportPart::Sentences(sentences(self))])
    }
}

fn energy_table(report: &EnergyReport) -> ReportTable {
    let note = format!(
        "sent %: the share of regions that are sent. pJ/clock: the energy of one {} in a clock. nJ/region: the \
         energy of a region in a frame. mW: the power of the array at {} frames/s, if its clock stops when a \
         frame is done, and if it always runs at {} MHz. pJ at 0.1: pJ/clock if every net changed at every tenth \
         clock, as tools assume.",
        report.unit,
        real_number(report.frame_rate, 1),
        real_number(report.clock_mhz, 1),
    );
    ReportTable::new(COLUMNS, report.stretches.iter().map(energy_row)).described(
        format!("Energy on {} frames of {}", grouped(report.frames), report.clip),
        Some(note),
    )
}

fn energy_row(stretch: &StretchEnergy) -> Vec<String> {
    let last = stretch.first_frame + stretch.frames - 1;
    let running = stretch.running_clock_mw.map_or("-".to_owned(), |power| real_number(power, 3));
    vec![
        stretch.name.clone(),
        format!("{}-{last}", stretch.first_frame),
        real_number(100.0 * stretch.sent_share, 1),
        real_number(stretch.unit_pj_per_clock.total(), 2),
        real_number(stretch.region_nj_per_frame.total(), 3),
        real_number(stretch.stopped_clock_mw, 3),
        running,
        real_number(stretch.default_activity_pj_per_clock, 2),
    ]
}

fn part_table(report: &EnergyReport) -> ReportTable {
    let row = |stretch: &StretchEnergy| {
        let parts = stretch.region_nj_per_frame;
        let share = |part: f64| real_number(100.0 * part / parts.total().max(f64::MIN_POSITIVE), 1);
        let shares = [parts.clock, parts.memory, parts.flip_flops, parts.logic].map(share);
        std::iter::once(stretch.name.clone()).chain(shares)
    };
    let note = "clock: the clock pins of all flip-flops. memory: the flip-flops that are words of memories. other FF: the \
         other flip-flops. logic: the gates.";
    let columns = ["stretch", "clock", "memory", "other FF", "logic"];
    ReportTable::new(columns, report.stretches.iter().map(row))
        .described("Parts of the energy of a region, in %", Some(note.to_owned()))
}

fn sentences(report: &EnergyReport) -> Vec<String> {
    let clocks_per_frame = report.stretches.last().map_or(0.0, |stretch| stretch.clocks_per_frame);
    let mut all = vec![format!(
        "{} of {} {}s were simulated as gates, and all their outputs were those of the model. A frame takes {} clocks. \
         Leakage of {} uW is part of every power.",
        grouped(report.simulated_units),
        grouped(report.units),
        report.unit,
        real_number(clocks_per_frame, 0),
        real_number(report.leakage_mw * 1000.0, 3),
    )];
    if report.unmeasured_cells > 0 {
        all.push(format!(
            "The energy of {} cells that the RPUs share is in no figure.",
            grouped(report.unmeasured_cells)
        ));
    }
    if report.stretches.iter().any(|stretch| stretch.running_clock_mw.is_none()) {
        all.push(format!(
            "A clock of {} MHz is too slow for {} frames/s.",
            real_number(report.clock_mhz, 3),
            real_number(report.frame_rate, 1)
        ));
    }
    all.push(
        "Not included: wires, the clock tree, changes of a net before it settles, what drives the inputs, pixels and \
         converters. So energies are lower bounds."
            .to_owned(),
    );
    all
}
