// SPDX-License-Identifier: MIT OR Apache-2.0
//! A point with all its figures ([`DesignRow`]), which is a row of the table of points. CSV and
//! Parquet have the same list of columns ([`point_cells`]).

use super::point_synthesis::SynthesizedPoint;
use crate::LoadFigures;
use crate::cost::DesignArea;
use crate::measure::CameraMeasurement;
use crate::target_process::{ProcessEnergy, ProcessFigures, reachable_clock};
use foveate_camera::{Camera, FeatureKind};
use foveate_design::{Design, DesignConfig};
use foveate_estimate::{FpgaDevice, FrameRate};
use foveate_measure::{ErrorTally, FidelityFigures};
use foveate_output::tables::{NamedCells, TableCell, named_cells};
use serde::Serialize;

/// The largest share of missed regions, and of false alarms, of a design on a front.
const MAX_DECISION_ERROR: f64 = 0.1;

/// A design with its errors, costs and speed.
#[derive(Clone, Debug, Serialize)]
pub struct DesignRow {
    /// The number of the point, from 1, in the order of the space.
    pub number: usize,
    /// The value of every axis, a string without quotes; empty if the axis has the value of the
    /// start.
    pub settings: Vec<String>,
    /// The configuration, with every default filled in.
    #[serde(skip)]
    pub config: DesignConfig,
    /// The fingerprint, which identifies the design.
    pub fingerprint: String,
    /// The errors over all clips.
    pub figures: FidelityFigures,
    /// The clip with the largest share of flipped actions, if there are several clips and any
    /// flips.
    pub worst_clip: Option<WorstClip>,
    /// The bytes per frame that leave the array: 2 bits per region, the pixels of active regions,
    /// and the means of summaries.
    pub bytes_per_frame: f64,
    /// The number of clocks from one frame to the next.
    pub clocks_per_frame: u64,
    /// The clock and the frames per second: at the clock of the space, or else at the clock that is
    /// estimated for the FPGA; `None` without both. With a process, at the highest clock of its
    /// cells, or at that of the space if it is lower; `None` if the design could not be mapped.
    pub speed: Option<FrameRate>,
    /// The area, if it was synthesized.
    pub silicon: Option<DesignArea>,
    /// The share of the device that the array takes, 0..=1, as [`fit`](crate::fit) counts it;
    /// `None` without an area.
    pub device_share: Option<f64>,
    /// The cost in the process, if there is one and the design was mapped to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub process: Option<ProcessFigures>,
    /// The load on the link over all clips, if the space has a link and the design sends pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<LoadFigures>,
    /// The fronts that the point is on.
    pub front: FrontMembership,
}

/// The fronts that a point is on. A point that misses more than 10 % or has more than 10 % false
/// alarms is on none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct FrontMembership {
    /// True if the point is on the front of error and speed.
    pub speed: bool,
    /// True if the point is on the front of error and area of the array: square millimetres with a
    /// process, the share of the device without one. A point without that area is not on it.
    pub area: bool,
    /// True if the point is on the front of error and energy of a region in a frame. A point whose
    /// energy was not measured is not on it.
    pub energy: bool,
}

impl FrontMembership {
    /// Returns true if the point is on a front.
    #[must_use]
    pub fn any(self) -> bool {
        self.speed || self.area || self.energy
    }
}

/// The clip on which a design flips the largest share of actions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorstClip {
    /// The name of the clip.
    pub name: String,
    /// The share of flipped actions over this clip alone, 0..=1.
    pub action_flips: f64,
}

/// The clocks that give designs their frame rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClockSource {
    /// The clock of the space in MHz.
    pub(crate) given_mhz: Option<u32>,
    /// True if the cells of a process limit the clock.
    pub(crate) has_process: bool,
}

impl ClockSource {
    /// Returns the speed of a design. Clocks of cells and of an FPGA are not compared: a design
    /// that could not be mapped to the cells has none.
    fn speed(self, clocks_per_frame: u64, synthesized: &SynthesizedPoint) -> Option<FrameRate> {
        let SynthesizedPoint { fpga, process } = synthesized;
        let clock = reachable_clock(self.given_mhz.map(f64::from), process.as_ref());
        let at_clock = clock.map(|mhz| FrameRate::at_given_clock(mhz, clocks_per_frame));
        match (self.has_process, process) {
            (true, None) => None,
            (true, Some(_)) => at_clock,
            (false, _) => at_clock.or_else(|| fpga.as_ref()?.speed),
        }
    }
}

impl DesignRow {
    pub(crate) fn new(
        (number, settings): (usize, Vec<String>),
        design: &Design,
        measured: &[&CameraMeasurement],
        synthesized: SynthesizedPoint,
        clocks: ClockSource,
    ) -> Option<Self> {
        let figures = sum_tallies(measured)?.figures();
        let clocks_per_frame = design.timing().clocks_per_frame();
        let speed = clocks.speed(clocks_per_frame, &synthesized);
        let SynthesizedPoint { fpga, process } = synthesized;
        Some(Self {
            number,
            settings,
            config: design.config(),
            fingerprint: design.fingerprint(),
            bytes_per_frame: bytes_per_frame(design, &figures),
            clocks_per_frame,
            speed,
            device_share: fpga.as_ref().map(|fpga| FpgaDevice::xcvu9p().cost(&fpga.silicon.array)),
            silicon: fpga.map(|fpga| fpga.silicon),
            process,
            figures,
            worst_clip: None,
            load: None,
            front: FrontMembership::default(),
        })
    }

    /// Returns true if the design does the task well enough to be on a front: it misses at most 10
    /// % and has at most 10 % false alarms. A design that sends almost nothing has few flips, too.
    #[must_use]
    pub fn qualifies(&self) -> bool {
        self.figures.missed <= MAX_DECISION_ERROR && self.figures.false_alarms <= MAX_DECISION_ERROR
    }

    /// Returns the measured energy in the process, if there is one.
    #[must_use]
    pub fn energy(&self) -> Option<&ProcessEnergy> {
        self.process.as_ref().and_then(|process| process.energy.as_ref())
    }
}

/// Returns the sums over several clips; `None` without clips.
pub(crate) fn sum_tallies(measured: &[&CameraMeasurement]) -> Option<ErrorTally> {
    let mut tallies = measured.iter().map(|part| &part.tally);
    let mut all = tallies.next()?.clone();
    tallies.for_each(|tally| all.merge(tally));
    Some(all)
}

/// Returns the bytes per frame as `simulate` counts them: the two bits of every region state its
/// action, so no addresses are sent.
pub(crate) fn bytes_per_frame(camera: &Camera, figures: &FidelityFigures) -> f64 {
    let regions = f64::from(camera.regions());
    let pixels = f64::from(camera.width()) * f64::from(camera.height()) * figures.active;
    let means = camera.periphery().map_or(0.0, |own| f64::from(own.mean_count()));
    let values = pixels + regions * figures.summarized * means;
    (2.0 * regions + values * f64::from(camera.pixel_bits())) / 8.0
}

/// Converts a count to a floating-point number.
#[allow(clippy::cast_precision_loss, reason = "exact up to 2^53")]
pub(crate) fn count_to_f64(count: u64) -> f64 {
    count as f64
}

pub(crate) fn point_cells(row: &DesignRow, axes: &[String]) -> NamedCells {
    let mut cells = named_cells([("point", (row.number as u64).into())]);
    let settings = axes.iter().zip(&row.settings);
    cells.extend(settings.map(|(axis, value)| (axis.clone(), TableCell::Text(value.clone()))));
    cells.extend(error_cells(&row.figures));
    let worst = row.worst_clip.as_ref();
    let area = row.silicon.as_ref();
    let of = |take: fn(&DesignArea) -> u64| TableCell::Count(area.map(take));
    let at = |take: fn(&FrameRate) -> f64| TableCell::Real(row.speed.as_ref().map(take));
    cells.extend(named_cells([
        ("worst_clip", worst.map_or("", |clip| clip.name.as_str()).into()),
        ("worst_clip_flips", TableCell::Real(worst.map(|clip| clip.action_flips))),
        ("bytes_per_frame", row.bytes_per_frame.into()),
        ("clocks_per_frame", row.clocks_per_frame.into()),
        ("clock_mhz", at(|speed| speed.clock_mhz)),
        ("low_clock_mhz", at(|speed| speed.low_clock_mhz)),
        ("high_clock_mhz", at(|speed| speed.high_clock_mhz)),
        ("frames_per_second", at(|speed| speed.frames_per_second)),
        ("unit_lut", of(|area| area.unit.lut_total_packed)),
        ("unit_ff", of(|area| area.unit.ff)),
        ("unit_lutram", of(|area| area.unit.lut_memory_packed)),
        ("units", of(|area| area.units)),
        ("lut", of(|area| area.array.lut_total_packed)),
        ("ff", of(|area| area.array.ff)),
        ("lutram", of(|area| area.array.lut_memory_packed)),
        ("ramb36", TableCell::Real(area.map(|area| count_to_f64(area.array.bram18) / 2.0))),
        ("dsp", of(|area| area.array.dsp)),
        ("device_share", TableCell::Real(row.device_share)),
        ("logic_levels", of(|area| area.logic_levels.into())),
        ("front_speed", TableCell::Flag(row.front.speed)),
        ("front_area", TableCell::Flag(row.front.area)),
        ("front_energy", TableCell::Flag(row.front.energy)),
        ("fingerprint", row.fingerprint.as_str().into()),
    ]));
    cells
}

/// Returns the cells of the cost in a process, which are empty without one.
pub(crate) fn process_cells(row: &DesignRow) -> NamedCells {
    let (process, energy) = (row.process.as_ref(), row.energy());
    let at = |take: fn(&ProcessFigures) -> f64| TableCell::Real(process.map(take));
    let of = |take: fn(&ProcessEnergy) -> f64| TableCell::Real(energy.map(take));
    let bits = process.map(|process| process.memory_bits_without_macro);
    named_cells([
        ("unit_um2", at(|process| process.unit_um2)),
        ("mm2", TableCell::Real(process.and_then(|process| process.mm2))),
        ("memory_bits_without_macro", TableCell::Count(bits)),
        ("process_clock_mhz", at(|process| process.clock_mhz)),
        ("nj_per_region", of(|energy| energy.nj_per_region)),
        ("usual_mw", of(|energy| energy.usual_mw)),
        ("busiest_mw", of(|energy| energy.busiest_mw)),
    ])
}

/// Returns the cells of a load, which are empty without one.
pub(crate) fn load_cells(load: Option<&LoadFigures>) -> NamedCells {
    let of = |take: fn(&LoadFigures) -> Option<u64>| TableCell::Count(load.and_then(take));
    named_cells([
        ("needed_clock_hz", of(|load| Some(load.needed_clock_hz))),
        ("delivery_longest_ns", of(|load| load.delivery_longest_ns)),
        ("buffer_bytes", of(|load| load.buffer_bytes)),
        ("overloaded_clips", of(|load| load.overloaded_clips)),
        ("unbuffered_lost_regions", of(|load| load.unbuffered_lost_regions)),
        ("unbuffered_frames_with_losses", of(|load| load.unbuffered_frames_with_losses)),
    ])
}

pub(crate) fn name_cells(point: usize, clip: &str) -> NamedCells {
    named_cells([("point", (point as u64).into()), ("clip", clip.into())])
}

pub(crate) fn error_cells(figures: &FidelityFigures) -> NamedCells {
    let mut cells = named_cells([
        ("frames", figures.frames.into()),
        ("active", figures.active.into()),
        ("ideal_active", figures.ideal_active.into()),
        ("srs_flips", figures.srs_flips.into()),
        ("trs_flips", figures.trs_flips.into()),
        ("action_flips", figures.action_flips.into()),
        ("missed", figures.missed.into()),
        ("false_alarms", figures.false_alarms.into()),
        ("active_iou", figures.active_iou.into()),
        ("psnr_ideal", TableCell::Real(figures.psnr_ideal)),
        ("ssim_ideal", figures.ssim_ideal.into()),
        ("psnr_input", TableCell::Real(figures.psnr_input)),
        ("ssim_input", figures.ssim_input.into()),
        ("stale_regions", figures.stale_regions.into()),
        ("stale_max", figures.staleness.max.into()),
        ("stale_mean", figures.staleness.mean.into()),
        ("stale_share", figures.staleness.share.into()),
        ("stale_frames", figures.staleness.longest.into()),
    ]);
    for feature in score_names() {
        let score = figures.scores.iter().find(|score| score.feature == feature);
        let of = |take: fn(&foveate_measure::ScoreError) -> f64| TableCell::Real(score.map(take));
        cells.push((format!("{feature}_max"), of(|score| score.max)));
        cells.push((format!("{feature}_mean"), of(|score| score.mean)));
        cells.push((format!("{feature}_rms"), of(|score| score.rms)));
    }
    cells
}

/// Returns the name of every score that can be compared. All spaces have the same columns, so that
/// tables can be joined.
fn score_names() -> impl Iterator<Item = &'static str> {
    FeatureKind::ALL.iter().map(|kind| kind.name()).chain(["temporal"])
}
